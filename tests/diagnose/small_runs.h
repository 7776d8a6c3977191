// Short runs of a noisy rig, one for each way of holding the shaft, for tests of fits and statistics.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/fit/fit.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::testing {

inline ModelDescription Table1With(std::vector<EffectDescription> effects = {}) {
  return {"Table 1", Table1(), std::move(effects)};
}

// Levels of both signs, some too weak to break away, some that saturate the amplifier; each run others.
inline double Levels(double t, int which) {
  constexpr double kLevels[] = {3, -2, 6, 0.8, -5, 4, -7, 1.5, -3, 8, -12, 2, 11, -1, 5};
  return kLevels[(static_cast<int>(t / 0.07) + 4 * which) % 15];
}

inline RunData SmallRun(const ModelDescription& truth, Shaft shaft, bool bypass, double duration, int which,
                        uint64_t seed) {
  NoisyRig rig;
  rig.model = truth;
  rig.seed = 100 * seed + static_cast<uint64_t>(which);
  const std::string name = (bypass                  ? "bypass "
                            : shaft == Shaft::kFree ? "free "
                                                    : "clamped ") +
                           std::to_string(which);
  const double angle = shaft == Shaft::kFree ? -0.1 : 0.3 - 0.2 * which;
  // A free arm is kept from drifting off by levels that come in pairs.
  return rig.Record(name, shaft, angle, duration, bypass, [&](double t) {
    if (shaft != Shaft::kFree) return Levels(t, which);
    return std::fmod(t, 0.3) < 0.15 ? 3.0 + which : -3.0 - which;
  });
}

inline std::vector<RunData> ClampedPair(const ModelDescription& truth, double duration, uint64_t seed) {
  std::vector<RunData> runs;
  runs.push_back(SmallRun(truth, Shaft::kClamped, false, duration, 0, seed));
  runs.push_back(SmallRun(truth, Shaft::kClamped, false, duration, 1, seed));
  return runs;
}

inline std::vector<RunData> OneOfEach(const ModelDescription& truth, double duration, uint64_t seed) {
  std::vector<RunData> runs = ClampedPair(truth, duration, seed);
  runs.push_back(SmallRun(truth, Shaft::kFree, false, duration, 2, seed));
  runs.push_back(SmallRun(truth, Shaft::kClamped, true, duration, 3, seed));
  return runs;
}

inline std::vector<const RunData*> PointersTo(const std::vector<RunData>& runs) {
  std::vector<const RunData*> pointers;
  for (const RunData& run : runs) pointers.push_back(&run);
  return pointers;
}

inline std::vector<StartState> StartsOf(const std::vector<RunData>& runs) {
  std::vector<StartState> starts;
  for (const RunData& run : runs) starts.push_back(run.start);
  return starts;
}

// The model with these base parameters free, and the parameters of all of its effects.
inline Hypothesis WithFree(const ModelDescription& model, const std::vector<std::string>& base) {
  Hypothesis hypothesis;
  hypothesis.model = model;
  for (const std::string& name : base) hypothesis.base.push_back(BasePlace(name));
  for (const EffectDescription& effect : model.effects) hypothesis.effects.push_back(effect.id);
  return hypothesis;
}

}  // namespace hydro::testing
