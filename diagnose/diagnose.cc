#include "diagnose/diagnose.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <set>
#include <utility>

#include "base/maths/spread.h"
#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/evidence/clocks.h"
#include "diagnose/fit/prior.h"
#include "diagnose/prove/blind_changes.h"
#include "diagnose/prove/proof_windows.h"
#include "diagnose/prove/propose.h"
#include "diagnose/prove/prove.h"
#include "diagnose/recording/recording_remarks.h"
#include "diagnose/recording/run_data.h"
#include "diagnose/recording_first.h"
#include "diagnose/say/conclusion.h"
#include "diagnose/say/per_run.h"
#include "diagnose/say/sentence.h"
#include "model/effects/catalogue.h"

namespace hydro::diagnose {
namespace {

// The end of the pump's motion: many recordings end at rest, and a pump at rest tests nothing.
size_t EndOfMotion(const runs::MeasuredRun& run) {
  const std::vector<double>& values =
      run.motor_speed.measured() ? run.motor_speed.values : run.motor_angle.values;
  size_t end = values.size();
  while (end > 0 && (std::isnan(values[end - 1]) || values[end - 1] == values.back())) --end;
  return end > 0 ? end + 1 : run.samples();
}

// Splits off the last third of the time in which a single run moves, as the held-out run.
void HoldOutLastThird(runs::MeasuredRun* run, std::vector<runs::MeasuredRun>* held_out) {
  const size_t first = EndOfMotion(*run) * 2 / 3;
  runs::MeasuredRun rest = *run;
  rest.name += ", last third";
  rest.Keep(first, rest.samples());
  run->Keep(0, first);
  held_out->push_back(std::move(rest));
}

// Whether one of the effect's parameters only adds to a base parameter that the model has. In that case the
// base parameter may be wrong instead.
bool IsTermOfTheModel(const model::EffectInfo& info, const model::Parameters& given) {
  return std::ranges::any_of(info.parameters, [&](const model::ParameterInfo& parameter) {
    return parameter.adds_to != nullptr && given.*parameter.adds_to != 0;
  });
}

// Whether some effect contains this base parameter's term. Where the model has the parameter at 0, the effect
// then replaces it.
bool IsTermOfAnEffect(const model::BaseParameter& base) {
  const std::vector<model::EffectInfo>& catalogue = model::EffectCatalogue();
  return std::ranges::any_of(catalogue, [&](const model::EffectInfo& info) {
    return std::ranges::any_of(info.parameters, [&](const model::ParameterInfo& parameter) {
      return parameter.adds_to == base.member;
    });
  });
}

bool IsMeasured(const std::string& channel, const std::vector<const RunData*>& runs) {
  return std::ranges::any_of(runs, [&](const RunData* run) {
    return std::ranges::any_of(
        run->signals, [&](const SignalData& signal) { return ChannelName(signal.channel) == channel; });
  });
}

// Whether the temperature differed between runs or changed during one.
bool HasTemperature(const std::vector<const RunData*>& runs) {
  constexpr double kLeast = 1;  // K
  maths::Range range;
  for (const RunData* run : runs) {
    for (const model::Surroundings& around : run->stimulus.around) {
      range.low = std::min(range.low, around.temperature);
      range.high = std::max(range.high, around.temperature);
    }
  }
  return range.high - range.low > kLeast;
}

// Whether the effect makes one channel late where there is no other channel. In that case the command is
// early, which is an effect of the amplifier.
bool IsOfTheCommand(const model::EffectInfo& info, const std::vector<const RunData*>& runs) {
  if (!model::HasRole(info.id, model::Role::kChannel) || !model::HasRole(info.id, model::Role::kTime))
    return false;
  std::set<model::Channel> measured;
  for (const RunData* run : runs) {
    for (const SignalData& signal : run->signals) measured.insert(signal.channel);
  }
  return measured.size() == 1;
}

// One change for each name that the effect can take in these runs.
std::vector<Change> Variants(const model::EffectInfo& info, const std::vector<const RunData*>& runs) {
  std::vector<Change> variants = {{info.id, {}, ""}};
  for (const model::ParameterInfo& parameter : info.parameters) {
    if (!parameter.is_name()) continue;
    std::vector<Change> next;
    for (const Change& variant : variants) {
      for (const std::string& name : parameter.names) {
        if (parameter.role == model::Role::kChannel && !IsMeasured(name, runs)) continue;
        next.push_back(variant);
        next.back().names[parameter.name] = name;
      }
    }
    variants = std::move(next);
  }
  return variants;
}

// Whether the model has an effect beside which this one cannot stand: a second accumulator.
bool IsExcluded(const Change& change, const model::ModelDescription& given) {
  model::EffectDescription effect{.id = change.effect, .parameters = {}, .names = change.names};
  for (const model::ParameterInfo& parameter : model::FindEffect(change.effect)->parameters)
    if (parameter.is_number()) effect.parameters[parameter.name] = parameter.example;
  return std::ranges::any_of(given.effects, [&](const model::EffectDescription& own) {
    return model::ExcludeEachOther(effect, own);
  });
}

// The effects that may be named, each with every name that it can take in these runs.
std::vector<Change> EffectChanges(const model::ModelDescription& given,
                                  const std::vector<std::string>& allowed,
                                  const std::vector<const RunData*>& runs) {
  const bool oil = HaveOil(runs);
  std::vector<Change> changes;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if ((info.needs_oil && !oil) || IsOfTheCommand(info, runs)) continue;
    if (info.needs_temperature && !HasTemperature(runs)) continue;
    // A recorded temperature counts as a request.
    const bool on_request = info.on_request && !info.needs_temperature;
    if ((on_request || (info.of_bare_motors && oil)) && allowed.empty()) continue;
    if (!allowed.empty() && std::ranges::find(allowed, info.id) == allowed.end()) continue;
    if (IsTermOfTheModel(info, given.parameters)) continue;
    const bool has = std::ranges::any_of(
        given.effects, [&](const model::EffectDescription& effect) { return effect.id == info.id; });
    if (has) continue;
    std::vector<Change> variants = Variants(info, runs);
    std::erase_if(variants, [&](const Change& change) { return IsExcluded(change, given); });
    changes.insert(changes.end(), variants.begin(), variants.end());
  }
  return changes;
}

// Which effects of the catalogue were not looked for because nobody asked for them. "" where there are none.
std::string RemarkOnRequests(const model::ModelDescription& given, const std::vector<Change>& changes,
                             const std::vector<const RunData*>& runs) {
  std::vector<std::string> left;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    const bool tried =
        std::ranges::any_of(changes, [&](const Change& change) { return change.effect == info.id; });
    if (!tried && !EffectChanges(given, {info.id}, runs).empty()) left.push_back(info.id);
  }
  if (left.empty()) return "";
  return "Not looked for, because few machines have them; --effects with a list of them does: " +
         Enumerated(left);
}

