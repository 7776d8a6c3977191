#include "model/balances.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "model/equations/evaluate.h"
#include "model/equations/read_sensors.h"

namespace hydro::model {

namespace {

// The states of effects change their own rates slowly, if at all, so one Jacobian serves for this many
// samples.
constexpr int kSamplesOfAJacobian = 16;
// Steps in each sample: a lag as short as the interval is then accurate to a few per cent.
constexpr int kSubsteps = 2;

// Between two samples, values follow the cubic through both ends with their rates.
KnownMotion Between(const KnownMotion& from, const KnownMotion& to, double part) {
  KnownMotion at = from;  // the command is held
  const double step = to.time - from.time;
  at.time += part * step;
  for (double KnownMotion::*one : {&KnownMotion::motor_acceleration, &KnownMotion::p1_rate,
                                   &KnownMotion::p2_rate, &KnownMotion::arm_acceleration}) {
    at.*one += part * (to.*one - from.*one);
  }
  const std::pair<double KnownMotion::*, double KnownMotion::*> curves[] = {
      {&KnownMotion::motor_angle, &KnownMotion::motor_speed},
      {&KnownMotion::motor_speed, &KnownMotion::motor_acceleration},
      {&KnownMotion::p1, &KnownMotion::p1_rate},
      {&KnownMotion::p2, &KnownMotion::p2_rate},
      {&KnownMotion::arm_angle, &KnownMotion::arm_speed},
      {&KnownMotion::arm_speed, &KnownMotion::arm_acceleration}};
  const double rest = 1 - part;
  for (const auto& [value, rate] : curves) {
    const double begin = from.*value, end = to.*value;
    at.*value = begin + part * part * (3 - 2 * part) * (end - begin) +
                part * rest * step * (rest * from.*rate - part * to.*rate);
  }
  return at;
}

// h (1 - h A/2)^-1, by rows. It moves states by a step h of the trapezoidal rule where A gives the change of
// their rates. It follows a ramp exactly, however short a lag is compared with the step.
std::vector<double> StepMatrix(std::vector<double> A, size_t n, double h) {
  std::vector<double> inverse(n * n, 0.0);
  for (size_t i = 0; i < n; ++i) {
    for (size_t j = 0; j < n; ++j) A[i * n + j] = (i == j ? 1.0 : 0.0) - 0.5 * h * A[i * n + j];
    inverse[i * n + i] = h;
  }
  for (size_t k = 0; k < n; ++k) {
    size_t pivot = k;
    for (size_t i = k + 1; i < n; ++i)
      pivot = std::abs(A[i * n + k]) > std::abs(A[pivot * n + k]) ? i : pivot;
    for (size_t j = 0; j < n; ++j) {
      std::swap(A[k * n + j], A[pivot * n + j]);
      std::swap(inverse[k * n + j], inverse[pivot * n + j]);
    }
    for (size_t i = 0; i < n; ++i) {
      if (i == k) continue;
      const double part = A[i * n + k] / A[k * n + k];
      for (size_t j = 0; j < n; ++j) {
        A[i * n + j] -= part * A[k * n + j];
        inverse[i * n + j] -= part * inverse[k * n + j];
      }
    }
  }
  for (size_t k = 0; k < n; ++k) {
    for (size_t j = 0; j < n; ++j) inverse[k * n + j] /= A[k * n + k];
  }
  return inverse;
}

// All named quantities for the given motion, with switches set as it and their margins require.
template <class T>
void EvaluateMotion(const EquationData& m, const NumbersOf<T>& n, const KnownMotion& at, const double* state,
                    int pump, int arm, T* rate, Terms<T>& x) {
  Mode mode;
  mode.pump = static_cast<int8_t>(pump);
  T y[kMaxStates];
  for (int i = 0; i < m.states; ++i) y[i] = T(state[i]);
  const auto read = [&] {
    x.around = at.around;
    x.motor_angle = T(at.motor_angle);
    x.motor_speed = T(at.motor_speed);
    x.p1 = T(at.p1);
    x.p2 = T(at.p2);
    x.arm_angle = T(at.arm_angle);
    x.arm_speed = T(at.arm_speed);
  };
  const auto evaluate = [&] {
    read();
    SetProperties<Form::kGeneral>(m, n, at.time, T(at.voltage), mode, y, x);
    AddTorquesAndFlows<Form::kGeneral>(m, n, at.time, rate, x);
    FindFreeRates<Form::kGeneral>(m, n, x);
  };
  if (m.switches > kFirstEffectSwitch) {
    // Switches that follow the direction of motion come first, then those that depend on thresholds.
    read();
    x.mode = &mode;
    x.parameters = &n.parameters;
    x.arm_free = m.shaft == Shaft::kFree;
    x.arm_speed = T(arm * std::max(std::abs(at.arm_speed), 1e-30));
    ForEachEffect(m, n, x, [&](const Effect& effect) { effect.StartMode(x, &mode); });
    const Mode directions = mode;
    evaluate();
    T margin[kMaxSwitches];
    ForEachEffect(m, n, x, [&](const Effect& effect) { effect.Margins(x, margin); });
    for (const auto& effect : m.effects) {
      for (int s = 0; s < effect->switches(); ++s) {
        const int place = effect->first_switch() + s;
        if (directions.effects[static_cast<size_t>(place)] != 0) continue;
        if (!(margin[kFirstEffectSwitch + place] < T(0.0))) continue;
        T copy[kMaxStates];
        std::copy(y, y + m.states, copy);
        x.own = n.own.data() + effect->first_parameter();
        effect->Cross(s, x, copy, &mode);
      }
    }
  }
  evaluate();
}

template <class T>
BalancesOf<T> BalancesIn(const EquationData& m, const NumbersOf<T>& n, const KnownMotion& at,
                         const double* state, int pump, int arm) {
  T rate[kMaxStates];
  Terms<T> x;
  EvaluateMotion<T>(m, n, at, state, pump, arm, rate, x);
  BalancesOf<T> left;
  left.drive = x.torque;
  left.torque = x.net_torque - static_cast<double>(pump) * x.coulomb - x.b * x.motor_speed -
                n.parameters.J * at.motor_acceleration;
  left.flow_1 = x.V_1 / x.beta_1 * (x.free_rate_1 - at.p1_rate);
  left.flow_2 = x.V_2 / x.beta_2 * (x.free_rate_2 - at.p2_rate);
  left.arm = x.arm_torque - n.parameters.J_a * at.arm_acceleration;
  left.level_1 = x.p1 - x.p_3;
  left.level_2 = x.p2 - x.p_3;
  return left;
}

// The balances of both directions, weighted by how likely each is.
template <class T>
BalancesOf<T> Blended(const EquationData& m, const NumbersOf<T>& n, const KnownMotion& at,
                      const double* state) {
  constexpr double kSure = 0.999;
  const auto sides = [](double direction) {
    return direction > kSure    ? std::pair{0.0, 1.0}
           : direction < -kSure ? std::pair{1.0, 0.0}
                                : std::pair{0.5 - 0.5 * direction, 0.5 + 0.5 * direction};
  };
  const auto [pump_back, pump_forward] = sides(at.pump_direction);
  const auto [arm_back, arm_forward] = sides(m.shaft == Shaft::kFree ? at.arm_direction : 1.0);
  BalancesOf<T> sum;
  for (const auto& [pump, pump_weight] : {std::pair{-1, pump_back}, std::pair{1, pump_forward}}) {
    for (const auto& [arm, arm_weight] : {std::pair{-1, arm_back}, std::pair{1, arm_forward}}) {
      const double weight = pump_weight * arm_weight;
      if (weight == 0) continue;
      const BalancesOf<T> one = BalancesIn<T>(m, n, at, state, pump, arm);
      sum.torque += weight * one.torque;
      sum.flow_1 += weight * one.flow_1;
      sum.flow_2 += weight * one.flow_2;
      sum.arm += weight * one.arm;
      sum.level_1 += weight * one.level_1;
      sum.level_2 += weight * one.level_2;
      sum.drive += weight * one.drive;
    }
  }
  return sum;
}

// What a side reads above the level at which an effect's one-way valve holds it. An open valve of this kind
// passes a flow that is linear in the pressure, so two pressures far below p_3 show the pressure at which it
// passes what the other flows need.
double AboveHeldLevel(const EquationData& m, const KnownMotion& at, const double* state,
                      double KnownMotion::*pressure, double BalancesOf<double>::*flow) {
  const Parameters& p = m.parameters;
  const double step = std::abs(p.p_3) + 0.1 * p.T_pmax / p.D;
  const auto flow_at = [&](double value) {
    KnownMotion low = at;
    low.*pressure = value;
    const BalancesOf<double> one = Blended<double>(m, m, low, state);
    return one.*flow;
  };
  const double first = p.p_3 - step, second = p.p_3 - 2 * step;
  const double flow_1 = flow_at(first), flow_2 = flow_at(second);
  const double slope = (flow_2 - flow_1) / (second - first);
  if (!(slope < 0)) return at.*pressure - p.p_3;
  return at.*pressure - (first - flow_1 / slope);
}

bool RemembersCommands(const Effect& effect) {
  // An effect that remembers commands waits for the time at which it passes one on.
  return effect.NextStop(-kUnbounded) < kUnbounded;
}

}  // namespace

BalanceEquations::BalanceEquations(const ModelDescription& model, ActuatorOptions options,
                                   const std::vector<Unknown>& unknowns)
    : equations_(model, (options.repeated_effects = true, options)) {
  const EquationData& data = equations_.data();
  numbers_ = *data.constants;
  for (size_t u = 0; u < unknowns.size(); ++u) {
    Jet& seeded = unknowns[u].kind == Unknown::Kind::kBase ? BaseValue(numbers_.parameters, unknowns[u].index)
                                                           : numbers_.own.at(unknowns[u].index);
    seeded.SetDerivative(static_cast<int>(u), 1);
  }
  // The equations skip the weight of an arm without weight, and with it the derivative.
  if (numbers_.parameters.mgl.a == 0) numbers_.parameters.mgl.a = std::numeric_limits<double>::min();
  CompleteNumbers<Jet>(data, &numbers_);
  first_state_ = data.shaft == Shaft::kFree ? 6 : 4;
  own_.assign(static_cast<size_t>(data.states - first_state_), 0.0);
  Equations probe(model, options);
  probe.Command(0, 1);
  commands_ = std::any_of(probe.data().effects.begin(), probe.data().effects.end(),
                          [](const auto& effect) { return RemembersCommands(*effect); });
}

bool BalanceEquations::remembers() const { return has_states() || commands_ || equations_.data().reads_late; }

void BalanceEquations::CopyStates(const KnownMotion& at, double* state) const {
  state[kMotorAngle] = at.motor_angle;
  state[kMotorSpeed] = at.motor_speed;
  state[kP1] = at.p1;
  state[kP2] = at.p2;
  if (equations_.data().shaft == Shaft::kFree) {
    state[kArmAngle] = at.arm_angle;
    state[kArmSpeed] = at.arm_speed;
  }
  std::copy(own_.begin(), own_.end(), state + first_state_);
}

void BalanceEquations::Start(const KnownMotion& motion, bool filled) {
  const EquationData& data = equations_.data();
  double state[kMaxStates], rate[kMaxStates];
  std::fill(own_.begin(), own_.end(), 0.0);
  CopyStates(motion, state);
  Terms<double> x;
  EvaluateMotion<double>(data, data, motion, state, motion.pump_direction < 0 ? -1 : 1, 1, rate, x);
  const double returned = filled ? -PressedIn(x, data.parameters.p_3) : 0;
  x.returned = &returned;
  ForEachEffect(data, data, x, [&](const Effect& effect) { effect.Start(x, state); });
  std::copy(state + first_state_, state + data.states, own_.begin());
  since_jacobian_ = kSamplesOfAJacobian;
}

void BalanceEquations::OwnRates(const KnownMotion& motion, double* state, double* rate) const {
  const EquationData& data = equations_.data();
  Terms<double> x;
  const int pump = motion.pump_direction < 0 ? -1 : 1, arm = motion.arm_direction < 0 ? -1 : 1;
  double rates[kMaxStates] = {};
  EvaluateMotion<double>(data, data, motion, state, pump, arm, rates, x);
  Mode mode;
  mode.pump = static_cast<int8_t>(pump);
  x.mode = &mode;
  // What a side's pressure does not keep has gone to the accumulator: through its one-way valve, or through
  // what the model lacks. In the sum of both sides the errors of the pump's flow cancel.
  x.valve_flow_1 += x.V_1 / x.beta_1 * (x.free_rate_1 - motion.p1_rate);
  x.valve_flow_2 += x.V_2 / x.beta_2 * (x.free_rate_2 - motion.p2_rate);
  x.p_3_rate = 0;
  ForEachEffect(data, data, x, [&](const Effect& effect) { effect.AddBalances(x, rates); });
  std::copy(rates + first_state_, rates + data.states, rate);
}

void BalanceEquations::FindJacobian(const KnownMotion& motion) {
  const size_t n = own_.size();
  jacobian_.assign(n * n, 0.0);
  double state[kMaxStates], rate[kMaxStates], moved[kMaxStates];
  CopyStates(motion, state);
  OwnRates(motion, state, rate);
  for (size_t j = 0; j < n; ++j) {
    const auto place = static_cast<size_t>(first_state_) + j;
    const double before = state[place];
    const double step = 1e-4 * std::max(std::abs(before), equations_.scales()[place]);
    state[place] = before + step;
    OwnRates(motion, state, moved);
    for (size_t i = 0; i < n; ++i) jacobian_[i * n + j] = (moved[i] - rate[i]) / step;
    state[place] = before;
  }
}

void BalanceEquations::Advance(const KnownMotion& from, const KnownMotion& to) {
  if (commands_) equations_.Command(from.time, from.voltage);
  AdvanceStates(from, to);
  if (commands_) PassStops(from, to);
}

void BalanceEquations::PassStops(const KnownMotion& from, const KnownMotion& to) {
  // Rounding must not make a delay of whole samples one sample longer.
  const double step = to.time - from.time, end = to.time + 1e-6 * step;
  early_ = 0;
  drive_before_.reset();
  // Only the effects' stops count: the breaks of an imposed motion are part of the known motion.
  const auto next = [&] {
    double stop = kUnbounded;
    for (const auto& effect : equations_.data().effects) stop = std::min(stop, effect->NextStop(from.time));
    return stop;
  };
  double stop = next();
  if (stop <= end) drive_before_ = Drive(to, from.voltage);
  for (; stop <= end; stop = next()) {
    early_ = std::max(0.0, (to.time - stop) / step);
    for (const auto& effect : equations_.data().effects) effect->PassStop(stop);
  }
}

double BalanceEquations::Drive(KnownMotion motion, double voltage) const {
  motion.voltage = voltage;
  double state[kMaxStates];
  CopyStates(motion, state);
  return Blended<double>(equations_.data(), equations_.data(), motion, state).drive;
}

double BalanceEquations::DriveBefore(const KnownMotion& motion, double voltage) const {
  return drive_before_ ? *drive_before_ : Drive(motion, voltage);
}

void BalanceEquations::AdvanceStates(const KnownMotion& from, const KnownMotion& to) {
  if (own_.empty()) return;
  if (++since_jacobian_ > kSamplesOfAJacobian) {
    FindJacobian(from);
    step_matrix_ = StepMatrix(jacobian_, own_.size(), (to.time - from.time) / kSubsteps);
    since_jacobian_ = 1;
  }
  for (int k = 0; k < kSubsteps; ++k) {
    const KnownMotion middle = Between(from, to, (k + 0.5) / kSubsteps);
    double state[kMaxStates], rate[kMaxStates];
    CopyStates(middle, state);
    OwnRates(middle, state, rate);
    const size_t n = own_.size();
    for (size_t i = 0; i < n; ++i) {
      for (size_t j = 0; j < n; ++j) own_[i] += step_matrix_[i * n + j] * rate[j];
    }
  }
}

BalancesOf<double> BalanceEquations::Values(const KnownMotion& motion) const {
  const EquationData& data = equations_.data();
  double state[kMaxStates];
  CopyStates(motion, state);
  BalancesOf<double> left = Blended<double>(data, data, motion, state);
  if (!data.ideal_valves) {
    left.level_1 = AboveHeldLevel(data, motion, state, &KnownMotion::p1, &BalancesOf<double>::flow_1);
    left.level_2 = AboveHeldLevel(data, motion, state, &KnownMotion::p2, &BalancesOf<double>::flow_2);
  }
  return left;
}

BalancesOf<Jet> BalanceEquations::At(const KnownMotion& motion) const {
  double state[kMaxStates];
  CopyStates(motion, state);
  return Blended<Jet>(equations_.data(), numbers_, motion, state);
}

ReadingErrors BalanceEquations::Errors(const KnownMotion& at) const {
  const EquationData& data = equations_.data();
  double state[kMaxStates];
  CopyStates(at, state);
  const auto reading = [&](double before) {
    Measurement one;
    one.motor_angle = at.motor_angle - before * (at.motor_speed - 0.5 * before * at.motor_acceleration);
    one.motor_speed = at.motor_speed - before * at.motor_acceleration;
    one.arm_angle = at.arm_angle - before * (at.arm_speed - 0.5 * before * at.arm_acceleration);
    one.arm_speed = at.arm_speed - before * at.arm_acceleration;
    one.p1 = at.p1 - before * at.p1_rate;
    one.p2 = at.p2 - before * at.p2_rate;
    return one;
  };
  const Measurement prompt = reading(0);
  Measurement read = prompt;
  SenseTerms<double> sensed;
  sensed.time = at.time - data.begin;
  sensed.state = state;
  const auto each = [&](auto change) {
    for (const auto& effect : data.effects) {
      sensed.own = data.own.data() + effect->first_parameter();
      change(*effect);
    }
  };
  each([&](const Effect& effect) { effect.Transduce(sensed, &read); });
  each([&](const Effect& effect) { effect.Sense(sensed, &read); });
  each([&](const Effect& effect) {
    if (effect.reads_late()) effect.Replace(reading(effect.Lateness(sensed.own)), &read);
  });
  return {read.motor_angle - prompt.motor_angle,
          read.motor_speed - prompt.motor_speed,
          read.arm_angle - prompt.arm_angle,
          read.arm_speed - prompt.arm_speed,
          read.p1 - prompt.p1,
          read.p2 - prompt.p2};
}

}  // namespace hydro::model
