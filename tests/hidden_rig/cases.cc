#include "cases.h"

#include <cmath>
#include <functional>
#include <stdexcept>

#include "plans.h"

namespace hidden_rig {

std::vector<Case> AllCases() {
  std::vector<Case> cases;
  const auto add = [&](Case c) {
    c.seed = 1000 + 37 * cases.size();
    cases.push_back(std::move(c));
  };
  struct Size {
    const char* name;
    double gap;
  };
  for (const auto& form : EffectForms()) {
    for (const Size& size : {Size{"small", 2}, Size{"medium", 5}, Size{"plain", 15}}) {
      Case c;
      c.name = form.id + "-" + size.name;
      c.kind = "single";
      c.effects = {form.id};
      c.size = size.name;
      c.gap = size.gap;
      add(c);
    }
  }
  const std::vector<std::vector<std::string>> sets = {
      {"pump.stribeck", "valve.relief"},
      {"pump.friction_asymmetry", "fluid.warming"},
      {"fluid.entrained_air", "pump.turbulent_leakage"},
      {"amp.lag", "sensor.pressure_offset"},
      {"motor.speed_torque_limit", "pump.pressure_friction"},
      {"line.wave", "pump.quadratic_drag"},
      {"actuator.seal_friction", "amp.delay"},
      {"motor.cogging", "accumulator.stiffness"},
      {"valve.check", "pump.friction_asymmetry"},
      {"sensor.skew", "pump.stribeck"},
      {"arm.flexure", "fluid.stiffening"},
      {"sensor.pressure_gain", "pump.turbulent_leakage"},
      {"pump.stribeck", "valve.relief", "amp.lag"},
      {"pump.friction_asymmetry", "fluid.entrained_air", "sensor.pressure_offset"},
      {"motor.cogging", "pump.turbulent_leakage", "actuator.seal_friction"},
      {"pump.pressure_friction", "valve.check", "amp.delay"},
      {"fluid.warming", "motor.speed_torque_limit", "valve.relief"},
      {"sensor.pressure_lag", "pump.quadratic_drag", "accumulator.stiffness"},
      {"pump.flow_ripple", "pump.stribeck", "fluid.stiffening"},
      {"line.wave", "pump.friction_asymmetry", "sensor.pressure_gain"},
      {"arm.flexure", "pump.pressure_friction", "sensor.skew"},
      {"actuator.seal_friction", "valve.relief", "sensor.pressure_offset"},
  };
  for (const auto& set : sets) {
    Case c;
    c.kind = set.size() == 2 ? "pair" : "triple";
    c.effects = set;
    c.size = "plain";
    for (const auto& id : set) c.name += (c.name.empty() ? c.kind + "-" : "+") + id;
    add(c);
  }
  for (int i = 0; i < 20; ++i) {
    Case c;
    c.kind = "nothing";
    c.noise = i < 8 ? 1 : i < 14 ? 0.5 : 3;
    c.name = "nothing-" + std::to_string(i + 1);
    add(c);
  }
  int nth = 0;
  for (const auto& form : BaseForms()) {
    Case c;
    c.kind = "parameter";
    c.parameter = form.name;
    c.name = "parameter-" + form.name;
    constexpr double kFactors[] = {1.1, 0.85, 1.2, 0.75, 1.3};
    c.factor = form.name == "c_I" ? 0.75 : kFactors[nth % 5];
    ++nth;
    add(c);
  }
  for (size_t i = 0; i < OutsideForms().size(); ++i) {
    Case c;
    c.kind = "outside";
    c.name = "outside-" + std::to_string(i + 1);
    c.outside = static_cast<int>(i);
    c.size = "plain";
    c.gap = 15;
    add(c);
  }
  return cases;
}

namespace {

// All signals of a run in noise units, one after the other.
void Append(const Plan& plan, const Record& record, std::vector<double>* all) {
  const auto add = [&](const std::vector<double>& signal, double noise) {
    for (const double value : signal) all->push_back(value / noise);
  };
  add(record.motor_speed, kSpeedNoise);
  add(record.p1, kPressureNoise);
  add(record.p2, kPressureNoise);
  if (plan.shaft == Shaft::kFree) add(record.arm_angle, kAngleNoise);
}

// The noiseless signals of all runs of `setup`, under the voltages of the true rig.
struct Signals {
  std::vector<Plan> plans;
  std::vector<Conditions> conditions;
  std::vector<std::vector<double>> voltages;