// The base values that may be refitted: not what all torques are measured by, which no run shows.
std::vector<size_t> AllowedBase(const model::ModelDescription& given, const std::vector<std::string>& names,
                                const std::vector<const RunData*>& runs) {
  std::vector<size_t> allowed;
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) {
    const model::BaseParameter& base = model::BaseParameters()[i];
    const bool asked = std::ranges::find(names, base.info.name) != names.end();
    const bool otherwise =
        !IsYardstick(base.member, runs) && (given.parameters.*base.member != 0 || !IsTermOfAnEffect(base));
    if (names.empty() ? otherwise : asked) allowed.push_back(i);
  }
  return allowed;
}

// The prepared runs, each with all signals on one clock.
struct PreparedRuns {
  std::vector<RunData> fitted, held_out;
  std::vector<ClockDelay> clocks;
};

// `aligned` has the fitted runs, then the held-out runs.
PreparedRuns Prepare(const model::ModelDescription& model, int jobs, std::vector<runs::MeasuredRun> runs,
                     std::vector<runs::MeasuredRun> held_out, std::vector<AlignedRun> aligned) {
  if (runs.size() == 1 && held_out.empty() && runs.front().samples() >= 300) {
    HoldOutLastThird(&runs.front(), &held_out);
    aligned = AlignedRuns(model, {runs.front(), held_out.front()}, jobs);
  }
  PreparedRuns prepared;
  auto next = aligned.begin();
  for (const auto& [recorded, to] :
       {std::pair(&runs, &prepared.fitted), std::pair(&held_out, &prepared.held_out)}) {
    for (const runs::MeasuredRun& run : *recorded)
      to->push_back(PrepareAligned(run, std::move(*next++), model, &prepared.clocks));
  }
  if (!prepared.fitted.empty()) prepared.fitted.front().angle_counts = true;
  MakeNamesUnique(&prepared.fitted);
  MakeNamesUnique(&prepared.held_out);
  return prepared;
}

