// Short runs of a noisy rig, one for each way of holding the shaft, for tests of fits and statistics.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/fit/fit.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::testing {

inline model::ModelDescription Table1With(std::vector<model::EffectDescription> effects = {}) {
  return {"Table 1", Table1(), std::move(effects)};
}

// Levels of both signs, some too weak to break away, some that saturate the amplifier; different in each run.
inline double Levels(double t, int which) {
  constexpr double kLevels[] = {3, -2, 6, 0.8, -5, 4, -7, 1.5, -3, 8, -12, 2, 11, -1, 5};
  return kLevels[(static_cast<int>(t / 0.07) + 4 * which) % 15];
}

inline diagnose::RunData SmallRun(const model::ModelDescription& truth, model::Shaft shaft, bool bypass,
                                  double duration, int which, uint64_t seed) {
  NoisyRig rig;
  rig.model = truth;
  rig.seed = 100 * seed + static_cast<uint64_t>(which);
  const std::string name = (bypass                         ? "bypass "
                            : shaft == model::Shaft::kFree ? "free "
                                                           : "clamped ") +
                           std::to_string(which);
  const double angle = shaft == model::Shaft::kFree ? -0.1 : 0.3 - 0.2 * which;
  // Levels in pairs keep a free arm from drifting off.
  return rig.Record(name, shaft, angle, duration, bypass, [&](double t) {
    if (shaft != model::Shaft::kFree) return Levels(t, which);
    return std::fmod(t, 0.3) < 0.15 ? 3.0 + which : -3.0 - which;
  });
}

inline std::vector<diagnose::RunData> ClampedPair(const model::ModelDescription& truth, double duration,
                                                  uint64_t seed) {
  std::vector<diagnose::RunData> runs;
  runs.push_back(SmallRun(truth, model::Shaft::kClamped, false, duration, 0, seed));
  runs.push_back(SmallRun(truth, model::Shaft::kClamped, false, duration, 1, seed));
  return runs;
}

inline std::vector<diagnose::RunData> OneOfEach(const model::ModelDescription& truth, double duration,
                                                uint64_t seed) {
  std::vector<diagnose::RunData> runs = ClampedPair(truth, duration, seed);
  runs.push_back(SmallRun(truth, model::Shaft::kFree, false, duration, 2, seed));
  runs.push_back(SmallRun(truth, model::Shaft::kClamped, true, duration, 3, seed));
  return runs;
}

inline std::vector<model::StartState> StartsOf(const std::vector<diagnose::RunData>& runs) {
  std::vector<model::StartState> starts;
  for (const diagnose::RunData& run : runs) starts.push_back(run.start);
  return starts;
}

// The model with these base parameters and all parameters of its effects free.
inline diagnose::Hypothesis WithFree(const model::ModelDescription& model,
                                     const std::vector<std::string>& base) {
  diagnose::Hypothesis hypothesis;
  hypothesis.model = model;
  for (const std::string& name : base) hypothesis.base.push_back(model::BasePlace(name));
  for (const model::EffectDescription& effect : model.effects) hypothesis.effects.push_back(effect.id);
  return hypothesis;
}

}  // namespace hydro::testing
