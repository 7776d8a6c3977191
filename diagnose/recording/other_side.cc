#include "diagnose/recording/other_side.h"

#include <algorithm>
#include <iterator>

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;
using Mistakes = std::vector<RecordingMistake>;

bool HasSign(const Mistakes& mistakes, SignalOfRun signal) {
  return std::ranges::any_of(mistakes, [signal](const RecordingMistake& mistake) {
    return mistake.IsSign() &&
           std::ranges::any_of(mistake.factors, [signal](const auto& one) { return one.first == signal; });
  });
}

// Those of the given signals of one body that change sign: all measured ones except those that the mistakes
// already invert.
std::vector<SignalOfRun> Turned(const Run& run, const Mistakes& mistakes,
                                const std::vector<SignalOfRun>& signals) {
  std::vector<SignalOfRun> turned;
  for (const SignalOfRun signal : signals) {
    if ((run.*signal).measured() && !HasSign(mistakes, signal)) turned.push_back(signal);
  }
  return turned;
}

bool IsSignOf(const RecordingMistake& mistake, const std::vector<SignalOfRun>& signals) {
  return mistake.IsSign() &&
         std::equal(mistake.factors.begin(), mistake.factors.end(), signals.begin(), signals.end(),
                    [](const auto& one, SignalOfRun signal) { return one.first == signal; });
}

}  // namespace

std::optional<Mistakes> SeenFromTheOtherSide(const Mistakes& mistakes, const Run& run) {
  const bool one_pressure = run.p1.measured() != run.p2.measured();
  // In the twin, a mistake of one pressure would have to name the other side.
  const bool of_one = std::ranges::any_of(
      mistakes, [](const RecordingMistake& mistake) { return mistake.IsOfOnePressure(); });
  if (one_pressure || of_one) return std::nullopt;
  const bool clamped = run.shaft == model::Shaft::kClamped;
  const std::vector<std::vector<SignalOfRun>> turned = {
      Turned(run, mistakes, {&Run::voltage}), Turned(run, mistakes, {&Run::motor_speed, &Run::motor_angle}),
      clamped ? std::vector<SignalOfRun>{} : Turned(run, mistakes, {&Run::arm_angle, &Run::arm_speed})};
  const bool exchanged =
      std::ranges::any_of(mistakes, [](const auto& mistake) { return mistake.pressures_exchanged; });
  Mistakes twin;
  for (const RecordingMistake& possible : PossibleMistakes(run)) {
    const bool sign = std::ranges::any_of(
        turned, [&](const auto& signals) { return !signals.empty() && IsSignOf(possible, signals); });
    const bool stays = !possible.IsSign() && !possible.pressures_exchanged &&
                       std::ranges::find(mistakes, possible) != mistakes.end();
    if (sign || stays || (possible.pressures_exchanged && !exchanged)) twin.push_back(possible);
  }
  std::copy_if(mistakes.begin(), mistakes.end(), std::back_inserter(twin),
               [](const RecordingMistake& mistake) { return mistake.shaft.has_value(); });
  return twin;
}

}  // namespace hydro::diagnose
