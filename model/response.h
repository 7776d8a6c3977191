// What a model predicts for a recorded run, with exact derivatives. Fits rest on this simulation. It has the
// equations, modes and effects of Actuator, integrated by a Runge-Kutta method whose steps also carry
// derivatives. At an event the derivatives jump, because the event's time depends on the unknowns.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "model/actuator.h"
#include "model/terms/description.h"
#include "model/terms/measurement.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

// A number of one of the model's effects: a parameter, or an entry of one that is a list.
struct EffectParameter {
  size_t effect = 0;  // in ModelDescription::effects
  std::string name;
  std::optional<size_t> place = std::nullopt;  // in the list

  // "speed", "values[3]"
  std::string Label() const;
  // Whether the model states it. A number that may be left out otherwise has its standard, and a response has
  // no derivative by it.
  bool IsStated(const ModelDescription& model) const;
  // A reference to its value in the model, which states it from then on.
  double& In(ModelDescription* model) const;
};

// All such numbers of a model: effects as they are applied, and the parameters of each in the
// catalogue's order. Throws ModelError for an unknown effect.
std::vector<EffectParameter> EffectParameters(const ModelDescription& model);

// The inputs of the actuator in a run, and the times of its samples.
struct Stimulus {
  Shaft shaft = Shaft::kFree;
  double arm_angle = 0;                            // rad, clamped
  const trajectory::Trajectory* motion = nullptr;  // rad over s, driven
  bool bypass = false;
  double begin = 0;             // s, of the whole run: the effects' t counts from here
  std::vector<double> time;     // s, increasing
  std::vector<double> voltage;  // V, each held from its time to the next
  // The outside influences at each time, interpolated linearly between them; empty: none at any time.
  std::vector<Surroundings> around = {};
};

// The base states at the first time, indexed as in model/state.h, followed by what no sensor shows. The arm's
// states are used with a free shaft only; with the bypass open, p2 is p1. Pressures below p_3 start at p_3.
// The states of effects start from these.
using StartState = std::array<double, 12>;
// rad: how much more than the angle sensor an effect that repeats with the shaft sees (motor.cogging,
// pump.flow_ripple).
inline constexpr size_t kTurn = 6;
// psi, four numbers: the waves under way in the lines of line.wave. For each side: the pump's pressure less
// the actuator's, and the line's flow times its impedance I w.
inline constexpr size_t kWaves = 7, kWaveNumbers = 4;
// in^3: the volume by which the accumulator and the sides together hold more oil than where all of them are
// at p_3. The accumulator's pressure begins where what the sides' oil is compressed by is missing from it.
inline constexpr size_t kReturned = 11;

struct Response {
  // By channel, then by sample; empty for channels that were not requested.
  std::array<std::vector<double>, kChannels> values;
  // By unknown, then as `values`.
  std::vector<std::array<std::vector<double>, kChannels>> derivatives;
};

struct ResponseOptions {
  ChannelSet channels = {true, true, true, true, true, true};
  double relative_tolerance = 1e-6;
  // A simulation with more steps than these and kStepsPerSecond (response_pass.h) throws ModelError, so that
  // a far too stiff model does not take hours.
  double most_steps_per_sample = 20;
  // Every stride-th sample is read. The command still changes at all samples.
  size_t stride = 1;
};

// Throws ModelError as Actuator does. Identical arguments give identical bits, and the values do not depend
// on which unknowns are chosen.
Response Respond(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
                 const std::vector<Unknown>& unknowns, const ResponseOptions& options);

}  // namespace hydro::model
