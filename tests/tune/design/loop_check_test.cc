#include "tune/design/loop_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/runs/shipped_models.h"
#include "experiments/runs/stack_run.h"
#include "pressure_ctrl/law/pressure_law.h"
#include "settings/model_file.h"
#include "tests/settings/texts.h"
#include "tune/design/operating_cases.h"

namespace hydro::design {
namespace {

using experiments::ShippedModel;
using experiments::ShippedStackText;
using ::testing::HasSubstr;

settings::StackConfig Retuned(const std::vector<std::string>& overrides,
                              const model::ModelDescription& model = ShippedModel("table1")) {
  return settings::ParseStackConfig(ShippedStackText("retuned", overrides), "stack.toml",
                                    settings::FormatModel(model), "model.toml");
}

// Tests that the shipped stack is stable with margins in every case, and that one line says so.
TEST(LoopCheck, OfTheShippedStack) {
  const LoopCheck check = CheckLoops(Retuned({}));
  EXPECT_TRUE(check.stable());
  EXPECT_EQ(check.unjudged, "");
  ASSERT_TRUE(check.pressure && check.position);
  EXPECT_EQ(check.cases.size(), 9U);
  EXPECT_GT(check.position->worst.gain, 3);
  EXPECT_LT(check.position->worst.gain, 4);
  EXPECT_THAT(check.position->worst_case, HasSubstr("side 1 compresses, arm at -0.429 rad"));
  EXPECT_THAT(Describe(check), HasSubstr("pressure loop: gain margin 32."));
  EXPECT_THAT(Describe(check), HasSubstr("; position loop: gain margin 3."));
  // By symmetry, which side compresses and where the arm is may change together.
  EXPECT_NEAR(check.cases[4].position->gain, check.cases[8].position->gain, 1e-6);
}

// Tests that an arm whose seals may stick is judged as it slips: one that sticks bears any gain.
TEST(LoopCheck, OfAnArmThatSlips) {
  model::ModelDescription model = ShippedModel("table1");
  model.effects.push_back({"actuator.seal_friction", {{"coulomb", 100}, {"viscous", 0}}, {}});
  const LoopCheck without = CheckLoops(Retuned({})), check = CheckLoops(Retuned({}, model));
  ASSERT_TRUE(check.position);
  EXPECT_EQ(check.cases.size(), 27U) << "low and high pressures, and an arm that sticks";
  for (const CheckedCase& one : check.cases) {
    const bool sticks = one.name.ends_with(", arm sticks");
    EXPECT_NE(sticks, one.position.has_value()) << one.name;
    EXPECT_TRUE(one.pressure.stable) << one.name;
  }
  EXPECT_NEAR(check.position->worst.gain, without.position->worst.gain, 0.01 * without.position->worst.gain);
  const LoopCheck fast = CheckLoops(Retuned({"position.c1=60000", "position.c2=5400"}, model));
  EXPECT_THAT(Describe(fast), HasSubstr("position loop: UNSTABLE"));
}

TEST(LoopCheck, NamesTheLoopThatIsUnstable) {
  const LoopCheck position = CheckLoops(Retuned({"position.c1=60000", "position.c2=5400"}));
  EXPECT_FALSE(position.stable());
  EXPECT_TRUE(position.pressure->worst.stable);
  EXPECT_THAT(Describe(position), HasSubstr("position loop: UNSTABLE (stable with less than 0.6"));
  const LoopCheck pressure = CheckLoops(Retuned({"reference.signal=pressure", "plant.rate_hz=200"}));
  EXPECT_FALSE(pressure.stable());
  EXPECT_FALSE(pressure.position.has_value());
  EXPECT_THAT(Describe(pressure), HasSubstr("pressure loop: UNSTABLE"));
}

TEST(LoopCheck, JudgesTheLoopsThatAreClosed) {
  const LoopCheck voltage = CheckLoops(Retuned({"reference.signal=voltage"}));
  EXPECT_FALSE(voltage.pressure || voltage.position);
  EXPECT_THAT(Describe(voltage), HasSubstr("no loop is closed"));
  EXPECT_FALSE(CheckLoops(Retuned({"reference.signal=torque"})).position);
  const LoopCheck clamped = CheckLoops(Retuned({"model.shaft=clamped"}));
  EXPECT_TRUE(clamped.pressure.has_value());
  EXPECT_EQ(clamped.cases.size(), 3U);
  EXPECT_THAT(clamped.unjudged, HasSubstr("does not move a shaft that is held"));
  EXPECT_TRUE(clamped.stable() && !clamped.unknown) << "a loop that moves nothing is none to fear";
  EXPECT_THAT(CheckLoops(Retuned({"model.bypass=true"})).unjudged, HasSubstr("bypass"));
  const LoopCheck seldom = CheckLoops(
      Retuned({"plant.rate_hz=1e6", "pressure.rate_hz=8e3", "position.sample_interval_s=0.006001"}));
  EXPECT_THAT(seldom.unjudged, HasSubstr("repeats too seldom"));
  EXPECT_TRUE(seldom.unknown && !seldom.stable()) << "what is not known is not stable";
  const LoopCheck uneven = CheckLoops(
      Retuned({"pressure.rate_hz=1000", "position.sample_interval_s=0.0052", "time.duration_s=1.04"}));
  EXPECT_TRUE(uneven.stable());
  EXPECT_THAT(Describe(uneven), HasSubstr("position loop: stable, margins unknown"));
  const LoopCheck wild = CheckLoops(Retuned({"position.c1=1e300", "position.c2=1e300"}));
  EXPECT_FALSE(wild.stable());
  const LoopCheck none = CheckLoops(Retuned({"position.c1=0", "position.c2=0"}));
  EXPECT_TRUE(none.stable());
  EXPECT_TRUE(std::isinf(none.position->worst.gain));
}

// Tests every effect's example: whatever a model has, there is a verdict. (That delays cost margin is tested
// in linear_stack_test.)
TEST(LoopCheck, TakesEffectsIntoAccount) {
  model::ModelDescription model = ShippedModel("table1");
  model.effects = {{"amp.delay", {{"delay", 0.004}}, {}}};
  const LoopCheck delayed = CheckLoops(Retuned({}, model));
  EXPECT_FALSE(delayed.stable()) << "2.3 ms is its delay margin";
  model.effects = {{"sensor.skew", {{"delay", 0.01}}, {{"signal", "arm_angle"}}}};
  // The arm's speed comes from the same sensor; fed forward late it would cost more.
  const std::vector<std::string> alone = {"pressure.arm_speed_feedforward=false", "position.c1=2000"};
  const double late = CheckLoops(Retuned(alone, model)).cases.front().position->delay;
  EXPECT_NEAR(CheckLoops(Retuned(alone)).cases.front().position->delay - late, 0.01, 1e-5);
  for (const model::EffectDescription& effect :
       {model::EffectDescription{"arm.flexure", {{"stiffness", 6000}, {"damping", 60}}, {}},
        model::EffectDescription{
            "line.wave", {{"frequency", 300}, {"volume_fraction", 0.2}, {"damping", 0.05}}, {}},
        model::EffectDescription{"valve.check", {{"cracking", 10}, {"conductance", 0.001}}, {}},
        model::EffectDescription{"pump.stribeck", {{"static_excess", 0.5}, {"speed", 3}}, {}}}) {
    model.effects = {effect};
    const LoopCheck check = CheckLoops(Retuned({"limits.arm_angle=0.3"}, model));
    EXPECT_EQ(check.unjudged, "") << effect.id;
    EXPECT_EQ(check.cases.size(), 18U) << effect.id;
  }
}

// The actuator without friction that stops small oscillations, both sides well above p_3 at its start.
model::ModelDescription Smooth() {
  model::ModelDescription model = ShippedModel("table1");
  model.parameters.T_s = 0;
  return model;
}

struct Swing {
  double early = 0;
  double late = 0;
};

// Half the range of a column in two windows of a run.
Swing SwingOf(const tables::Table& run, const std::string& column, double early, double late, double width) {
  const auto half_range = [&](double begin) {
    const std::vector<double>& time = run.Find("time_s")->values;
    const std::vector<double>& value = run.Find(column)->values;
    double low = 1e300;
    double high = -1e300;
    for (size_t i = 0; i < time.size(); ++i) {
      if (time[i] < begin || time[i] >= begin + width) continue;
      low = std::min(low, value[i]);
      high = std::max(high, value[i]);
    }
    return (high - low) / 2;
  };
  return {half_range(early), half_range(late)};
}

// Tests the critical factor of the position loop, at mid-stroke with both sides compressing, on the stack in
// simulation: with 3 % less gain a small oscillation decays, with 3 % more it grows as fast as the spectral
// radius says.
TEST(LoopCheck, CriticalPositionGainIsWhereTheStackBeginsToOscillate) {
  const std::vector<std::string> base = {"model.initial_pressure=1500", "limits.pressure=inf",
                                         "reference.steps=[[0.1, 1e-5]]", "time.duration_s=2.1"};
  const double critical = CheckLoops(Retuned(base, Smooth())).cases.front().position->gain;
  EXPECT_GT(critical, 4);
  for (const double factor : {0.97, 1.03}) {
    std::vector<std::string> settings = base;
    settings.push_back("position.c1=" + std::to_string(1e4 * critical * factor));
    settings.push_back("position.c2=" + std::to_string(900 * critical * factor));
    const tables::Table run = experiments::RunStackInProcess(
        {"stack", ShippedStackText("retuned", settings), settings::FormatModel(Smooth())});
    const Swing swing = SwingOf(run, "arm_angle_rad", 0.6, 1.6, 0.2);
    const LoopMargins predicted = *CheckLoops(Retuned(settings, Smooth())).cases.front().position;
    EXPECT_EQ(predicted.stable, factor < 1);
    EXPECT_EQ(swing.late > swing.early, factor > 1) << swing.early << " " << swing.late;
    if (factor > 1) {
      EXPECT_NEAR(std::log(swing.late / swing.early), std::log(predicted.spectral_radius) / 0.005, 0.1);
    }
  }
}

// The same for the pressure loop with a free arm and a pressure as reference.
TEST(LoopCheck, CriticalPressureGainIsWhereTheStackBeginsToOscillate) {
  const std::vector<std::string> base = {
      "model.initial_pressure=1500", "limits.pressure=inf",
      "reference.signal=pressure",   "reference.steps=[[0.01, 1e-4], [0.012, 0]]",
      "plant.rate_hz=1000",          "time.duration_s=0.51"};
  const double critical = CheckLoops(Retuned(base, Smooth())).cases.front().pressure.gain;
  const auto gains = pressure_ctrl::DerivePressureGains(Smooth().parameters, 0, 150, 0.5, 2);
  for (const double factor : {0.97, 1.03}) {
    std::string text = ShippedStackText("retuned", base);
    text = settings::Replaced(text, "natural_frequency_rad_s = 150.0",
                              "k_p = " + std::to_string(gains.k_p * critical * factor));
    text = settings::Replaced(text, "damping_ratio = 0.5", "k_v = " + std::to_string(gains.k_v));
    const tables::Table run =
        experiments::RunStackInProcess({"stack", text, settings::FormatModel(Smooth())});
    const Swing swing = SwingOf(run, "motor_speed_rad_s", 0.1, 0.4, 0.1);
    EXPECT_EQ(swing.late > swing.early, factor > 1) << swing.early << " " << swing.late;
    const LoopMargins predicted =
        CheckLoops(settings::ParseStackConfig(text, "stack.toml", settings::FormatModel(Smooth()), "m"))
            .cases.front()
            .pressure;
    EXPECT_EQ(predicted.stable, factor < 1);
    if (factor > 1) {
      EXPECT_NEAR(std::log(swing.late / swing.early), 0.3 * std::log(predicted.spectral_radius) / 1e-3, 0.3);
    }
  }
}

// Tests the places that are looked at.
TEST(OperatingCases, FollowTheShaftAndItsLimits) {
  EXPECT_THAT(OperatingCases(Retuned({"limits.arm_angle=0.25"}))[3].name, HasSubstr("arm at -0.25 rad"));
  EXPECT_THAT(OperatingCases(Retuned({"reference.steps=[[0.1, 0.6]]"}))[3].name,
              HasSubstr("arm at -0.6 rad"));
  EXPECT_EQ(OperatingCases(Retuned({"model.bypass=true"})).size(), 3U);
  const settings::StackConfig driven = settings::ParseStackConfig(
      ShippedStackText("retuned", {"model.shaft=driven", "reference.signal=torque"}) +
          "\n[model.motion]\nkind = \"sine\"\namplitude = 0.2\n",
      "stack.toml", settings::FormatModel(ShippedModel("table1")), "model.toml");
  const auto cases = OperatingCases(driven);
  EXPECT_EQ(cases.size(), 9U);
  EXPECT_EQ(cases.front().actuator_angle, -1);
  EXPECT_THAT(cases.back().name, HasSubstr("arm at 0.2 rad"));
}

}  // namespace
}  // namespace hydro::design