ProofContext MakeContext(const model::ModelDescription& model, const PreparedRuns& runs,
                         const std::vector<size_t>& allowed, const DiagnoseOptions& options,
                         const ProgressCallback& report_progress) {
  ProofContext context;
  context.given = model;
  context.runs = PointersTo(runs.fitted);
  context.held_out = PointersTo(runs.held_out);
  context.sizes = SizesOf(model, context.runs);
  context.jobs = options.jobs;
  context.seed = options.seed;
  context.report_progress = report_progress;
  context.changes = EffectChanges(model, options.effects, context.runs);
  for (const size_t i : allowed) context.changes.push_back({"", {}, model::BaseParameters()[i].info.name});
  return context;
}

// The search's clock: checks whether its time is up, and remembers whether it ever was. It counts the
// processor's time, divided by the number of jobs, so that a loaded machine does not end a search.
class TimeLimit {
 public:
  TimeLimit(double seconds, int jobs) : seconds_(seconds), jobs_(std::max(1, jobs)) {}
  bool IsUp() {
    const double worked = static_cast<double>(std::clock() - begin_) / CLOCKS_PER_SEC;
    if (worked > seconds_ * jobs_) struck_ = true;
    return struck_;
  }
  bool struck() const { return struck_; }
  std::string Remark() const {
    return "Unfinished, because the time limit of " + ShortNumber(seconds_) +
           " s ended the search (--time-limit). ";
  }

 private:
  double seconds_;
  int jobs_;
  std::clock_t begin_ = std::clock();
  std::atomic<bool> struck_ = false;
};

// Proves what the balances propose. Fitted runs of which only one shows a value (a payload) cannot propose
// that it differs by run. So where a gap is left, and values of runs predict windows that did not see them
// better, they are proposed too. They are said where they close the gap: in part, any value of a run's own
// would.
Diagnosis ProveAndConclude(const ProofContext& context, const Hypothesis& as_given,
                           const std::vector<size_t>& allowed, const DiagnoseOptions& options,
                           Proposed* proposed) {
  // Whoever names the values that may differ asks for them, and windows may show what balances do not.
  const bool asked = !options.free.empty() || proposed->proposals.empty();
  const auto prove = [&] {
    const Proof proof = ProveProposals(context, as_given, asked ? allowed : proposed->shown,
                                       proposed->proposals, BlindChanges(context), proposed->said);
    return Conclude(context, proof, *proposed);
  };
  Diagnosis diagnosis = prove();
  if (diagnosis.verdict == Verdict::kNothingMissing && options.per_run.empty()) return diagnosis;
  diagnosis.per_run = ValuesByRun(context, diagnosis.model, options.per_run, allowed);
  if (!IsOpen(diagnosis.verdict) || !options.per_run.empty() || diagnosis.per_run.empty()) return diagnosis;
  const ValueByRun& own = diagnosis.per_run.front();
  if (!(own.after < own.before)) return diagnosis;  // windows do not confirm what the balances say
  proposed->proposals.insert(proposed->proposals.begin(),
                             WithOwnValues(context, allowed, own.name, *proposed));
  Diagnosis again = prove();
  if (again.by_run.empty() || again.verdict != Verdict::kParameters) return diagnosis;
  again.per_run = ValuesByRun(context, again.model, options.per_run, allowed);
  return again;
}

}  // namespace

