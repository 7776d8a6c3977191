#include "runs/tracking.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace hydro::runs {
namespace {

// A run at 1 kHz for `ticks` ticks whose arm and reference are given functions of time.
RunLog MakeRun(int64_t ticks, const std::function<double(double)>& arm,
               const std::function<double(double)>& reference) {
  RunLog log;
  for (int64_t tick = 0; tick <= ticks; ++tick) {
    state_t state{};
    state.tick = tick;
    state.time = 1e-3 * static_cast<double>(tick);
    state.arm_angle = arm(state.time);
    log.messages.Of<state_t>().push_back(state);
    if (tick % 5 != 0) continue;
    arm_reference_t sample{};
    sample.tick = tick;
    sample.signal = arm_reference_t::ARM_ANGLE;
    sample.value = reference(state.time);
    log.messages.Of<arm_reference_t>().push_back(sample);
  }
  return log;
}

double StepAtOne(double t) { return t < 1 ? 0.0 : 0.5; }

// Tests overshoot, settling time and final error of a second-order response against their closed forms.
TEST(TrackingTest, SecondOrderStep) {
  const double omega = 20, zeta = 0.4, damped = omega * std::sqrt(1 - zeta * zeta);
  const auto arm = [&](double t) {
    if (t < 1) return 0.0;
    const double s = t - 1;
    return 0.5 * (1 - std::exp(-zeta * omega * s) *
                          (std::cos(damped * s) + zeta / std::sqrt(1 - zeta * zeta) * std::sin(damped * s)));
  };
  const Tracking tracking = TrackArm(MakeRun(4000, arm, StepAtOne));
  ASSERT_TRUE(tracking.has_reference);
  ASSERT_EQ(tracking.steps.size(), 1u);
  const StepResponse& step = tracking.steps[0];
  EXPECT_DOUBLE_EQ(step.time_s, 1);
  EXPECT_EQ(step.from_rad, 0);
  EXPECT_EQ(step.to_rad, 0.5);
  EXPECT_NEAR(step.overshoot_percent, 100 * std::exp(-M_PI * zeta / std::sqrt(1 - zeta * zeta)), 0.05);
  ASSERT_TRUE(step.settling_time_s.has_value());
  // The envelope reaches 2 % at -ln(0.02 sqrt(1 - zeta^2))/(zeta omega); the response at most half a period
  // before.
  const double envelope = -std::log(0.02 * std::sqrt(1 - zeta * zeta)) / (zeta * omega);
  EXPECT_LE(*step.settling_time_s, envelope + 1e-3);
  EXPECT_GE(*step.settling_time_s, envelope - M_PI / damped);
  EXPECT_NEAR(step.final_error_rad, 0, 1e-9);
  EXPECT_EQ(tracking.at_target, true);
}

// Tests that an arm that stops short is not at its target, never settles, and has its error reported with its
// sign.
TEST(TrackingTest, StopsShort) {
  const Tracking tracking = TrackArm(MakeRun(
      3000, [](double t) { return t < 1 ? 0.0 : 0.48; }, StepAtOne));
  ASSERT_EQ(tracking.steps.size(), 1u);
  EXPECT_FALSE(tracking.steps[0].settling_time_s.has_value());
  EXPECT_NEAR(tracking.final_error_rad, -0.02, 1e-12);
  EXPECT_EQ(tracking.at_target, false);
  EXPECT_EQ(tracking.steps[0].overshoot_percent, 0);
}

// Tests that a downward step's overshoot counts downwards.
TEST(TrackingTest, DownwardOvershoot) {
  const Tracking tracking = TrackArm(MakeRun(
      3000, [](double t) { return t < 1     ? 0.5
                                  : t < 1.5 ? -0.05
                                            : 0.0; },
      [](double t) { return t < 1 ? 0.5 : 0.0; }));
  ASSERT_EQ(tracking.steps.size(), 1u);
  EXPECT_NEAR(tracking.steps[0].overshoot_percent, 10, 1e-9);
  EXPECT_NEAR(*tracking.steps[0].settling_time_s, 0.5, 1.1e-3);
}

// Tests that a sine reference has no steps, only an error.
TEST(TrackingTest, SineHasNoSteps) {
  const auto sine = [](double t) { return 0.3 * std::sin(6 * t); };
  const Tracking tracking = TrackArm(MakeRun(
      4000, [&](double t) { return sine(t) + 0.01; }, sine));
  EXPECT_TRUE(tracking.steps.empty());
  EXPECT_EQ(tracking.at_target, std::nullopt);       // it still moves
  EXPECT_NEAR(tracking.rms_error_rad, 0.01, 0.002);  // the reference is held for 5 ms
}

// Tests that a hold and the way back from it take the step that they disturb out of the list, and no other.
TEST(TrackingTest, AHoldLeavesTheOtherSteps) {
  const auto reference = [](double t) {
    if (t < 0.5) return 0.0;
    if (t < 1.5) return 0.1;
    if (t < 1.8) return 0.2;
    if (t < 1.9) return 0.15;                           // held where the arm is
    if (t < 2.4) return 0.15 + 0.05 * (t - 1.9) / 0.5;  // and back
    return t < 3 ? 0.2 : 0.0;
  };
  const Tracking tracking = TrackArm(MakeRun(4000, reference, reference));
  ASSERT_EQ(tracking.steps.size(), 2u);
  EXPECT_NEAR(tracking.steps[0].time_s, 0.5, 0.006);
  EXPECT_NEAR(tracking.steps[1].time_s, 3, 0.006);
  EXPECT_EQ(tracking.steps_left_out, 1);
}

// Tests that a reference that is constant from the start is a step from where the arm was.
TEST(TrackingTest, ConstantReferenceElsewhereIsAStep) {
  const Tracking tracking = TrackArm(MakeRun(
      2000, [](double t) { return 0.3 - 0.2 * std::exp(-20 * t); }, [](double) { return 0.3; }));
  ASSERT_EQ(tracking.steps.size(), 1u);
  EXPECT_EQ(tracking.steps[0].time_s, 0);
  EXPECT_DOUBLE_EQ(tracking.steps[0].from_rad, 0.1);
  EXPECT_EQ(tracking.steps[0].to_rad, 0.3);
  ASSERT_TRUE(tracking.steps[0].settling_time_s.has_value());
  EXPECT_NEAR(*tracking.steps[0].settling_time_s, std::log(50) / 20, 0.002);
  EXPECT_EQ(tracking.steps_left_out, 0);
}

// Tests that an arm that holds still at a constant reference is at its target, up to a tolerance and no
// further.
TEST(TrackingTest, ConstantReference) {
  const auto constant = [](double) { return 0.2; };
  EXPECT_EQ(TrackArm(MakeRun(
                         500, [](double) { return 0.2001; }, constant))
                .at_target,
            true);
  EXPECT_EQ(TrackArm(MakeRun(
                         500, [](double) { return 0.202; }, constant))
                .at_target,
            false);
}

// The description of a run whose model has a linear arm in that unit.
run_description_t InUnits(const std::string& length) {
  run_description_t description{};
  description.model_text =
      "units = { length = \"" + length + "\", force = \"N\", arm = \"" + length + "\" }\n";
  return description;
}

// Tests that a linear arm is judged and shown in its own unit: 0.05 mm from its target it is there, 0.2 mm from it not, whether its
// position is in mm or in m.
TEST(TrackingTest, ALinearArmHasLengths) {
  for (const std::string length : {"mm", "m"}) {
    const double mm = length == "mm" ? 1 : 1e-3;
    for (const double error : {0.05, 0.2}) {
      RunLog log = MakeRun(
          500, [&](double) { return (2 + error) * mm; }, [&](double) { return 2 * mm; });
      log.messages.Of<run_description_t>().push_back(InUnits(length));
      const Tracking tracking = TrackArm(log);
      EXPECT_EQ(tracking.at_target, error < 0.1) << length << " " << error;
    }
    RunLog log = MakeRun(
        4000, [&](double t) { return t < 1 ? 0 : 30 * mm; }, [&](double t) { return t < 1 ? 0 : 30 * mm; });
    log.messages.Of<run_description_t>().push_back(InUnits(length));
    const Tracking tracking = TrackArm(log);
    const std::string own = SummaryText(tracking, Summarise(log, false), false);
    EXPECT_THAT(own, ::testing::HasSubstr(mm == 1 ? "to 30 mm: overshoot" : "to 0.03 m: overshoot"));
    EXPECT_THAT(own, ::testing::Not(::testing::HasSubstr("rad")));
    const std::string si = SummaryText(tracking, Summarise(log, true), true);
    EXPECT_THAT(si, ::testing::HasSubstr("at its target 30 mm: final error 0 mm"));
    EXPECT_THAT(si, ::testing::Not(::testing::HasSubstr("deg")));
    EXPECT_THAT(SummaryJson(tracking, Summarise(log, false)),
                ::testing::HasSubstr("\"target_" + std::string(length) + "\": "));
  }
}

// Tests that what ended a run early stands first, and what was reached then, in the past tense of that end; and that
// a run which lasted as long as it should has no such line, whatever was sent after it.
TEST(TrackingTest, WhatEndedARunStandsFirst) {
  using ::testing::HasSubstr;
  using ::testing::Not;
  using ::testing::StartsWith;
  const auto still = [](double) { return 0.2; };
  RunLog log = MakeRun(500, still, still);
  const auto text = [&] { return SummaryText(TrackArm(log), Summarise(log, false), false); };
  const auto add = [&](int exit_code, const std::string& reason) {
    stop_t stop{};
    stop.tick = 500;
    stop.session = static_cast<int64_t>(log.messages.Of<stop_t>().size());
    stop.source = exit_code == 0 ? "launch" : "pressure_ctrl";
    stop.reason = reason;
    stop.exit_code = exit_code;
    log.messages.Of<stop_t>().push_back(stop);
  };
  EXPECT_THAT(text(), StartsWith("501 states"));
  EXPECT_THAT(text(), HasSubstr("\narm at its target 0.2000 rad: final error"));
  add(0, "stopped by signal 2");
  EXPECT_THAT(text(), StartsWith("the run was stopped at tick 500: launch: stopped by signal 2\n501 states"));
  EXPECT_THAT(text(), HasSubstr("\nwhen it ended: arm at its target 0.2000 rad: error"));
  add(1, "fault pressure_limit: 2001 psi");
  EXPECT_THAT(text(),
              StartsWith("the run FAILED at tick 500: pressure_ctrl: fault pressure_limit: 2001 psi\n"));
  EXPECT_THAT(SummaryJson(TrackArm(log), Summarise(log, false)), HasSubstr("\"failed\": true"));
  log.messages.Of<stop_t>().clear();
  add(0, "the run is complete after 0.5 s");
  add(0, "stopped by signal 2");
  EXPECT_THAT(text(), StartsWith("501 states"));
  EXPECT_THAT(SummaryJson(TrackArm(log), Summarise(log, false)), Not(HasSubstr("ended_early")));
  RunLog one = MakeRun(0, still, still);
  one.messages.Of<stop_t>() = log.messages.Of<stop_t>();
  one.messages.Of<stop_t>().front().exit_code = 1;
  EXPECT_THAT(SummaryText(TrackArm(one), Summarise(one, false), false), Not(HasSubstr("target")))
      << "nothing was followed";
}

// Tests that a reference which follows the arm, because the voltage is held at zero, is no target: neither at the end
// of a run nor in JSON. Tables without commands have none that could be held.
TEST(TrackingTest, AHeldVoltageHasNoTarget) {
  RunLog log = MakeRun(
      500, [](double) { return 0.2; }, [](double) { return 0.2; });
  std::vector<state_t>& states = log.messages.Of<state_t>();
  for (state_t& state : states) state.command_tick = -1;
  EXPECT_EQ(TrackArm(log).at_target, true);
  for (state_t& state : states) state.command_tick = state.tick < 300 ? state.tick : -1;
  const Tracking tracking = TrackArm(log);
  EXPECT_EQ(tracking.at_target, std::nullopt);
  EXPECT_THAT(SummaryText(tracking, Summarise(log, false), false),
              ::testing::HasSubstr("the voltage is held at zero, and the reference follows the arm"));
  EXPECT_THAT(SummaryJson(tracking, Summarise(log, false)), ::testing::HasSubstr("\"at_target\": null"));
}

// Tests that a run without arm-angle references says so instead of dividing by zero.
TEST(TrackingTest, NoReference) {
  RunLog log = MakeRun(
      100, [](double) { return 0.0; }, StepAtOne);
  for (arm_reference_t& reference : log.messages.Of<arm_reference_t>())
    reference.signal = arm_reference_t::PRESSURE;
  EXPECT_FALSE(TrackArm(log).has_reference);
  EXPECT_FALSE(TrackArm(RunLog()).has_reference);
}

}  // namespace
}  // namespace hydro::runs
