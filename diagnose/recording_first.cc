#include "diagnose/recording_first.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/word_list.h"
#include "diagnose/evidence/clocks.h"
#include "diagnose/recording/contradictions.h"
#include "diagnose/recording/held_samples.h"
#include "diagnose/recording/measured_ratios.h"
#include "diagnose/recording/recording_damage.h"
#include "diagnose/recording/recording_remarks.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/recording/second_sensors.h"
#include "diagnose/recording/sparse_columns.h"
#include "diagnose/recording/vacuum.h"

namespace hydro::diagnose {
namespace {

constexpr char kSign[] = "sensor.sign";

// Whether only the signs of single sensors are wrong, which the catalogue has as an effect.
bool OnlySigns(const std::vector<RecordingFinding>& findings) {
  return std::ranges::all_of(findings, [](const RecordingFinding& finding) {
    return finding.mistakes.size() == 1 && !finding.mistakes[0].InvertedSensor().empty();
  });
}

bool OnlyUnknownUnits(const std::vector<RecordingFinding>& findings) {
  return std::ranges::all_of(findings, [](const RecordingFinding& finding) {
    return std::ranges::all_of(finding.mistakes,
                               [](const RecordingMistake& mistake) { return mistake.IsOfUnknownUnit(); });
  });
}

bool MayHave(const RecordingMistake& mistake, const std::vector<RecordingMistake>& possible) {
  return mistake.shaft.has_value() || std::ranges::find(possible, mistake) != possible.end();
}

// The number of runs with at least one of these mistakes.
size_t RunsWith(const std::vector<RecordingMistake>& mistakes,
                const std::vector<RecordingFinding>& findings) {
  return static_cast<size_t>(std::ranges::count_if(findings, [&](const RecordingFinding& finding) {
    return std::ranges::any_of(mistakes, [&](const RecordingMistake& mistake) {
      return std::ranges::find(finding.mistakes, mistake) != finding.mistakes.end();
    });
  }));
}

// The number of runs that may have these mistakes: a run whose arm moves may have its angle in degrees, for
// example; a clamped one cannot.
size_t RunsThatMayHave(const std::vector<RecordingMistake>& mistakes,
                       const std::vector<runs::MeasuredRun>& runs) {
  return static_cast<size_t>(std::ranges::count_if(runs, [&](const runs::MeasuredRun& run) {
    const std::vector<RecordingMistake> possible = PossibleMistakes(run);
    return std::ranges::all_of(mistakes,
                               [&](const RecordingMistake& mistake) { return MayHave(mistake, possible); });
  }));
}

// The runs whose signals needed no alignment: only these tell by how many rows a command is late.
std::vector<runs::MeasuredRun> OnOneClock(const std::vector<AlignedRun>& aligned) {
  std::vector<runs::MeasuredRun> runs;
  for (const AlignedRun& one : aligned) {
    if (one.clocks.empty()) runs.push_back(one.run);
  }
  return runs;
}

// Corrects or leaves out sensors that are not believed, and says so.
std::vector<std::string> CorrectSensors(std::vector<runs::MeasuredRun>* runs,
                                        std::vector<runs::MeasuredRun>* held_out,
                                        std::vector<AlignedRun>* aligned) {
  std::vector<runs::MeasuredRun*> recorded, prepared;
  std::vector<runs::MeasuredRun> all;
  for (auto* some : {runs, held_out}) {
    for (runs::MeasuredRun& run : *some) recorded.push_back(&run);
  }
  for (AlignedRun& one : *aligned) {
    prepared.push_back(&one.run);
    all.push_back(one.run);
  }
  ComparedSensors compared = CompareSensors(all);
  CorrectOrLeaveOut(compared.unbelieved, recorded);
  CorrectOrLeaveOut(compared.unbelieved, prepared);
  return std::move(compared.remarks);
}

// What the balances of an unbalanced run would need.
std::string Lacks(const runs::MeasuredRun& run) {
  if (!run.motor_speed.measured() && !run.motor_angle.measured())
    return "neither motor_speed nor motor_angle was recorded";
  if (run.bypass || (run.p1.measured() && run.p2.measured()))
    return "no stretch of it without gaps is long enough";
  const bool one = run.p1.measured() || run.p2.measured();
  return one ? (run.p1.measured() ? "p2 was not recorded" : "p1 was not recorded")
             : "p1 and p2 were not recorded (of a motor alone, the sidecar says bypass = true)";
}

std::vector<std::string> UnjudgedLines(const UnjudgedRuns& unjudged,
                                       const std::vector<runs::MeasuredRun>& runs) {
  std::vector<std::string> lines;
  const auto named = [&](const std::vector<size_t>& some) {
    std::vector<std::string> names;
    names.reserve(some.size());
    for (const size_t r : some) names.push_back(runs[r].name);
    return RunsNamed(names);
  };
  if (!unjudged.unpredicted.empty()) {
    lines.push_back(
        named(unjudged.unpredicted) +
        ": not predicted at all by the model as given, and no known mistake of a recording explains that: "
        "look at columns, shaft, bypass and the model's units");
  }
  if (!unjudged.at_rest.empty()) {
    lines.push_back(named(unjudged.at_rest) +
                    ": signs, units and columns could not be checked, because the motor hardly turns");
  }
  for (const size_t r : unjudged.unbalanced) {
    lines.push_back(RunNamed(runs[r].name) + ": signs, units and columns could not be checked, because " +
                    Lacks(runs[r]));
  }
  return lines;
}

std::string MendFirstSentence(const CheckedRecordings& checked) {
  return "Mend the recording first: " + checked.mistakes.front() + ".";
}

// The remarks that come before all others.
std::vector<std::string> RemarksOn(const CheckedRecordings& checked) {
  std::vector<std::string> remarks = checked.mistakes;
  remarks.insert(remarks.end(), checked.factors.begin(), checked.factors.end());
  for (const auto* some :
       {&checked.sensors, &checked.commands.late, &checked.commands.early, &checked.vacuum, &checked.nearly})
    remarks.insert(remarks.end(), some->begin(), some->end());
  if (!checked.load.empty()) remarks.push_back(checked.load);
  remarks.insert(remarks.end(), checked.ratios.begin(), checked.ratios.end());
  remarks.insert(remarks.end(), checked.repeats.begin(), checked.repeats.end());
  remarks.insert(remarks.end(), checked.damage.begin(), checked.damage.end());
  return remarks;
}

void SetUntried(BeforeAfter* gap) {
  gap->before = gap->refit_only = gap->after = std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

CheckedRecordings CheckFirst(const model::ModelDescription& model, const std::vector<std::string>& effects,
                             int jobs, std::vector<runs::MeasuredRun>* runs,
                             std::vector<runs::MeasuredRun>* held_out,
                             const std::function<bool()>& time_is_up) {
  CheckedRecordings checked;
  std::vector<runs::MeasuredRun> all = *runs;
  all.insert(all.end(), held_out->begin(), held_out->end());
  for (const runs::MeasuredRun& run : all) {
    CheckUsable(run);
    RequireArmInStroke(run, model);
  }
  checked.load = LoadRemark(all);
  checked.damage = SparseSensorRemarks(all);
  AddCommandRemarks(all, &checked.damage, &checked.repeats);
  AddVacuumRemarks(model, all, &checked.vacuum, &checked.nearly);
  for (auto* some : {runs, held_out}) {
    const std::vector<std::string> repeats = SetAsideRepeats(some);
    checked.repeats.insert(checked.repeats.end(), repeats.begin(), repeats.end());
    const std::vector<std::string> damage = SetAsideDamage(model, some);
    checked.damage.insert(checked.damage.end(), damage.begin(), damage.end());
  }
  all = *runs;
  all.insert(all.end(), held_out->begin(), held_out->end());
  std::vector<std::string> contradictions;
  std::vector<bool> contradicts(all.size(), false);
  for (size_t r = 0; r < all.size(); ++r) {
    for (std::string& one : Contradictions(model, all[r])) {
      contradictions.push_back(std::move(one));
      contradicts[r] = true;
    }
  }
  UnjudgedRuns unjudged;
  checked.aligned = AlignedRuns(model, all, jobs);
  std::vector<runs::MeasuredRun> on_one_clock;
  on_one_clock.reserve(all.size());
  for (const AlignedRun& one : checked.aligned) on_one_clock.push_back(one.run);
  checked.ratios = RatioRemarks(model, on_one_clock);
  std::vector<RecordingFinding> findings = CheckRecordings(model, on_one_clock, jobs, time_is_up, &unjudged);
  // A contradiction that must be corrected first may look like any other mistake.
  std::erase_if(findings, [&](const RecordingFinding& one) { return contradicts[one.run]; });
  for (std::vector<size_t>* some : {&unjudged.unpredicted, &unjudged.at_rest, &unjudged.unbalanced})
    std::erase_if(*some, [&](size_t run) { return contradicts[run]; });
  checked.unjudged = UnjudgedLines(unjudged, all);
  checked.mistakes = contradictions;
  std::vector<std::string>& said = OnlyUnknownUnits(findings) ? checked.factors : checked.mistakes;
  for (std::string& remark : FindingRemarks(findings, all)) said.push_back(std::move(remark));
  const bool may_name_signs = effects.empty() || std::ranges::find(effects, kSign) != effects.end();
  // A recorder's mistake appears in most of its runs. A mistake in a single run may have another cause: it is
  // reported, and the search continues.
  const bool most = std::ranges::any_of(findings, [&](const RecordingFinding& finding) {
    return 2 * RunsWith(finding.mistakes, findings) >= RunsThatMayHave(finding.mistakes, all);
  });
  checked.mend_first = !contradictions.empty() || (!findings.empty() && most && !OnlyUnknownUnits(findings) &&
                                                   !(may_name_signs && OnlySigns(findings)));
  if (!checked.mend_first && most && OnlySigns(findings)) {
    for (const RecordingFinding& finding : findings) {
      const std::string sensor = finding.mistakes[0].InvertedSensor();
      if (std::ranges::find(checked.inverted, sensor) == checked.inverted.end())
        checked.inverted.push_back(sensor);
    }
  }
  if (!checked.mend_first) checked.sensors = CorrectSensors(runs, held_out, &checked.aligned);
  if (!checked.mend_first && !time_is_up())
    checked.commands = RemarksOnCommands(model, OnOneClock(checked.aligned), jobs);
  return checked;
}

Diagnosis MendFirst(const model::ModelDescription& model, const CheckedRecordings& checked,
                    const std::vector<runs::MeasuredRun>& runs,
                    const std::vector<runs::MeasuredRun>& held_out) {
  Diagnosis diagnosis;
  diagnosis.verdict = Verdict::kUnexplained;
  diagnosis.sentence = MendFirstSentence(checked) + " Nothing was searched on top of it.";
  diagnosis.remarks = RemarksOn(checked);
  SetUntried(&diagnosis.fit);
  SetUntried(&diagnosis.held_out);
  SetUntried(&diagnosis.compared.gap);
  diagnosis.model = model;
  for (const runs::MeasuredRun& run : runs) {
    diagnosis.runs.push_back(run.name);
    diagnosis.samples += run.samples();
  }
  for (const runs::MeasuredRun& run : held_out) diagnosis.held_out_runs.push_back(run.name);
  return diagnosis;
}

void AddChecked(const CheckedRecordings& checked, Diagnosis* diagnosis) {
  const std::vector<std::string> remarks = RemarksOn(checked);
  diagnosis->remarks.insert(diagnosis->remarks.begin(), remarks.begin(), remarks.end());
  if (checked.mistakes.empty() && IsOpen(diagnosis->verdict) && !checked.commands.late.empty())
    diagnosis->sentence =
        "Mend the recording first: " + checked.commands.late.front() + ". " + diagnosis->sentence;
  if (checked.mistakes.empty()) return;
  diagnosis->sentence = MendFirstSentence(checked) + " " + diagnosis->sentence;
  const bool named =
      std::ranges::any_of(diagnosis->effects, [](const FoundEffect& effect) { return effect.id == kSign; });
  if (!named) diagnosis->verdict = Verdict::kUnexplained;
}

RecordingReport ReportOnRecordings(const model::ModelDescription& model, std::vector<runs::MeasuredRun> runs,
                                   int jobs) {
  std::vector<runs::MeasuredRun> none;
  CheckedRecordings checked = CheckFirst(model, {}, jobs, &runs, &none);
  RecordingReport report;
  report.wrong = checked.mistakes;
  report.wrong.insert(report.wrong.end(), checked.factors.begin(), checked.factors.end());
  report.wrong.insert(report.wrong.end(), checked.damage.begin(), checked.damage.end());
  report.wrong.insert(report.wrong.end(), checked.vacuum.begin(), checked.vacuum.end());
  report.limits.insert(report.limits.end(), checked.nearly.begin(), checked.nearly.end());
  report.wrong.insert(report.wrong.end(), checked.sensors.begin(), checked.sensors.end());
  report.wrong.insert(report.wrong.end(), checked.commands.late.begin(), checked.commands.late.end());
  report.limits.insert(report.limits.end(), checked.commands.early.begin(), checked.commands.early.end());
  report.doubtful = !checked.commands.early.empty();
  if (!checked.load.empty()) report.limits.push_back(checked.load);
  report.limits.insert(report.limits.end(), checked.ratios.begin(), checked.ratios.end());
  report.limits.insert(report.limits.end(), checked.repeats.begin(), checked.repeats.end());
  report.unjudged = checked.unjudged;
  if (checked.mend_first) return report;  // the rest applies to recordings that can be read
  std::vector<ClockDelay> clocks;
  std::vector<RunData> prepared;
  prepared.reserve(runs.size());
  for (size_t r = 0; r < runs.size(); ++r)
    prepared.push_back(PrepareAligned(runs[r], std::move(checked.aligned[r]), model, &clocks));
  MakeNamesUnique(&prepared);
  const std::vector<const RunData*> pointers = PointersTo(prepared);
  // As for runs that are not fitted: what their motion does not show is no fault of the recording.
  const std::vector<std::string> remarks = RecordingRemarks(clocks, {}, pointers);
  report.wrong.insert(report.wrong.end(), remarks.begin(), remarks.end());
  const std::vector<std::string> layouts = LayoutRemarks(pointers);
  report.limits.insert(report.limits.end(), layouts.begin(), layouts.end());
  for (const std::vector<std::string>& limits :
       {LimitRemarks(model.parameters, pointers), MotionRemarks(pointers)})
    report.limits.insert(report.limits.end(), limits.begin(), limits.end());
  return report;
}

}  // namespace hydro::diagnose
