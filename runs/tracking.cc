#include "runs/tracking.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/units.h"
#include "runs/recorded/run_config.h"

namespace hydro::runs {
namespace {

constexpr double kShortestRest = 0.2;  // s
constexpr int kRestingReferences = 3;  // with one value at the end: a step that was just made is not motion
constexpr double kSmallestAngle = 0.001;    // rad; a smaller error counts as none
constexpr double kSmallestDistance = 1e-4;  // m, the same for a linear arm
constexpr double kLeastStep = 10;           // multiple of those for a step with which the run begins
constexpr size_t kMostSteps = 100;

struct Samples {
  std::vector<double> times;
  std::vector<double> references;
  std::vector<double> angles;
  int resting = 0;          // number of references with the last value at the end
  bool follow_arm = false;  // the last reference is the arm's position measured then
  size_t size() const { return times.size(); }
};

UnitSystem UnitsOf(const RunLog& log) {
  const auto& descriptions = log.messages.Of<run_description_t>();
  return descriptions.empty() ? UnitSystem{} : ModelUnits(descriptions.front(), log.file);
}

double SmallestTolerance(const UnitSystem& units) {
  return units.linear_arm ? kSmallestDistance / ParseUnit(units.length)->size : kSmallestAngle;
}

// The reference (held since its tick) and the angle at each state that has both.
Samples ReadSamples(const RunLog& log) {
  std::vector<const arm_reference_t*> references;
  for (const arm_reference_t& reference : log.messages.Of<arm_reference_t>()) {
    if (reference.signal == arm_reference_t::ARM_ANGLE) references.push_back(&reference);
  }
  const auto by_tick = [](const auto* a, const auto* b) { return a->tick < b->tick; };
  std::stable_sort(references.begin(), references.end(), by_tick);
  std::vector<const state_t*> states;
  for (const state_t& state : log.messages.Of<state_t>()) states.push_back(&state);
  std::stable_sort(states.begin(), states.end(), by_tick);

  Samples samples;
  const auto moved = std::find_if(references.rbegin(), references.rend(), [&](const auto* reference) {
    return reference->value != references.back()->value;
  });
  samples.resting = static_cast<int>(moved - references.rbegin());
  size_t next = 0;
  for (const state_t* state : states) {
    while (next < references.size() && references[next]->tick <= state->tick) ++next;
    if (next == references.size() && next > 0 && references[next - 1]->tick == state->tick)
      samples.follow_arm = references[next - 1]->value == state->arm_angle;
    if (next == 0 || !std::isfinite(state->arm_angle)) continue;
    samples.times.push_back(state->time);
    samples.references.push_back(references[next - 1]->value);
    samples.angles.push_back(state->arm_angle);
  }
  return samples;
}

// The mean over the last 0.1 s, or, if the reference has rested at its last value for less than that, over
// the time since then, which `time` receives.
double MeanErrorAtEnd(const Samples& samples, bool at_rest, double* time) {
  double sum = 0;
  int count = 0;
  for (size_t i = samples.size(); i-- > 0;) {
    if (at_rest && samples.references[i] != samples.references.back()) break;
    *time = std::min(samples.times.back() - samples.times[i], kFinalTime);
    if (samples.times.back() - samples.times[i] > kFinalTime) break;
    sum += samples.angles[i] - samples.references[i];
    ++count;
  }
  return sum / count;
}

// Whether the reference has a target at the end. It has none if it moved within the last 0.1 s, unless that
// was a step.
bool RestsAtEnd(const Samples& samples) {
  if (samples.resting >= kRestingReferences) return true;
  for (size_t i = samples.size(); i-- > 0;) {
    if (samples.times.back() - samples.times[i] > kFinalTime) break;
    if (samples.references[i] != samples.references.back()) return false;
  }
  return true;
}

// The reference rests between two changes that are at least kShortestRest apart. Elsewhere it moves: a ramp,
// a curve, or the way back after a hold.
std::vector<StepResponse> Steps(const Samples& samples, double tolerance, int* left_out) {
  std::vector<size_t> changes{0};  // including both ends
  for (size_t i = 1; i < samples.size(); ++i) {
    if (samples.references[i] != samples.references[i - 1]) changes.push_back(i);
  }
  changes.push_back(samples.size());
  const auto rests = [&](size_t k) {
    return samples.times[changes[k + 1] - 1] - samples.times[changes[k]] >= kShortestRest;
  };
  const size_t last = changes.size() - 2;
  const auto is_step = [&](size_t k) { return k > 0 && k <= last && (k == 1 || rests(k - 1)) && rests(k); };
  std::vector<StepResponse> steps;
  // A reference that never changes, but differs from the arm's first position, is a step with which the run
  // began.
  if (changes.size() == 2 && std::fabs(samples.angles[0] - samples.references[0]) >= kLeastStep * tolerance &&
      rests(0)) {
    steps.push_back(MeasureStep(samples.times, samples.angles, 0, samples.size(), samples.angles[0],
                                samples.references[0], tolerance));
  }
  for (size_t k = 1; k <= last; ++k) {
    if (!is_step(k)) continue;
    if (k < last && !is_step(k + 1)) {
      ++*left_out;
      continue;
    }
    steps.push_back(MeasureStep(samples.times, samples.angles, changes[k], changes[k + 1],
                                samples.references[changes[k] - 1], samples.references[changes[k]],
                                tolerance));
    if (steps.size() > kMostSteps) return {};
  }
  return steps;
}

// The tolerance of the step to the last reference, or as much of the reference's range where no step leads
// there.
double ToleranceAtEnd(const Samples& samples, const std::vector<StepResponse>& steps, double smallest) {
  if (!steps.empty() && steps.back().to_rad == samples.references.back()) return steps.back().tolerance_rad;
  const auto [low, high] = std::minmax_element(samples.references.begin(), samples.references.end());
  return std::max(kSettlingBand * (*high - *low), smallest);
}

template <class Message>
auto NewestOf(const std::vector<Message>& messages) {
  return std::max_element(messages.begin(), messages.end(),
                          [](const Message& a, const Message& b) { return a.tick < b.tick; });
}

// Whether the voltage was held at zero within the last 0.1 s of a run that had begun: an arm that was let go
// so lately has not had the time to reach a target. The plant may hold it, or the pressure loop with its safe
// commands. A position loop in lockstep does not hear of those, and then does not follow the arm.
bool IsHeldAtEnd(const RunMessages& messages, bool follow_arm) {
  const std::vector<state_t>& states = messages.Of<state_t>();
  int64_t begun = std::numeric_limits<int64_t>::max();  // the first tick with a command
  for (const state_t& state : states) {
    if (state.command_tick >= 0) begun = std::min(begun, state.tick);
  }
  if (begun == std::numeric_limits<int64_t>::max()) return false;
  const double end = NewestOf(states)->time;
  int64_t first = NewestOf(states)->tick;  // of the last 0.1 s
  for (const state_t& state : states) {
    if (state.tick < begun || !(end - state.time <= kFinalTime)) continue;
    if (state.command_tick < 0) return true;
    first = std::min(first, state.tick);
  }
  if (!follow_arm) return false;
  int64_t newest = 0, safe = -1;  // the ticks of the newest command, and of the newest safe one
  for (const motor_command_t& command : messages.Of<motor_command_t>()) {
    if (command.status == motor_command_t::STOPPED) continue;
    newest = std::max(newest, command.tick);
    if (command.status == motor_command_t::SAFE) safe = std::max(safe, command.tick);
  }
  return safe >= std::min(first, newest);
}

}  // namespace

Tracking TrackArm(const RunLog& log) {
  Tracking tracking;
  tracking.units = UnitsOf(log);
  const double tolerance = SmallestTolerance(tracking.units);
  const Samples samples = ReadSamples(log);
  if (samples.size() == 0) return tracking;
  tracking.has_reference = true;
  double squares = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double error = samples.angles[i] - samples.references[i];
    squares += error * error;
  }
  tracking.rms_error_rad = std::sqrt(squares / static_cast<double>(samples.size()));
  tracking.target_rad = samples.references.back();
  const bool at_rest = RestsAtEnd(samples);
  tracking.final_error_rad = MeanErrorAtEnd(samples, at_rest, &tracking.final_time_s);
  tracking.steps = Steps(samples, tolerance, &tracking.steps_left_out);
  tracking.tolerance_rad = ToleranceAtEnd(samples, tracking.steps, tolerance);
  tracking.held = IsHeldAtEnd(log.messages, samples.follow_arm);
  if (at_rest && !tracking.held)
    tracking.at_target = std::fabs(tracking.final_error_rad) <= tracking.tolerance_rad;
  return tracking;
}

}  // namespace hydro::runs
