#include "diagnose/locate/smoother_mode.h"

#include <algorithm>
#include <cmath>

namespace hydro::diagnose::smoother {
namespace {

constexpr size_t kPumpTorque = static_cast<size_t>(Balance::kPumpTorque);
constexpr size_t kFlow1 = static_cast<size_t>(Balance::kFlow1);
constexpr size_t kModeArmTorque = static_cast<size_t>(Balance::kArmTorque);

// The direction, +1 or -1, in which the torque overcomes static friction; 0 if it does not.
int8_t BreaksAway(const model::Terms<double>& terms) {
  if (std::abs(terms.net_torque) <= terms.breakaway) return 0;
  return terms.net_torque > 0 ? 1 : -1;
}

}  // namespace

// Where a side's pressure lies relative to p_3.
ModeAtSample::Rest ModeAtSample::RestOf(int side, size_t k, double pressure, double p_3) const {
  const ObservedMode& observed = setup_.observed;
  const std::vector<double>& measured = side == 0 ? observed.p1 : observed.p2;
  const double margin = side == 0 ? observed.p1_margin : observed.p2_margin;
  if (measured.empty() || std::isnan(measured[k])) {
    return pressure <= p_3 + std::max(margin, 1e-3 * std::abs(p_3)) ? Rest::kAt : Rest::kAbove;
  }
  // Below p_3 no one-way valve holds the pressure: the flow that does is what is missing.
  if (measured[k] < p_3 - margin) return Rest::kBelow;
  if (measured[k] <= p_3 + margin) return Rest::kAt;
  const size_t reach = 2 * observed.half_window + 1;
  const size_t end = std::min(measured.size(), k + reach + 1);
  for (size_t i = k < reach ? 0 : k - reach; i < end; ++i) {
    if (measured[i] <= p_3 + margin && measured[i] >= p_3 - margin) return Rest::kNear;
  }
  return Rest::kAbove;
}

void ModeAtSample::SetPump(size_t k, double speed, const model::Terms<double>& terms, model::Mode* mode,
                           std::array<uint8_t, kBalances>* informative) const {
  const ObservedMode& observed = setup_.observed;
  if (observed.speed_measured()) {
    mode->pump = observed.turns[k];
    // Where the model says that the pump turns and the data say that it rests, friction holds it beyond its
    // limit.
    if (mode->pump == 0) mode->pump = BreaksAway(terms);
    if (observed.passes[k]) (*informative)[kPumpTorque] = 0;
  } else if (mode->pump == 0 || mode->pump * speed <= 0) {
    mode->pump = BreaksAway(terms);
  }
  if (mode->pump == 0) (*informative)[kPumpTorque] = 0;
}

void ModeAtSample::SetValves(const model::Equations& equations, size_t k, const double* state,
                             const model::Terms<double>& terms, model::Mode* mode,
                             std::array<uint8_t, kBalances>* informative) {
  const std::array<double, 2> free_rate = {terms.free_rate_1, terms.free_rate_2};
  for (int side = 0; side < 2; ++side) {
    const double pressure = state[side == 0 ? model::kP1 : model::kP2];
    const Rest rest = RestOf(side, k, pressure, terms.p_3);
    at_valve_[side] = rest == Rest::kNear || rest == Rest::kAt;
    if (!equations.data().ideal_valves) continue;
    int8_t& valve = side == 0 ? mode->valve_1 : mode->valve_2;
    valve = at_valve_[side] && free_rate[side] < 0 ? 1 : 0;
    // Just before the valve opens and just after it closes, an average cannot tell which side of p_3 the
    // pressure is on.
    if (at_valve_[side]) (*informative)[kFlow1 + side] = 0;
    free_rate_[side] = free_rate[side];
  }
  if (setup_.run.stimulus.bypass) mode->valve_2 = 0;
}

void ModeAtSample::Set(const model::Equations& equations, size_t k, double voltage, const double* state,
                       model::Mode* mode, model::Terms<double>* terms, double* rate,
                       std::array<uint8_t, kBalances>* informative) {
  const double time = setup_.time[k];
  model::Mode open = *mode;
  open.pump = 0;
  open.valve_1 = open.valve_2 = 0;
  equations.Evaluate(time, voltage, open, state, rate, terms);
  informative->fill(1);
  SetPump(k, state[model::kMotorSpeed], *terms, mode, informative);
  SetValves(equations, k, state, *terms, mode, informative);
  equations.Evaluate(time, voltage, *mode, state, rate, terms);
  // An arm that an effect holds at rest feels no further torque.
  if (setup_.free_arm() && rate[model::kArmSpeed] == 0) (*informative)[kModeArmTorque] = 0;
}

}  // namespace hydro::diagnose::smoother
