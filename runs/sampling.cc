#include "runs/sampling.h"

#include <algorithm>
#include <vector>

#include "base/input_error.h"
#include "base/saturating.h"

namespace hydro::runs {
namespace {

constexpr char kLimb[] = "hydro-limb";

bool IsOfALimb(const RunMessages& messages) {
  const auto& descriptions = messages.Of<run_description_t>();
  return std::any_of(descriptions.begin(), descriptions.end(),
                     [](const run_description_t& run) { return run.program == kLimb; });
}

int64_t Median(std::vector<int64_t> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

// A limb numbers only the states that it sends, so those that it left out do not count as lost.
int64_t SampleTicks(const RunMessages& messages) {
  if (!IsOfALimb(messages)) return 1;
  const auto& states = messages.Of<state_t>();
  std::vector<int64_t> steps, left_out;
  for (size_t i = 1; i < states.size(); ++i) {
    if (states[i].sequence != SaturatingSum(states[i - 1].sequence, 1)) continue;
    steps.push_back(SaturatingDifference(states[i].tick, states[i - 1].tick));
    const int64_t skipped = SaturatingSum(1, std::max<int64_t>(0, states[i].skipped_ticks));
    left_out.push_back(SaturatingDifference(steps.back(), skipped));
  }
  return steps.empty() || Median(left_out) <= 0 ? 1 : Median(steps);
}

std::string DescribeSampling(int64_t sample_ticks) {
  if (sample_ticks <= 1) return {};
  return "a state every " + std::to_string(sample_ticks) + " ticks (limb.telemetry_hz)";
}

void RequireEveryState(const RunLog& log, const std::string& needs_it) {
  const int64_t sampled = SampleTicks(log.messages);
  if (sampled <= 1) return;
  throw InputError(log.file + (log.joint.empty() ? "" : ": joint " + log.joint) + ": found " +
                   DescribeSampling(sampled) + ", allowed is each for " + needs_it +
                   ": record with limb.telemetry_hz = \"every_tick\", in lockstep, or with hydro-sim");
}

}  // namespace hydro::runs
