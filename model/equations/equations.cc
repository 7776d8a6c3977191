#include "model/equations/equations.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>

#include "model/effects/catalogue.h"
#include "model/equations/evaluate.h"
#include "model/equations/read_sensors.h"

namespace hydro::model {

namespace {

std::string Number(double value) {
  std::ostringstream out;
  out.precision(6);
  out << value;
  return out.str();
}

void CheckBounds(const ParameterInfo& info, const UnitSystem& units, double value, const std::string& owner) {
  const bool inside =
      std::isfinite(value) && value <= info.max && (info.min_allowed ? value >= info.min : value > info.min);
  if (inside) return;
  throw ModelError("parameter " + owner + info.name + " = " + Number(value) + " " + info.UnitIn(units) +
                   "; allowed is " + (info.min_allowed ? "from " : "above ") + Number(info.min) +
                   (std::isfinite(info.max) ? " to " + Number(info.max) : ""));
}

// Not inlined: one copy serves every caller that needs derivatives.
[[gnu::noinline]] void RatesWithDerivatives(const EquationData& m, double time, const Jet& voltage,
                                            const Mode& mode, const Jet* state, bool voltage_acts,
                                            Jet* rate) {
  Terms<Jet> x;
  x.voltage_acts = voltage_acts;
  EvaluateTerms<Form::kGeneral, Jet>(m, *m.constants, time, voltage, mode, state, rate, x);
}

// The same numbers as scalars of type Jet, with derivatives of 0.
std::shared_ptr<const NumbersOf<Jet>> WithoutDerivatives(const EquationData& data) {
  Parameters parameters = data.parameters;
  auto constants = std::make_shared<NumbersOf<Jet>>();
  for (size_t i = 0; i < BaseParameters().size(); ++i) {
    BaseValue(constants->parameters, i) = Jet(BaseValue(parameters, i));
  }
  for (const double value : data.own) constants->own.emplace_back(value);
  CompleteNumbers<Jet>(data, constants.get());
  return constants;
}

void CheckNames(const EffectDescription& effect, const ParameterInfo& info, const std::string& owner) {
  const auto found = effect.name_lists.find(info.name);
  if (found == effect.name_lists.end()) throw ModelError("parameter " + owner + info.name + " is missing");
  for (const std::string& name : found->second) {
    if (std::find(info.names.begin(), info.names.end(), name) == info.names.end()) {
      throw ModelError("parameter " + owner + info.name + ": \"" + name + "\" is not known");
    }
  }
}

void CheckNumbers(const EffectDescription& effect, const ParameterInfo& info, const UnitSystem& units,
                  const std::string& owner) {
  const auto found = effect.lists.find(info.name);
  if (found == effect.lists.end()) {
    if (info.optional) return;
    throw ModelError("parameter " + owner + info.name + " is missing");
  }
  const std::vector<double>& list = found->second;
  for (const double value : list) CheckBounds(info, units, value, owner);
  if (info.list != List::kPlaces) return;
  const bool increases = std::adjacent_find(list.begin(), list.end(), std::greater_equal<>()) == list.end();
  if (list.size() < 2 || !increases) {
    throw ModelError("parameter " + owner + info.name +
                     " must have two or more numbers, each above the one before");
  }
}

void CheckOnlyOne(bool has_one, const std::string& id, const std::string& kinds) {
  if (!has_one) return;
  throw ModelError("effect \"" + id + "\" is the second of its kind; allowed is one of those like " + kinds);
}

// Throws ModelError for a parameter that is missing, has an unknown name, or lies outside its bounds.
void CheckParameters(const EffectDescription& effect, const EffectInfo& known, const UnitSystem& units) {
  for (const ParameterInfo& info : known.parameters) {
    const std::string owner = effect.id + ".";
    if (info.list == List::kNames) {
      CheckNames(effect, info, owner);
    } else if (info.list != List::kNone) {
      CheckNumbers(effect, info, units, owner);
    } else if (info.is_name()) {
      const auto found = effect.names.find(info.name);
      if (found == effect.names.end()) throw ModelError("parameter " + owner + info.name + " is missing");
      if (std::find(info.names.begin(), info.names.end(), found->second) == info.names.end()) {
        throw ModelError("parameter " + owner + info.name + " = \"" + found->second + "\" is not known");
      }
    } else {
      const auto found = effect.parameters.find(info.name);
      if (found == effect.parameters.end() && info.optional) continue;
      if (found == effect.parameters.end())
        throw ModelError("parameter " + owner + info.name + " is missing");
      CheckBounds(info, units, found->second, owner);
    }
  }
  const std::optional<ListFault> fault = known.fault == nullptr ? std::nullopt : known.fault(effect);
  if (fault.has_value()) {
    throw ModelError("parameter " + effect.id + "." + fault->parameter + ": found " + fault->found +
                     ", allowed " + fault->allowed);
  }
}

}  // namespace

Equations::Equations(const ModelDescription& description, const ActuatorOptions& options)
    : units_(description.units) {
  data_.parameters = description.parameters;
  data_.linear_arm = units_.linear_arm;
  data_.atmosphere = AtmosphereOf(description);
  data_.shaft = options.shaft;
  data_.bypass = options.bypass;
  data_.arm_angle = options.arm_angle;
  data_.begin = options.begin;
  data_.motion = options.shaft == Shaft::kDriven ? options.motion : nullptr;
  const Parameters& p = data_.parameters;
  for (const BaseParameter& parameter : BaseParameters())
    CheckBounds(parameter.info, description.units, p.*parameter.member, "");
  if (!std::isfinite(options.begin)) throw ModelError("the begin of the run is not finite");
  if (!std::isfinite(options.arm_angle)) throw ModelError("arm angle is not finite");

  const double pressure = 0.01 * p.T_pmax / p.D;
  const double speed = pressure * std::sqrt(2 * p.V_ms / (p.beta * p.J));
  const StateSizes sizes = {.pressure = pressure,
                            .flow = p.D * speed,
                            .torque = 0.01 * p.T_pmax,
                            // An angle has a size of its own; a stroke has the size of its cylinder.
                            .arm = data_.linear_arm ? 1e-3 * p.V_ms / p.c : 1e-3,
                            .angle = 0.01 * p.V_ms / p.D,
                            .speed = speed,
                            .voltage = 0.01 * p.T_pmax / p.k_1};
  scales_ = {0.01 * p.V_ms / p.D, speed, pressure, pressure};
  if (data_.shaft == Shaft::kFree) {
    scales_.push_back(0.01 * p.V_ms / p.c);
    scales_.push_back(speed * p.D / p.c);
  }

  std::vector<EffectDescription> effects = description.effects;
  std::stable_sort(effects.begin(), effects.end(), ComesBefore);
  for (size_t i = 0; i < effects.size(); ++i) {
    if (!options.repeated_effects && i > 0 && effects[i - 1].id == effects[i].id)
      throw ModelError("effect \"" + effects[i].id + "\" is there twice");
    AddEffect(effects[i], sizes);
  }
  data_.states = static_cast<int>(scales_.size());
  CompleteNumbers<double>(data_, &data_);
  data_.constants = WithoutDerivatives(data_);
  FindMidVolumes();

  if (data_.shaft == Shaft::kDriven) {
    if (data_.motion == nullptr) throw ModelError("a driven shaft needs a motion");
    if (!data_.motion->continuous())
      throw ModelError("a driven shaft cannot jump: its motion must be continuous");
    CheckVolumes(data_.motion->Min());
    CheckVolumes(data_.motion->Max());
  } else {
    CheckVolumes(data_.arm_angle);
  }
}

void Equations::AddEffect(const EffectDescription& effect, const StateSizes& sizes) {
  const EffectInfo* known = FindEffect(effect);
  if (known == nullptr) throw ModelError("effect \"" + effect.id + "\" is not known");
  CheckParameters(effect, *known, units_);
  data_.effects.push_back(BuildEffect(effect));
  const int first_parameter = static_cast<int>(data_.own.size());
  for (const ParameterInfo& info : known->parameters) {
    if (info.is_number()) {
      const double number = NumberOf(effect, info, data_.parameters);
      if (!effect.parameters.contains(info.name)) {
        CheckBounds(info, units_, number, effect.id + ".");  // base parameters may be extreme
        data_.standards.emplace_back(data_.own.size(), info.standard);
      }
      data_.own.push_back(number);
    }
    if (info.list != List::kValues) continue;
    const std::vector<double>& values = effect.lists.at(info.name);
    data_.own.insert(data_.own.end(), values.begin(), values.end());
  }
  Effect& made = *data_.effects.back();
  const int first = static_cast<int>(scales_.size());
  made.Place(first, data_.switches - kFirstEffectSwitch, first_parameter);
  scales_.resize(first + made.states());
  data_.switches += made.switches();
  data_.reads_late |= made.reads_late();
  data_.reach = std::max(data_.reach, made.reach());
  const auto limits = [](const auto& one) { return one->limits_torque(); };
  if (made.limits_torque()) {
    CheckOnlyOne(std::count_if(data_.effects.begin(), data_.effects.end(), limits) > 1, effect.id,
                 "motor.speed_torque_limit and motor.current_limit");
  }
  if (made.replaces_valves()) {
    CheckOnlyOne(!data_.ideal_valves, effect.id, "valve.check and valve.pilot_check");
    data_.ideal_valves = false;
  }
  if (made.p_3_state() >= 0) {
    CheckOnlyOne(data_.p_3_state >= 0, effect.id, "accumulator.stiffness and accumulator.gas");
    data_.p_3_state = made.p_3_state();
  }
  if (made.actuator_angle_state() >= 0) data_.actuator_angle_state = made.actuator_angle_state();
  if (scales_.size() > kMaxStates || data_.switches > kMaxSwitches) throw ModelError("too many effects");
  made.Scales(sizes, scales_.data() + first);
}

std::vector<std::string> Equations::StateNames() const {
  std::vector<std::string> names = {"motor_angle", "motor_speed", "p1", "p2"};
  if (data_.shaft == Shaft::kFree) names.insert(names.end(), {"arm_angle", "arm_speed"});
  for (const auto& effect : data_.effects) {
    for (const std::string& name : effect->StateNames()) names.push_back(name);
  }
  return names;
}

void Equations::Start(double pressure, double* state, Mode* mode) const {
  if (std::isnan(pressure)) pressure = data_.parameters.p_3;
  const double least = data_.ideal_valves ? data_.parameters.p_3 : 0;
  if (!(pressure >= least) || !std::isfinite(pressure)) {
    const std::string unit = " " + units_.UnitFor("psi");
    throw ModelError("initial pressure " + Number(pressure) + unit + " is below " +
                     (data_.ideal_valves ? "the accumulator's p_3 = " : "") + Number(least) + unit);
  }
  *mode = Mode{};
  std::fill(state, state + data_.states, 0.0);
  state[kP1] = state[kP2] = pressure;
  if (data_.shaft == Shaft::kFree) state[kArmAngle] = data_.arm_angle;
  double rate[kMaxStates];
  Terms<double> x;
  Evaluate(0, 0, *mode, state, rate, &x);
  for (const auto& effect : data_.effects) {
    x.own = data_.own.data() + effect->first_parameter();
    effect->Start(x, state);
  }
}

void Equations::SwitchEffects(const double* state, Mode* mode) const {
  double rate[kMaxStates];
  Terms<double> x;
  Evaluate(0, 0, *mode, state, rate, &x);
  for (const auto& effect : data_.effects) {
    x.own = data_.own.data() + effect->first_parameter();
    effect->StartMode(x, mode);
  }
}

void Equations::Rates(double time, double voltage, const Mode& mode, const double* state, double* rate,
                      double* margin) const {
  EvaluatePoint<Form::kGeneral>(data_, time, voltage, mode, state, rate, margin);
}

void Equations::Evaluate(double time, double voltage, const Mode& mode, const double* state, double* rate,
                         Terms<double>* terms) const {
  EvaluateTerms<Form::kGeneral, double>(data_, data_, time, voltage, mode, state, rate, *terms);
}

void Equations::Jacobian(double time, double voltage, const Mode& mode, const double* state,
                         double* jacobian) const {
  const int n = data_.states;
  Jet y[kMaxStates];
  Jet rate[kMaxStates];
  for (int i = 0; i < n; ++i) y[i] = Jet(state[i]);
  for (int first = 0; first < n; first += kJetWidth) {
    const int last = std::min(n, first + kJetWidth);
    for (int j = first; j < last; ++j) y[j].SetDerivative(j - first, 1);
    RatesWithDerivatives(data_, time, Jet(voltage), mode, y, false, rate);
    for (int j = first; j < last; ++j) {
      for (int i = 0; i < n; ++i) jacobian[i + j * n] = rate[i].v[j - first];
      y[j].SetDerivative(j - first, 0);
    }
  }
}

void Equations::Differentiate(double time, const Jet& voltage, const Mode& mode, const Jet* state, Jet* rate,
                              MeasurementOf<Jet>* measured) const {
  RatesWithDerivatives(data_, time, voltage, mode, state, true, rate);
  *measured = ReadSensors<Jet>(data_, *data_.constants, time, state);
}

void Equations::Cross(int which, double time, double voltage, double* state, Mode* mode) const {
  CrossSwitch<double>(data_, data_, which, time, voltage, state, mode);
}

Power Equations::PowerBalance(double time, double voltage, const Mode& mode, const double* state) const {
  double rate[kMaxStates];
  Terms<double> x;
  Evaluate(time, voltage, mode, state, rate, &x);
  const Parameters& p = data_.parameters;
  const double dp = x.p2 - x.p1;
  Power power;
  power.in = x.torque * x.motor_speed;
  power.kinetic = p.J * x.motor_speed * rate[kMotorSpeed];
  power.viscous = (x.b * x.motor_speed + x.load) * x.motor_speed;
  power.coulomb = x.coulomb * std::abs(x.motor_speed);
  power.leakage = x.cross_flow * (x.pump_p2 - x.pump_p1) + x.outer_flow_1 * (x.pump_p1 - x.p_3) +
                  x.outer_flow_2 * (x.pump_p2 - x.p_3);
  power.compression =
      (x.p1 - x.p_3) * x.V_1 / x.beta_1 * rate[kP1] + (x.p2 - x.p_3) * x.V_2 / x.beta_2 * rate[kP2];
  power.mismatch = (p.c - p.k_2) * dp * x.actuator_speed;
  if (data_.loaded) {
    power.shaft_in = -(x.arm_torque - LoadTorque(data_, time)) * x.arm_speed;
  } else if (data_.shaft == Shaft::kFree) {
    power.kinetic += p.J_a * x.arm_speed * rate[kArmSpeed];
    power.gravity = p.mgl * (data_.linear_arm ? 1 : std::cos(x.arm_angle)) * x.arm_speed;
  } else {
    power.shaft_in = -x.pressure_torque * x.arm_speed;
  }
  for (const auto& effect : data_.effects) {
    x.own = data_.own.data() + effect->first_parameter();
    effect->AddPower(x, rate, &power);
  }
  return power;
}

Equations::ArmTorque Equations::FindArmTorque(double time, double voltage, const Mode& mode,
                                              const double* state) {
  if (plain()) return {.torque = data_.parameters.k_2 * (state[kP2] - state[kP1])};
  double rate[kMaxStates];
  Terms<double> x;
  Evaluate(time, voltage, mode, state, rate, &x);
  ArmTorque found{.torque = x.arm_torque - LoadTorque(data_, time)};
  if (x.arm_torque != 0) return found;
  // Decides between held and just in balance: what holds the arm does not yield to another load either.
  const double torque = data_.load.torque;
  data_.load.torque += std::max(data_.parameters.k_2 * scales_[kP1], std::abs(torque));
  Evaluate(time, voltage, mode, state, rate, &x);
  data_.load.torque = torque;
  found.held = x.arm_torque == 0;
  return found;
}

double Equations::ArmTorqueRate(double time, double voltage, const Mode& mode, const double* state,
                                const double* rate) const {
  if (plain()) return data_.parameters.k_2 * (rate[kP2] - rate[kP1]);
  Jet moving[kMaxStates], rates[kMaxStates];
  for (int i = 0; i < data_.states; ++i) {
    moving[i] = Jet(state[i]);
    moving[i].SetDerivative(0, rate[i]);
  }
  Terms<Jet> x;
  EvaluateTerms<Form::kGeneral, Jet>(data_, *data_.constants, time, Jet(voltage), mode, moving, rates, x);
  return x.arm_torque.v[0];
}

void Equations::SetLoad(double time, const ArmLoad& load) {
  if (data_.shaft != Shaft::kFree) throw ModelError("an arm with a load needs a free shaft");
  if (!(load.inertia > 0) || !std::isfinite(load.inertia)) {
    throw ModelError("inertia of the arm's load = " + Number(load.inertia) + "; allowed is above 0");
  }
  if (!std::isfinite(load.torque + load.torque_rate + load.torque_curve)) {
    throw ModelError("the torque of the arm's load is not finite");
  }
  data_.loaded = true;
  data_.load = load;
  data_.load_since = time;
  data_.inverse_load_inertia = 1 / load.inertia;
}

void Equations::MoveArm(double time, double voltage, const Mode& mode, double angle, double speed,
                        double* state) const {
  const Parameters& p = data_.parameters;
  const double moved = angle - state[kArmAngle];
  if (plain()) {
    if (!mode.valve_1) state[kP1] += p.beta / (p.V_ms - p.c * angle) * (p.c * moved);
    if (!mode.valve_2) state[kP2] -= p.beta / (p.V_ms + p.c * angle) * (p.c * moved);
  } else if (!data_.bypass && data_.actuator_angle_state == kArmAngle) {
    double rate[kMaxStates];
    Terms<double> x;
    Evaluate(time, voltage, mode, state, rate, &x);
    if (!mode.valve_1) state[kP1] += x.beta_1 / x.V_1 * (x.c_1 * moved);
    if (!mode.valve_2) state[kP2] -= x.beta_2 / x.V_2 * (x.c_2 * moved);
  }
  state[kArmAngle] = angle;
  state[kArmSpeed] = speed;
}

Measurement Equations::Measure(double time, const double* state, const StateHistory<double>* history) const {
  return ReadSensors<double>(data_, data_, time, state, history);
}

// The effects may change the volumes and the actuator's displacement, so they are evaluated at rest, with the
// arm at 0.
void Equations::FindMidVolumes() {
  double state[kMaxStates] = {};
  const Mode mode;
  Terms<double> x{};
  x.p1 = x.p2 = data_.parameters.p_3;
  hydro::model::SetProperties<Form::kGeneral>(data_, data_, data_.begin, 0.0, mode, state, x);
  data_.mid_volume_1 = x.V_1;
  data_.mid_volume_2 = x.V_2;
  data_.c_1 = x.c_1;
  data_.c_2 = x.c_2;
  if (!(x.c_1 > 0) || !(x.c_2 > 0)) {
    throw ModelError("an effect leaves the sides c = " + Number(x.c_1) + " and " + Number(x.c_2) + " " +
                     units_.UnitFor("in^3/rad", -1) + "; both must be above 0");
  }
}

void Equations::CheckVolumes(double arm_angle) const {
  if (HasVolumes(arm_angle)) return;
  const double V_1 = data_.mid_volume_1 - data_.c_1 * arm_angle;
  const double V_2 = data_.mid_volume_2 + data_.c_2 * arm_angle;
  const double least = -data_.mid_volume_2 / data_.c_2, most = data_.mid_volume_1 / data_.c_1;
  const bool first = !(V_1 > 0);
  const std::string unit = " " + units_.UnitFor("rad", 1);
  const std::string needs = least == -most ? "|alpha| < " + Number(most)
                                           : "alpha between " + Number(least) + " and " + Number(most);
  throw ModelError((data_.linear_arm ? "arm position " : "arm angle ") + Number(arm_angle) + unit +
                   " leaves " + (first ? "V_1 = " : "V_2 = ") + Number(first ? V_1 : V_2) + " " +
                   units_.UnitFor("in^3") + (data_.fixed_volume > 0 ? " at the actuator" : "") +
                   "; V_1, V_2 > 0 needs " + needs + unit);
}

void Equations::Command(double time, double voltage) {
  for (const auto& effect : data_.effects) effect->Command(time, voltage);
}

double Equations::NextStop(double time) const {
  double stop = std::numeric_limits<double>::infinity();
  if (data_.motion != nullptr) stop = data_.motion->NextBreak(time);
  for (const auto& effect : data_.effects) stop = std::min(stop, effect->NextStop(time));
  return stop;
}

void Equations::PassStop(double time) {
  for (const auto& effect : data_.effects) effect->PassStop(time);
  // Up to its next break the motion keeps its formula, even for a stage that lies on the break.
  if (data_.motion != nullptr) data_.motion_limit = std::nextafter(data_.motion->NextBreak(time), time);
}

}  // namespace hydro::model
