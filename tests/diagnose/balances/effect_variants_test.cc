// Tests of how the scan tries effects: what the catalogue says of their parameters decides.
#include "diagnose/balances/effect_variants.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "model/terms/parameter_info.h"
#include "tests/diagnose/balances/clean_runs.h"

namespace hydro::testing {
namespace {

using diagnose::EffectVariant;
using Kind = EffectVariant::Kind;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

diagnose::Sizes SizesHere() {
  diagnose::Sizes sizes;
  sizes.torque = 40;
  sizes.speed = 600;
  sizes.pressure = 2000;
  sizes.charge = 100;
  sizes.sample = 1e-3;
  sizes.flow = 2e-3;
  sizes.arm_stiffness = 2e7;
  sizes.arm_damping = 2e4;
  return sizes;
}

std::vector<EffectVariant> Of(const std::string& effect, const std::string& signal = "") {
  diagnose::Change change{effect, {}, ""};
  if (!signal.empty()) change.names["signal"] = signal;
  return diagnose::VariantsOf({change}, SizesHere());
}

// The values of the shape on its grid, in their order.
std::vector<double> GridOf(const std::vector<EffectVariant>& variants, const std::string& parameter) {
  std::vector<double> grid;
  for (const EffectVariant& one : variants) grid.push_back(one.at.parameters.at(parameter));
  return grid;
}

// Tests that what an effect is proportional to is an amount, whatever its bounds are.
TEST(EffectVariants, AmountsAreLinear) {
  for (const char* effect : {"pump.quadratic_drag", "sensor.pressure_gain", "fluid.stiffening", "amp.bias"}) {
    const std::vector<EffectVariant> variants = Of(effect);
    ASSERT_EQ(variants.size(), 1u) << effect;
    EXPECT_EQ(variants[0].set, effect);
    EXPECT_EQ(variants[0].kind, Kind::kAmounts);
    ASSERT_EQ(variants[0].amounts.size(), 1u) << effect;
    EXPECT_EQ(variants[0].at.parameters.at(variants[0].amounts[0]), 0);
    EXPECT_THAT(variants[0].shapes, IsEmpty());
  }
  // Its bound of -1 says that readings cannot be turned round, not that it is a shape.
  EXPECT_THAT(Of("sensor.pressure_gain")[0].amounts, ElementsAre("gain"));
}

// Tests that the excess of friction is an amount at each speed, and that speeds differ by a factor of 2 at
// most.
TEST(EffectVariants, ShapesAreOnADenseGrid) {
  const std::vector<EffectVariant> variants = Of("pump.stribeck");
  const std::vector<double> speeds = GridOf(variants, "speed");
  ASSERT_GE(speeds.size(), 3u);
  EXPECT_DOUBLE_EQ(speeds.front(), 0.005 * 600);
  EXPECT_DOUBLE_EQ(speeds.back(), 0.15 * 600);
  std::set<std::string> sets;
  for (size_t i = 0; i < speeds.size(); ++i) {
    if (i > 0) {
      EXPECT_GT(speeds[i], speeds[i - 1]);
      EXPECT_LT(speeds[i], 2.0001 * speeds[i - 1]);
    }
    EXPECT_EQ(variants[i].kind, Kind::kAmounts);
    EXPECT_THAT(variants[i].amounts, ElementsAre("static_excess"));
    EXPECT_THAT(variants[i].shapes, ElementsAre("speed"));
    EXPECT_TRUE(variants[i].set.starts_with("pump.stribeck|"));
    sets.insert(variants[i].set);
  }
  EXPECT_EQ(sets.size(), variants.size());
}

// Tests that a time constant is tried as a whole in half octaves, from what a sample can show.
TEST(EffectVariants, TimesAreWholes) {
  const std::vector<EffectVariant> variants = Of("amp.lag");
  const std::vector<double> times = GridOf(variants, "tau");
  ASSERT_EQ(times.size(), 13u);
  EXPECT_DOUBLE_EQ(times[0], 5e-4);
  for (size_t i = 0; i < times.size(); ++i) {
    EXPECT_EQ(variants[i].kind, Kind::kWhole);
    EXPECT_THAT(variants[i].amounts, IsEmpty());
    if (i > 0) {
      EXPECT_NEAR(times[i] / times[i - 1], std::sqrt(2.0), 1e-9);
    }
  }
  diagnose::Sizes slow = SizesHere();
  slow.sample = 0.01;
  for (const EffectVariant& one : diagnose::VariantsOf({{"amp.lag", {}, ""}}, slow))
    EXPECT_GE(one.at.parameters.at("tau"), 0.2 * slow.sample);
}

// Tests that what repeats with the shaft is one variant, whose periods are tried elsewhere.
TEST(EffectVariants, WavesAreOneVariant) {
  for (const char* effect : {"motor.cogging", "pump.flow_ripple"}) {
    const std::vector<EffectVariant> variants = Of(effect);
    ASSERT_EQ(variants.size(), 1u) << effect;
    EXPECT_EQ(variants[0].kind, Kind::kWave);
    EXPECT_EQ(variants[0].set, effect);
  }
}

// Tests that each channel is one variant, linear in the time that it is late, and that lags of sensors are as
// well.
TEST(EffectVariants, ChannelsAreOneVariantEach) {
  for (const char* signal : {"p1", "motor_speed"}) {
    const std::vector<EffectVariant> variants = Of("sensor.skew", signal);
    ASSERT_EQ(variants.size(), 1u) << signal;
    EXPECT_EQ(variants[0].set, std::string("sensor.skew(") + signal + ")");
    EXPECT_EQ(variants[0].kind, Kind::kAmounts);
    EXPECT_THAT(variants[0].amounts, ElementsAre("delay"));
    EXPECT_TRUE(variants[0].is_time);
    EXPECT_EQ(variants[0].at.names.at("signal"), signal);
  }
  const std::vector<EffectVariant> lag = Of("sensor.pressure_lag");
  ASSERT_EQ(lag.size(), 1u);
  EXPECT_TRUE(lag[0].is_time);
}

// Tests that values of base parameters, and effects that nobody knows, make no variant.
TEST(EffectVariants, OnlyOfEffects) {
  EXPECT_THAT(diagnose::VariantsOf({{"", {}, "b"}, {"pump.unheard_of", {}, ""}}, SizesHere()), IsEmpty());
}

// Tests that variants of all effects of the catalogue have all numbers that a model needs, within their
// bounds, under names of their own.
TEST(EffectVariants, AllAreModels) {
  std::set<std::string> sets;
  size_t count = 0;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    diagnose::Change change{info.id, {}, ""};
    for (const model::ParameterInfo& parameter : info.parameters) {
      if (parameter.is_name()) change.names[parameter.name] = parameter.names.front();
    }
    for (const EffectVariant& one : diagnose::VariantsOf({change}, SizesHere())) {
      ++count;
      sets.insert(one.set);
      if (one.kind == Kind::kWave) continue;
      for (const model::ParameterInfo& parameter : info.parameters) {
        if (!parameter.is_number()) continue;
        if (!diagnose::IsFitted(info, parameter)) {
          EXPECT_FALSE(one.at.parameters.contains(parameter.name)) << one.set << " " << parameter.name;
          continue;
        }
        ASSERT_TRUE(one.at.parameters.contains(parameter.name)) << one.set << " " << parameter.name;
        const double value = one.at.parameters.at(parameter.name);
        EXPECT_GE(value, parameter.min) << one.set << " " << parameter.name;
        EXPECT_LE(value, parameter.max) << one.set << " " << parameter.name;
      }
    }
  }
  EXPECT_EQ(sets.size(), count);
  EXPECT_GT(count, model::EffectCatalogue().size());
}

// Tests that an optional number stays at its standard, except in an effect that somebody has asked for.
TEST(EffectVariants, OptionalNumbersStayAtTheirStandards) {
  const std::vector<EffectVariant> gear = Of("gear.load_friction");
  ASSERT_EQ(gear.size(), 1u);
  EXPECT_THAT(gear[0].amounts, ElementsAre("load_share"));
  EXPECT_FALSE(gear[0].at.parameters.contains("motor_share"));
  EXPECT_TRUE(Of("accumulator.gas")[0].at.parameters.contains("precharge"));
}

}  // namespace
}  // namespace hydro::testing
