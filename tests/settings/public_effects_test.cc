// Effects whose ids and parameters are public: model files that other programs write have these and no more.
#include <cmath>
#include <string>
#include <vector>

#include "model/actuator.h"
#include "model/effects/catalogue.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct Public {
  std::string id;
  std::string parameters;             // as a model file has them
  std::vector<std::string> left_out;  // optional ones, which such files do not have
  bool bare_motor = false;
};

const std::vector<Public>& AllPublic() {
  static const std::vector<Public> all = {
      {"gear.load_friction", "motor_share = 0.1\nload_share = 0.2\n", {}},
      {"gear.load_friction", "load_share = 0.2\n", {"motor_share"}},
      {"gear.backlash", "width = 0.02\nstiffness = 200\n", {"damping", "inertia"}, true},
      {"load.gravity", "mgl = 3\nphase = 0.4\n", {}, true},
      {"load.spring", "stiffness = 20\nrest = 0.1\n", {}, true},
      {"load.spring", "stiffness = 5000\nrest = 0.1\n", {}},
      {"motor.back_emf", "k_e = 0.02\n", {"tau"}},
      {"amp.deadband", "width = 0.2\n", {}},
      {"amp.rate_limit", "rate = 800\n", {}},
      {"accumulator.gas", "volume = 0.1\nexponent = 1.2\n", {"precharge"}},
      {"valve.pilot_check", "ratio = 3\ncracking = 10\n", {"range", "conductance"}},
      {"fluid.viscosity", "k = 0.03\n", {}}};
  return all;
}

model::ModelDescription ModelWith(const std::string& section) {
  return ParseModel(std::string(kModelText) + section, "m.toml");
}

std::string SectionOf(const Public& effect, const std::string& parameters) {
  return "[effects.\"" + effect.id + "\"]\n" + parameters;
}

// All channels at each of 200 ticks of a wave that drives the motor both ways.
std::vector<double> Trajectory(const model::ModelDescription& model, bool bare_motor) {
  model::ActuatorOptions options;
  options.shaft = bare_motor ? model::Shaft::kClamped : model::Shaft::kFree;
  options.bypass = bare_motor;
  model::Actuator actuator(model, options);
  std::vector<double> all;
  for (int tick = 0; tick < 200; ++tick) {
    actuator.Advance(5 * std::sin(60e-3 * tick), 1e-3 * (tick + 1));
    const model::Measurement now = actuator.Measure();
    for (size_t channel = 0; channel < model::kChannels; ++channel)
      all.push_back(model::ChannelOf(now, channel));
  }
  return all;
}

// Tests that a model file with an effect's public names alone is read, written, read back and simulated, and
// that the effect acts.
TEST(PublicEffects, LoadAndSimulate) {
  for (const Public& effect : AllPublic()) {
    const model::ModelDescription model = ModelWith(SectionOf(effect, effect.parameters));
    ASSERT_EQ(model.effects.size(), 1u) << effect.id;
    for (const std::string& name : effect.left_out)
      EXPECT_FALSE(model.effects[0].parameters.contains(name)) << effect.id << " " << name;
    EXPECT_EQ(ParseModel(FormatModel(model), "again.toml").effects[0].parameters,
              model.effects[0].parameters);
    const std::vector<double> with = Trajectory(model, effect.bare_motor);
    for (const double number : with) ASSERT_TRUE(std::isfinite(number)) << effect.id;
    EXPECT_NE(with, Trajectory(ModelWith(""), effect.bare_motor)) << effect.id;
  }
}

// Tests that a number that is left out is its standard, bit for bit.
TEST(PublicEffects, LeftOutNumbersHaveTheirStandards) {
  for (const Public& effect : AllPublic()) {
    const model::ModelDescription model = ModelWith(SectionOf(effect, effect.parameters));
    model::ModelDescription stated = model;
    for (const model::ParameterInfo& number : model::FindEffect(effect.id)->parameters) {
      stated.effects[0].parameters[number.name] = NumberOf(model.effects[0], number, model.parameters);
    }
    EXPECT_EQ(stated.effects[0].parameters.size(),
              model.effects[0].parameters.size() + effect.left_out.size());
    EXPECT_EQ(Trajectory(stated, effect.bare_motor), Trajectory(model, effect.bare_motor)) << effect.id;
  }
}

// Tests the standards themselves, with Table 1.
TEST(PublicEffects, Standards) {
  const model::Parameters base = ModelWith("").parameters;
  const auto standard = [&](const char* effect, const char* name) {
    for (const model::ParameterInfo& number : model::FindEffect(effect)->parameters) {
      if (number.name == name) return number.standard.In(base);
    }
    return std::nan("");
  };
  EXPECT_EQ(standard("gear.load_friction", "motor_share"), 0);
  EXPECT_EQ(standard("gear.backlash", "damping"), 0);
  EXPECT_EQ(standard("gear.backlash", "inertia"), base.J);
  EXPECT_EQ(standard("motor.back_emf", "tau"), 0);
  EXPECT_EQ(standard("accumulator.gas", "precharge"), base.p_3);
  EXPECT_NEAR(standard("valve.pilot_check", "range"), 0.01 * 40 / 0.00796, 1e-9);
  // At that pressure it passes what the pump moves at the speed w, where J w^2/2 = V_ms/beta (T_pmax/D)^2.
  const double largest = base.T_pmax / base.D, w = largest * std::sqrt(2 * base.V_ms / (base.beta * base.J));
  EXPECT_NEAR(standard("valve.pilot_check", "conductance") * 0.01 * largest, base.D * w, 1e-12);
}

// Tests that every number without a standard is required, and named where it is missing.
TEST(PublicEffects, RefuseWhatIsMissing) {
  for (const Public& effect : AllPublic()) {
    const model::ModelDescription model = ModelWith(SectionOf(effect, effect.parameters));
    for (const model::ParameterInfo& number : model::FindEffect(effect.id)->parameters) {
      if (number.optional) continue;
      std::string others;
      for (const auto& [name, value] : model.effects[0].parameters) {
        if (name != number.name) others += name + " = " + std::to_string(value) + "\n";
      }
      EXPECT_THAT(InputErrorOf([&] { ModelWith(SectionOf(effect, others)); }),
                  AllOf(HasSubstr("m.toml:"), HasSubstr(effect.id), HasSubstr(number.name),
                        HasSubstr("found nothing")));
    }
  }
}

// Tests that former ids and parameters are refused with what is known, and the nearest of it.
TEST(PublicEffects, RefuseFormerNames) {
  const auto error = [](const std::string& id, const std::string& parameters) {
    return InputErrorOf([&] { ModelWith("[effects.\"" + id + "\"]\n" + parameters); });
  };
  for (const char* id : {"amp.input_dead_band", "amp.input_rate_limit", "valve.pilot", "gear.motor_friction"})
    EXPECT_THAT(error(id, ""), HasSubstr(std::string("unknown effect \"") + id + "\", allowed"));
  EXPECT_THAT(error("valve.pilot", ""), HasSubstr("\"valve.pilot_check\""));
  EXPECT_THAT(error("gear.backlash", "gap = 0.1\nstiffness = 1\n"), HasSubstr("width"));
  EXPECT_THAT(error("load.gravity", "torque = 1\nphase = 0\n"), HasSubstr("mgl"));
  EXPECT_THAT(error("gear.load_friction", "load = 0.1\n"), HasSubstr("load_share"));
  EXPECT_THAT(error("fluid.viscosity", "rate = 0.1\n"), HasSubstr("\"k\""));
}

}  // namespace
}  // namespace hydro::settings
