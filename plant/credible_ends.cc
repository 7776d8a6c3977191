#include "plant/credible_ends.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace hydro::plant {
namespace {

using Source = settings::SensorSection::Source;

constexpr double kBelowVacuum = 0.1;  // of the pressure limit: the offset of a poor transducer
constexpr double kWidestConverter_V = 100;
constexpr double kFarBeyond = 10;

void Narrow(CredibleEnds* ends, double low, double high, const std::string& from) {
  if (low > ends->low.value) ends->low = {low, from};
  if (high < ends->high.value) ends->high = {high, from};
}

CredibleEnds PressureEnds(const settings::StackConfig& config) {
  const model::ModelDescription& model = config.model.description;
  const std::string unit = model.units.UnitFor("psi");
  const double limit = config.limits.pressure_psi;
  if (!std::isfinite(limit)) {
    const double most = kFarBeyond * model.parameters.beta;
    return {{-most, "ten times beta"}, {most, "ten times beta"}, unit};
  }
  return {{-(model::AtmosphereOf(model) + kBelowVacuum * limit), "a vacuum less a tenth of limits.pressure"},
          {2 * limit, "twice limits.pressure"},
          unit};
}

// Twice the limit, or ten times what the machine reaches by itself where there is no limit.
CredibleEnds Symmetric(double limit, const std::string& limit_from, double machine,
                       const std::string& machine_from) {
  CredibleEnds ends;
  const bool limited = std::isfinite(limit);
  const double most = limited ? 2 * limit : kFarBeyond * machine;
  // Without friction, or in the units of another machine, there is no such number.
  if (std::isfinite(most) && most > 0)
    Narrow(&ends, -most, most, limited ? "twice " + limit_from : "ten times " + machine_from);
  return ends;
}

CredibleEnds MotorSpeedEnds(const settings::StackConfig& config) {
  const model::Parameters& p = config.model.description.parameters;
  return Symmetric(config.limits.motor_speed_rad_s, "limits.motor_speed", p.T_pmax / p.b, "T_pmax/b");
}

CredibleEnds ArmSpeedEnds(const settings::StackConfig& config) {
  const model::Parameters& p = config.model.description.parameters;
  const double motor = MotorSpeedEnds(config).high.value;
  return Symmetric(std::numeric_limits<double>::infinity(), "", motor * p.D / p.c,
                   "the motor's most credible speed times D/c");
}

CredibleEnds DefaultEnds(const settings::StackConfig& config, const std::string& name) {
  const model::ModelDescription& model = config.model.description;
  const model::Parameters& p = model.parameters;
  if (name == "p1" || name == "p2") return PressureEnds(config);
  CredibleEnds ends;
  if (name == "motor_speed") ends = MotorSpeedEnds(config);
  if (name == "arm_speed") ends = ArmSpeedEnds(config);
  if (name == "arm_angle")
    ends = Symmetric(config.limits.arm_angle_rad, "limits.arm_angle", p.V_ms / p.c, "V_ms/c");
  ends.unit =
      model.units.UnitFor(name.ends_with("speed") ? "rad/s" : "rad", name.starts_with("arm_") ? 1 : 0);
  return ends;
}

}  // namespace

std::string CredibleEnds::Allowed(double signal) const {
  const bool low_end = signal < low.value;
  const CredibleEnd& end = low_end ? low : high;
  return fmt::format("at {} {:.6g} {}, {}", low_end ? "least" : "most", end.value, unit, end.from);
}

CredibleEnds CredibleEndsOf(const settings::StackConfig& config, const std::string& name,
                            const settings::SensorSection& section) {
  CredibleEnds ends = DefaultEnds(config, name);
  if (section.source != Source::kAnalog) return ends;
  const auto signal = [&](double reading) { return section.scale * reading + section.offset; };
  if (section.limit_suffix == "_V") {
    const auto [low, high] = std::minmax({signal(-kWidestConverter_V), signal(kWidestConverter_V)});
    Narrow(&ends, low, high, fmt::format("{:g} V at the input", kWidestConverter_V));
  }
  // A key says what is credible at its end, and replaces the default there.
  CredibleEnd& of_minimum = section.scale > 0 ? ends.low : ends.high;
  CredibleEnd& of_maximum = section.scale > 0 ? ends.high : ends.low;
  const std::string key = "driver." + name + ".";
  if (!std::isnan(section.minimum))
    of_minimum = {signal(section.minimum), key + "minimum" + section.limit_suffix};
  if (!std::isnan(section.maximum))
    of_maximum = {signal(section.maximum), key + "maximum" + section.limit_suffix};
  return ends;
}

}  // namespace hydro::plant
