#include "logger/tracking.h"

#include <algorithm>
#include <cmath>

namespace hydro {
namespace {

constexpr double kSettlingBand = 0.02;        // of the step
constexpr double kShortestRest = 0.2;         // s
constexpr double kFinalTime = 0.1;            // s
constexpr double kSmallestTolerance = 0.001;  // rad
constexpr size_t kMostSteps = 100;

struct Sample {
  double time;
  double reference;
  double angle;
};

// Reference (held since its tick) and angle at each state that has both.
std::vector<Sample> Samples(const RunLog& log) {
  std::vector<const arm_reference_t*> references;
  for (const arm_reference_t& reference : log.messages.arm_references) {
    if (reference.signal == arm_reference_t::ARM_ANGLE) references.push_back(&reference);
  }
  const auto by_tick = [](const auto* a, const auto* b) { return a->tick < b->tick; };
  std::stable_sort(references.begin(), references.end(), by_tick);
  std::vector<const state_t*> states;
  for (const state_t& state : log.messages.states) states.push_back(&state);
  std::stable_sort(states.begin(), states.end(), by_tick);

  std::vector<Sample> samples;
  size_t next = 0;
  for (const state_t* state : states) {
    while (next < references.size() && references[next]->tick <= state->tick) ++next;
    if (next == 0 || !std::isfinite(state->arm_angle)) continue;
    samples.push_back({state->time, references[next - 1]->value, state->arm_angle});
  }
  return samples;
}

double MeanErrorAtEnd(const std::vector<Sample>& samples, size_t begin, size_t end) {
  double sum = 0;
  int count = 0;
  for (size_t i = end; i > begin && samples[end - 1].time - samples[i - 1].time <= kFinalTime; --i) {
    sum += samples[i - 1].angle - samples[i - 1].reference;
    ++count;
  }
  return sum / count;
}

StepResponse Respond(const std::vector<Sample>& samples, size_t begin, size_t end, double from) {
  StepResponse step;
  step.time_s = samples[begin].time;
  step.from_rad = from;
  step.to_rad = samples[begin].reference;
  const double size = step.to_rad - step.from_rad;
  for (size_t i = begin; i < end; ++i) {
    const double error = samples[i].angle - step.to_rad;
    step.overshoot_percent = std::max(step.overshoot_percent, 100 * error / size);
    if (std::fabs(error) > kSettlingBand * std::fabs(size)) {
      step.settling_time_s.reset();
    } else if (!step.settling_time_s) {
      step.settling_time_s = samples[i].time - step.time_s;
    }
  }
  step.final_error_rad = MeanErrorAtEnd(samples, begin, end);
  return step;
}

std::vector<StepResponse> Steps(const std::vector<Sample>& samples) {
  std::vector<size_t> changes;
  for (size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].reference != samples[i - 1].reference) changes.push_back(i);
  }
  if (changes.size() > kMostSteps) return {};
  std::vector<StepResponse> steps;
  for (size_t k = 0; k < changes.size(); ++k) {
    const size_t end = k + 1 < changes.size() ? changes[k + 1] : samples.size();
    if (samples[end - 1].time - samples[changes[k]].time < kShortestRest) return {};
    steps.push_back(Respond(samples, changes[k], end, samples[changes[k] - 1].reference));
  }
  return steps;
}

}  // namespace

Tracking TrackArm(const RunLog& log) {
  Tracking tracking;
  const std::vector<Sample> samples = Samples(log);
  if (samples.empty()) return tracking;
  tracking.has_reference = true;
  double squares = 0, low = samples.front().reference, high = low;
  for (const Sample& sample : samples) {
    squares += (sample.angle - sample.reference) * (sample.angle - sample.reference);
    low = std::min(low, sample.reference);
    high = std::max(high, sample.reference);
  }
  tracking.rms_error_rad = std::sqrt(squares / static_cast<double>(samples.size()));
  tracking.target_rad = samples.back().reference;
  tracking.final_error_rad = MeanErrorAtEnd(samples, 0, samples.size());
  tracking.steps = Steps(samples);
  double scale = high - low;
  if (!tracking.steps.empty()) {
    scale = 0;
    for (const StepResponse& step : tracking.steps) {
      scale = std::max(scale, std::fabs(step.to_rad - step.from_rad));
    }
  }
  const bool at_rest = std::none_of(samples.begin(), samples.end(), [&](const Sample& sample) {
    return samples.back().time - sample.time <= kFinalTime && sample.reference != tracking.target_rad;
  });
  if (at_rest) {
    tracking.at_target =
        std::fabs(tracking.final_error_rad) <= std::max(kSettlingBand * scale, kSmallestTolerance);
  }
  return tracking;
}

}  // namespace hydro