Diagnosis Diagnose(const model::ModelDescription& model, std::vector<runs::MeasuredRun> runs,
                   std::vector<runs::MeasuredRun> held_out, const DiagnoseOptions& options,
                   const ProgressCallback& report_progress) {
  TimeLimit limit(options.time_limit, options.jobs);
  CheckedRecordings checked =
      CheckFirst(model, options.effects, options.jobs, &runs, &held_out, [&limit] { return limit.IsUp(); });
  if (checked.mend_first) return MendFirst(model, checked, runs, held_out);
  PreparedRuns prepared =
      Prepare(model, options.jobs, std::move(runs), std::move(held_out), std::move(checked.aligned));
  const std::vector<size_t> allowed = AllowedBase(model, options.free, PointersTo(prepared.fitted));
  ProofContext context = MakeContext(model, prepared, allowed, options, report_progress);
  RequireMotion(context.runs, "fitted");
  RequireMotion(context.held_out, "held-out");
  context.time_is_up = [&limit] { return limit.IsUp(); };

  Hypothesis as_given;
  as_given.model = model;
  as_given.highest_frequency = 0.5 / SampleInterval(context.runs);
  as_given.highest_speed = context.sizes.speed;
  as_given.longest_time = NearHorizon(context.runs);
  if (report_progress) report_progress({"what the balances of the runs show", 0.2});
  Proposed proposed = Propose(context, allowed, checked.inverted);
  Diagnosis diagnosis = ProveAndConclude(context, as_given, allowed, options, &proposed);
  diagnosis.unjudged = proposed.unjudged;
  diagnosis.remarks.insert(diagnosis.remarks.end(), proposed.remarks.begin(), proposed.remarks.end());
  for (const ValueByRun& value : diagnosis.per_run) diagnosis.remarks.push_back(RemarkOn(value));
  const bool matters = IsOpen(diagnosis.verdict) || !diagnosis.by_run.empty();
  if (matters && options.per_run.empty() && !diagnosis.per_run.empty())
    diagnosis.sentence += " " + RemarkOn(diagnosis.per_run.front()) + ".";
  // What says where to go on stands before what qualifies the answer.
  std::vector<std::string> remarks = RecordingRemarks(prepared.clocks, context.runs, context.held_out);
  if (IsOpen(diagnosis.verdict) && options.effects.empty()) {
    const std::string requests = RemarkOnRequests(model, context.changes, context.runs);
    if (!requests.empty()) remarks.push_back(requests);
  }
  diagnosis.remarks.insert(diagnosis.remarks.begin(), remarks.begin(), remarks.end());
  std::vector<const RunData*> all = context.runs;
  all.insert(all.end(), context.held_out.begin(), context.held_out.end());
  const std::vector<std::string> layouts = LayoutRemarks(all);
  diagnosis.remarks.insert(diagnosis.remarks.end(), layouts.begin(), layouts.end());
  const std::vector<std::string> limits = LimitRemarks(model.parameters, context.runs);
  diagnosis.remarks.insert(diagnosis.remarks.end(), limits.begin(), limits.end());
  AddChecked(checked, &diagnosis);
  if (!diagnosis.by_run.empty()) diagnosis.remarks.push_back(RemarkOnOwnValues(diagnosis.by_run));
  if (!diagnosis.choices.empty()) diagnosis.remarks.push_back(ChoiceRemark(diagnosis));
  if (limit.struck()) diagnosis.sentence = limit.Remark() + diagnosis.sentence;
  diagnosis.recording = std::move(prepared.clocks);
  return diagnosis;
}

}  // namespace hydro::diagnose