  Signals(const Truth& truth, uint64_t seed, const Options& options, std::vector<double>* of_truth)
      : plans(Plans(seed, options.seconds, options.driven)) {
    for (const Plan& plan : plans) {
      Conditions c;
      c.rate = options.rate;
      c.seconds = options.seconds;
      c.noise = 0;
      c.time_of_day = 1.7 * static_cast<double>(plan.name.back() - '0');
      conditions.push_back(c);
      Record record = RecordRun(truth.setup, plan, c);
      Append(plan, record, of_truth);
      voltages.push_back(std::move(record.voltage));
    }
  }
  std::vector<double> Of(const RigSetup& setup) const {
    std::vector<double> all;
    for (size_t i = 0; i < plans.size(); ++i) {
      Conditions c = conditions[i];
      c.voltage = &voltages[i];
      Append(plans[i], RecordRun(setup, plans[i], c), &all);
    }
    return all;
  }
};

double RootMeanSquare(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

}  // namespace

double Gap(const Truth& truth, uint64_t seed, const Options& options) {
  std::vector<double> with;
  const Signals signals(truth, seed, options, &with);
  RigSetup plain;
  plain.base = truth.given;
  try {
    return RootMeanSquare(with, signals.Of(plain));
  } catch (const std::runtime_error&) {
    return 1000;  // it runs away under these voltages
  }
}

double GapBeyondValues(const Truth& truth, uint64_t seed, const Options& options) {
  std::vector<double> with;
  const Signals signals(truth, seed, options, &with);
  RigSetup plain;
  plain.base = truth.given;
  const std::vector<double> without = signals.Of(plain);
  std::vector<double> rest(with.size());
  for (size_t i = 0; i < rest.size(); ++i) rest[i] = with[i] - without[i];
  // Directions of the parameters, each made orthogonal to those before (twice, because of rounding) and
  // removed.
  std::vector<std::vector<double>> directions;
  const auto take_off = [](const std::vector<double>& direction, std::vector<double>* from) {
    double along = 0;
    for (size_t i = 0; i < from->size(); ++i) along += direction[i] * (*from)[i];
    for (size_t i = 0; i < from->size(); ++i) (*from)[i] -= along * direction[i];
  };
  for (const auto& form : BaseForms()) {
    RigSetup changed = plain;
    double& value = changed.base.*form.value;
    value = value == 0 ? 1e-5 : value * 1.001;
    std::vector<double> direction = signals.Of(changed);
    double before = 0;
    for (size_t i = 0; i < direction.size(); ++i) {
      direction[i] -= without[i];
      before += direction[i] * direction[i];
    }
    for (const auto& other : directions) take_off(other, &direction);
    for (const auto& other : directions) take_off(other, &direction);
    double length = 0;
    for (const double d : direction) length += d * d;
    if (length < 1e-8 * before || length == 0) continue;  // as good as a combination of the others
    for (double& d : direction) d /= std::sqrt(length);
    take_off(direction, &rest);
    directions.push_back(std::move(direction));
  }
  return RootMeanSquare(rest, std::vector<double>(rest.size(), 0.0));
}

namespace {

bool IsSign(const Case& c) { return c.effects == std::vector<std::string>{"sensor.sign"}; }

// The rig before anything is added to it, and the model that is given with it.
Truth Beginning(const Case& c) {
  Truth truth;
  // The arm's weight differs from rig to rig.
  truth.setup.base.mgl = truth.given.mgl = 200 + static_cast<double>(c.seed % 5) * 50;
  // Gravity would hold the play to one side.
  if (c.outside >= 0 && OutsideForms()[c.outside].value == &Outside::backlash)
    truth.setup.base.mgl = truth.given.mgl = 20;
  if (!c.parameter.empty()) {
    for (const auto& form : BaseForms()) {
      if (form.name != c.parameter) continue;
      // Table 1 has the first at 0 and the second too small to be seen: this rig's pump is worn.
      if (c.parameter == "f") truth.setup.base.f = 8e-4;
      if (c.parameter == "c_I") truth.setup.base.c_I = 4e-6;
      truth.given = truth.setup.base;
      truth.given.*form.value *= c.factor;
    }
  }
  return truth;
}

// Adds what the case has, at this size.
void Put(const Case& c, double size, Truth* truth) {
  truth->effects.clear();
  truth->setup.effects = {};
  truth->setup.outside = {};
  if (c.outside >= 0) {
    truth->setup.outside.*OutsideForms()[c.outside].value = size;
  }
  for (const auto& id : c.effects) {
    const EffectForm& form = FindEffect(id);
    truth->effects.push_back(form.put(c.gap > 0 ? size : form.plain, &truth->setup.effects));
  }
  if (IsSign(c)) {
    const bool arm = c.size == "small";
    truth->setup.effects.sign_channel = arm                  ? Channel::kArmAngle
                                        : c.size == "medium" ? Channel::kP1
                                                             : Channel::kMotorSpeed;
    truth->effects[0].channel = arm ? "arm_angle" : c.size == "medium" ? "p1" : "motor_speed";
  }
}

// Searches the size for which the gap is the case's. Gaps grow roughly as a power of the size: takes the
// secant in logarithms, kept within the known bracket. False: no size reaches it.
bool FindSize(const Case& c, const Options& options, Truth* truth) {
  double low = c.outside >= 0 ? OutsideForms()[c.outside].smallest : FindEffect(c.effects[0]).smallest;
  double high = c.outside >= 0 ? OutsideForms()[c.outside].largest : FindEffect(c.effects[0]).largest;
  const auto gap_at = [&](double size) {
    Put(c, size, truth);
    try {
      return Gap(*truth, c.seed, options);
    } catch (const std::runtime_error&) {
      return 1000.0;
    }
  };
  double low_gap = gap_at(low);
  double high_gap = 1000;
  double size = low;
  truth->gap = low_gap;
  if (low_gap >= c.gap) return std::abs(low_gap / c.gap - 1) < 0.1;
  double guess = std::min(high, low * std::max(1.5, c.gap / std::max(low_gap, 1e-3)));
  for (int i = 0; i < 24; ++i) {
    size = guess;
    truth->gap = gap_at(size);
    if (std::abs(truth->gap / c.gap - 1) < 0.05) return true;
    if (truth->gap < c.gap) {
      low = size;
      low_gap = truth->gap;
      if (size >= 0.999 * high) break;  // as large as it gets
    } else {
      high = size;
      high_gap = truth->gap;
    }
    const double fraction =
        high_gap < 999
            ? std::log(c.gap / low_gap) / std::log(high_gap / low_gap)
            : std::min(1.0, std::log(std::max(1.3, c.gap / std::max(low_gap, 1e-3))) / std::log(high / low));
    guess = low * std::pow(high / low, i % 4 == 3 && high_gap < 999 ? 0.5 : std::clamp(fraction, 0.03, 1.0));
    if (high_gap < 999) guess = std::min(guess, high * 0.995);
    if (high / low < 1.0005) break;
  }
  return false;
}

}  // namespace

Truth Solve(const Case& c, const Options& options) {
  Truth truth = Beginning(c);
  Put(c, 0, &truth);
  if (c.gap == 0 || IsSign(c)) {
    if (c.kind == "single") Put(c, 1, &truth);
    if (c.kind != "nothing") truth.gap = Gap(truth, c.seed, options);
    return truth;
  }
  truth.reached = FindSize(c, options, &truth);
  return truth;
}

}  // namespace hidden_rig
