#include "diagnose/say/per_run.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/evidence/run_values.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/prove/proved_set.h"
#include "diagnose/recording/windows.h"

namespace hydro::diagnose {
namespace {

// Every third window of a run judges, and the balances do not see it. With eight of each run, a difference
// of 5 % shows in a few runs.
constexpr size_t kEach = 3, kJudgingOfARun = 8;

// The run without everything that was measured during the windows.
RunData WithoutWindows(const RunData& run, const std::vector<const RunData*>& windows) {
  RunData rest;
  rest.name = run.name;
  rest.measured = run.measured;
  rest.stimulus = run.stimulus;
  rest.signals = run.signals;
  const auto take = [&](std::vector<double>* values) {
    for (size_t i = 0; i < values->size(); ++i) {
      const double time = run.stimulus.time[i];
      const bool within = std::ranges::any_of(windows, [time](const RunData* window) {
        return time >= window->stimulus.time.front() && time <= window->stimulus.time.back();
      });
      if (within) (*values)[i] = std::numeric_limits<double>::quiet_NaN();
    }
  };
  for (SignalData& signal : rest.signals) take(&signal.values);
  return rest;
}

// All runs, cut into a part for the estimate and a part that judges.
struct CutRuns {
  std::vector<const RunData*> runs;
  std::vector<RunData> windows, rest;
  JudgingWindows judging;
  bool possible = false;  // each run has a judging window

  explicit CutRuns(const ProofContext& context) : runs(context.runs) {
    runs.insert(runs.end(), context.held_out.begin(), context.held_out.end());
    // A start that is corrected hides a value's error over a short window. Over a long one values show most.
    const double near = NearHorizon(runs);
    for (const double seconds : {kFarTimes * near, near}) {
      if (!possible) Cut(context.given.parameters, seconds);
    }
  }

 private:
  void Cut(const model::Parameters& given, double seconds) {
    windows.clear();
    rest.clear();
    judging = {seconds, {}, {}};
    possible = runs.size() > 1;
    std::vector<std::pair<size_t, size_t>> chosen;  // places among `windows`, and their runs
    for (size_t r = 0; r < runs.size(); ++r) {
      std::vector<RunData> all = WindowsOf(*runs[r], seconds, given);
      const std::vector<const RunData*> judge = EvenlySpread(all, kJudgingOfARun, 1, kEach);
      possible = possible && !judge.empty();
      rest.push_back(WithoutWindows(*runs[r], judge));
      for (RunData& window : all) {
        if (std::ranges::find(judge, &window) == judge.end()) continue;
        chosen.emplace_back(windows.size(), r);
        windows.push_back(std::move(window));
      }
    }
    for (const auto& [place, run] : chosen) {
      judging.windows.push_back(&windows[place]);
      judging.runs.push_back(run);
    }
  }
};

// What windows that the balances did not see say about it.
ValueByRun Judged(const CutRuns& cut, const model::ModelDescription& model, const RunValues& of, int jobs) {
  const model::BaseParameter& base = model::BaseParameters()[of.base];
  ValueByRun value;
  value.name = base.info.name;
  value.unit = base.info.UnitIn(model.units);
  model::ModelDescription shared = model;
  shared.parameters.*base.member = of.common;
  const auto gaps_with = [&](const model::ModelDescription& one) {
    return GapsOfWindows([&](size_t) -> const model::ModelDescription& { return one; }, cut.judging, jobs);
  };
  std::vector<model::ModelDescription> own(cut.runs.size(), model);
  for (size_t r = 0; r < own.size(); ++r) {
    own[r].parameters.*base.member = of.value[r];
    value.values.push_back({cut.runs[r]->name, of.value[r], of.low[r], of.high[r], "", true});
  }
  // The value that was found, or one that suits all runs as these were cut, whichever predicts better.
  std::vector<WindowGap> before = gaps_with(shared), found = gaps_with(model);
  if (FallOf(before, found).logarithm > 0) before = std::move(found);
  const std::vector<WindowGap> after = GapsOfWindows(
      [&](size_t run) -> const model::ModelDescription& { return own[run]; }, cut.judging, jobs);
  value.before = std::sqrt(TypicalGap(before));
  value.after = std::sqrt(TypicalGap(after));
  // Balances and windows are two witnesses, as of effects: where the balances are sure, windows only must not
  // object.
  const double weight = 1 / (1 + std::exp(-of.gain / kTemperature));
  const GapFall fall = FallOf(before, after);
  value.differs =
      of.gain > 0 && fall.logarithm >= PriceOf(weight) && fall.logarithm >= -std::max(kEqual, fall.error);
  return value;
}

}  // namespace

double ValueByRun::Spread() const {
  double mean = 0, square = 0, count = 0;
  for (const Estimated& run : values) {
    if (std::isnan(run.value)) continue;
    mean += run.value;
    count += 1;
  }
  if (count < 2 || mean == 0) return 0;
  mean /= count;
  for (const Estimated& run : values) {
    if (!std::isnan(run.value)) square += std::pow(run.value - mean, 2);
  }
  return std::sqrt(square / (count - 1)) / std::abs(mean);
}

std::vector<ValueByRun> ValuesByRun(const ProofContext& context, const model::ModelDescription& model,
                                    const std::vector<std::string>& asked,
                                    const std::vector<size_t>& allowed) {
  const CutRuns cut(context);
  if (!cut.possible) return {};
  std::vector<size_t> places(asked.size());
  std::ranges::transform(asked, places.begin(), model::BasePlace);
  if (asked.empty()) places = ValuesOfADay(allowed);
  std::vector<RunValues> all;
  for (const size_t base : places) {
    if (const std::optional<RunValues> values = ValuesOfRuns(model, PointersTo(cut.rest), base, context.jobs))
      all.push_back(*values);
  }
  std::vector<ValueByRun> values;
  if (!asked.empty()) {
    for (const RunValues& one : all) values.push_back(Judged(cut, model, one, context.jobs));
    return values;
  }
  for (const RunValues& one : all) {
    if (!(one.gain > 0)) continue;
    ValueByRun value = Judged(cut, model, one, context.jobs);
    if (!value.differs || (!values.empty() && value.after >= values.front().after)) continue;
    values = {std::move(value)};
  }
  return values;
}

std::string RemarkOnOwnValues(const std::vector<std::string>& by_run) {
  const std::string names = Enumerated(by_run);
  return names +
         " of each run was estimated from that run itself, so the held-out gap tests everything but " +
         names + ", which windows that were kept from the estimate test (per_run in report.json)";
}

std::string RemarkOn(const ValueByRun& value) {
  // A single recording was split into a part to fit and a part to hold out.
  const bool parts = value.values.size() == 2 && value.values[1].name.starts_with(value.values[0].name + ",");
  const std::string between = parts ? "from one part of the recording to the other" : "from run to run";
  if (!value.differs) return value.name + " does not differ " + between;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Estimated& run : value.values) {
    if (std::isnan(run.value)) continue;
    low = std::min(low, run.value);
    high = std::max(high, run.value);
  }
  const std::string differs = value.name + " differs " + between + " by " +
                              ShortNumber(100 * value.Spread(), 2) + " % (" + ShortNumber(low, 3) + " to " +
                              ShortNumber(high, 3) + " " + value.unit + ")";
  if (!(value.after < value.before))
    return differs + ", as the balances show; predictions over its windows neither confirm nor deny it";
  return differs + ": with a value of its own for each, the typical gap of its windows is " +
         ShortNumber(value.after, 3) + " instead of " + ShortNumber(value.before, 3) + " noise units";
}

}  // namespace hydro::diagnose
