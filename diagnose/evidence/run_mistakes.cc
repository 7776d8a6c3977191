#include "diagnose/evidence/run_mistakes.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "base/maths/spread.h"
#include "diagnose/recording/run_data.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

// The number of sets that are tried with one more mistake.
constexpr size_t kExtended = 16;
// Whether the motor certainly moves. The balances of a run at rest consist of noise, and any unit explains
// some of it.
bool Moves(const Run& run) {
  for (const SignalOfRun signal : {&Run::motor_speed, &Run::motor_angle}) {
    const runs::MeasuredSignal& measured = run.*signal;
    if (!measured.measured()) continue;
    const double steps = std::max(measured.noise.value_or(0), EstimateResolution(measured.values));
    if (maths::RangeOf(measured.values).size() > 2 * kHardlyMoves * steps) return true;
  }
  return false;
}

bool IsPossible(const Mistakes& mistakes, const RecordingMistake& one) {
  return std::ranges::none_of(
      mistakes, [&](const RecordingMistake& other) { return other == one || Exclude(other, one); });
}

// Whether other factors of the signals do not correct it.
bool NeedsAnotherReading(const RecordingMistake& one) {
  return one.time_factor != 1 || one.shaft.has_value() || one.unsigned_signal.has_value();
}

}  // namespace

double OddsAgainstMistake() { return std::log(1000.0); }
double ClearGain() { return std::log(10.0); }

RunMistakes::RunMistakes(const model::ModelDescription& model, Run run)
    : model_(model), run_(std::move(run)), possible_(PossibleMistakes(run_)) {
  for (const runs::SignalName& one : runs::kSignals) {
    runs::MeasuredSignal& signal = run_.*one.signal;
    if (signal.measured() && !signal.noise.has_value()) signal.noise = EstimateNoise(signal.values);
  }
  moves_ = Moves(run_);
  const double interval = runs::MedianInterval(run_.time);
  std::erase_if(possible_, [&](const RecordingMistake& mistake) {
    const double step = mistake.time_factor * interval;
    return mistake.time_factor != 1 && (step > runs::kSlowestSamples || step < runs::kFastestSamples);
  });
  const Mistakes shafts = OtherShafts(run_, model_.parameters);
  possible_.insert(possible_.end(), shafts.begin(), shafts.end());
  const RecordingBalances* given = Read({});
  as_recorded_ = given == nullptr ? 0 : given->Evidence({});
}

// The balances with the times, the shaft and the signs of these mistakes; null: no recording of such a
// machine has samples so far apart, or so close.
const RecordingBalances* RunMistakes::Read(const Mistakes& mistakes) const {
  std::tuple<double, model::Shaft, std::string> reading = {1, run_.shaft, ""};
  for (const RecordingMistake& one : mistakes) {
    std::get<double>(reading) *= one.time_factor;
    std::get<model::Shaft>(reading) = one.shaft.value_or(std::get<model::Shaft>(reading));
    if (one.unsigned_signal.has_value()) std::get<std::string>(reading) += NameOf(*one.unsigned_signal);
  }
  const double interval = std::get<double>(reading) * runs::MedianInterval(run_.time);
  if (interval > runs::kSlowestSamples || interval < runs::kFastestSamples) return nullptr;
  const auto known = readings_.find(reading);
  if (known != readings_.end()) return &known->second;
  Run run = run_;
  for (const RecordingMistake& one : mistakes) {
    if (NeedsAnotherReading(one)) Correct(one, &run);
  }
  return &readings_.emplace(reading, RecordingBalances(model_, run, possible_)).first->second;
}

double RunMistakes::Gain(const Mistakes& mistakes) const {
  const RecordingBalances* balances = Read(mistakes);
  if (balances == nullptr) return -as_recorded_;
  SignalFactors factors;
  for (const RecordingMistake& one : mistakes) AddFactors(one, &factors);
  return balances->Evidence(factors) - as_recorded_;
}

MistakeTrial RunMistakes::Try(const Mistakes& mistakes) const {
  Mistakes own;
  std::copy_if(mistakes.begin(), mistakes.end(), std::back_inserter(own), [&](const RecordingMistake& one) {
    return std::ranges::find(possible_, one) != possible_.end();
  });
  const double gain = Gain(own);
  return {std::move(own), gain};
}

std::vector<MistakeTrial> RunMistakes::Search(const std::function<bool()>& time_is_up) const {
  if (!moves_) return {};
  std::vector<MistakeTrial> all;
  std::vector<MistakeTrial> from = {{}};
  double best = 0;
  while (!from.empty()) {
    std::vector<MistakeTrial> next;
    for (const MistakeTrial& one : from) {
      if (time_is_up()) return all;
      for (const RecordingMistake& more : possible_) {
        if (!IsPossible(one.mistakes, more)) continue;
        Mistakes set;  // in the order of the possible mistakes, so that each set occurs once
        for (const RecordingMistake& other : possible_) {
          const bool in = other == more || std::ranges::find(one.mistakes, other) != one.mistakes.end();
          if (in) set.push_back(other);
        }
        const bool known =
            std::ranges::any_of(next, [&](const MistakeTrial& trial) { return trial.mistakes == set; });
        if (known) continue;
        const double gain = Gain(set);
        next.push_back({std::move(set), gain});
      }
    }
    std::ranges::stable_sort(next,
                             [](const MistakeTrial& a, const MistakeTrial& b) { return a.gain > b.gain; });
    all.insert(all.end(), next.begin(), next.end());
    // Two mistakes may hide each other; a third has to add to the evidence.
    const bool brings = !next.empty() && next.front().Merit() > best;
    if (brings) best = next.front().Merit();
    const bool first = from.size() == 1 && from.front().mistakes.empty();
    if (!brings && !first) break;
    if (next.size() > kExtended) next.resize(kExtended);
    from = std::move(next);
  }
  std::ranges::stable_sort(
      all, [](const MistakeTrial& a, const MistakeTrial& b) { return a.Merit() > b.Merit(); });
  return all;
}

bool RunMistakes::Formed() const {
  const RecordingBalances* given = Read({});
  return given != nullptr && given->Formed();
}

double RunMistakes::LeastLeftOpen() const {
  const RecordingBalances* given = Read({});
  return given == nullptr ? 1 : given->LeastLeftOpen();
}

}  // namespace hydro::diagnose
