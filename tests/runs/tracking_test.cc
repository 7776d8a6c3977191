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

// Tests that what counts as being at the target is what a step's "within" says, of the step that led there:
// 2 % of it, or 0.001 rad where that is more; and that the text states it and the time of the mean.
TEST(TrackingTest, OneTolerance) {
  using ::testing::HasSubstr;
  for (const double size : {0.4, 0.02}) {
    const double tolerance = std::max(0.02 * size, 0.001);
    for (const double share : {0.9, 1.1}) {
      // A step of 1 rad comes before, of which 2 % would be 0.02 rad.
      const auto reference = [&](double t) { return t < 1 ? 0.0 : t < 2 ? 1.0 : 1.0 + size; };
      const Tracking tracking = TrackArm(MakeRun(
          4000, [&](double t) { return reference(t) - (t < 2 ? 0 : share * tolerance); }, reference));
      ASSERT_EQ(tracking.steps.size(), 2u);
      EXPECT_NEAR(tracking.tolerance_rad, tolerance, 1e-12);
      EXPECT_NEAR(tracking.final_time_s, 0.1, 1e-9);
      EXPECT_EQ(tracking.at_target, share < 1) << size;
      EXPECT_EQ(tracking.steps[1].settling_time_s.has_value(), share < 1) << size;
      RunLog none;
      const std::string text = SummaryText(tracking, Summarise(none, false), false);
      EXPECT_THAT(text, HasSubstr(size > 0.1 ? "(mean of the last 0.1 s; up to 0.0080 rad is at it)"
                                             : "(mean of the last 0.1 s; up to 0.0010 rad is at it)"));
      EXPECT_THAT(text, HasSubstr(std::string(share < 1 ? ", " : ", not ") +
                                  (size > 0.1 ? "within 2 %" : "within 0.0010 rad")));
    }
  }
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

// Tests that a linear arm is judged and shown in its own unit: 0.05 mm from its target it is there, 0.2 mm
// from it not, whether its position is in mm or in m; with --si in m.
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
    EXPECT_THAT(si, ::testing::HasSubstr("at its target 0.03 m: final error 0 m"));
    EXPECT_THAT(si, ::testing::Not(::testing::HasSubstr("deg")));
    EXPECT_THAT(SummaryJson(tracking, Summarise(log, false)),
                ::testing::HasSubstr("\"target_" + std::string(length) + "\": "));
  }
}

// Tests that what ended a run early stands first, and what was reached then, in the past tense of that end;
// and that a run which lasted as long as it should has no such line, whatever was sent after it.
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
  log.messages.Of<stop_t>().front().tick = -1;  // hydro-launch knows of no tick
  EXPECT_THAT(text(),
              StartsWith("the run was stopped after tick 500: launch: stopped by signal 2\n501 states"));
  EXPECT_THAT(InfoText(Summarise(log, false)),
              HasSubstr("\nstop: launch: stopped by signal 2 (exit code 0)\n"));
  EXPECT_THAT(SummaryJson(TrackArm(log), Summarise(log, false)), HasSubstr("\"tick\": null"));
  log.messages.Of<stop_t>().front().tick = 500;
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

// Tests that a reference which follows the arm, because the voltage is held at zero, is no target: neither at
// the end of a run nor in JSON. Tables without commands have none that could be held.
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

// Tests that an arm that was let go just before the end has no target yet: a hold that ended within the last
// 0.1 s counts, one that ended earlier does not.
TEST(TrackingTest, AHoldThatHasJustEnded) {
  RunLog log = MakeRun(
      500, [](double) { return 0.2; }, [](double) { return 0.2; });
  const auto held_until = [&](int64_t tick) {
    for (state_t& state : log.messages.Of<state_t>())
      state.command_tick = state.tick < 100 || state.tick >= tick ? state.tick : -1;
    return TrackArm(log).held;
  };
  EXPECT_TRUE(held_until(490));
  EXPECT_FALSE(held_until(390));
}

// Tests that the same holds where the pressure loop holds the voltage at zero by its safe commands and the
// position loop follows the arm; and that a safe command under a reference that goes its own way, as in
// lockstep, leaves the target what it is.
TEST(TrackingTest, SafeCommandsHoldToo) {
  const auto arm = [](double t) { return 0.1 + 0.01 * std::sin(20 * t); };
  for (const bool follows : {true, false}) {
    RunLog log = MakeRun(500, arm, [&](double t) { return follows ? arm(t) : 0.2; });
    for (state_t& state : log.messages.Of<state_t>()) state.command_tick = state.tick;
    motor_command_t command{};
    command.tick = 500;
    command.status = motor_command_t::SAFE;
    log.messages.Of<motor_command_t>().push_back(command);
    EXPECT_EQ(TrackArm(log).held, follows);
    EXPECT_EQ(TrackArm(log).at_target.has_value(), !follows);
    command.tick = 501;
    command.status = motor_command_t::STOPPED;
    log.messages.Of<motor_command_t>().push_back(command);
    EXPECT_EQ(TrackArm(log).held, follows) << "what ends a run ends no hold";
    log.messages.Of<motor_command_t>().back().status = motor_command_t::LAW;
    EXPECT_EQ(TrackArm(log).held, follows) << "it has just ended";
    log.messages.Of<motor_command_t>().front().tick = 300;
    EXPECT_FALSE(TrackArm(log).held);
  }
}

// Tests that a run which a fault ended right after a step is said to be on its way to a target, not to follow
// a reference that moves, and that its error there counts from the step.
TEST(TrackingTest, AStepJustBeforeTheEndIsATarget) {
  const auto still = [](double) { return 0.1; };
  RunLog log = MakeRun(500, still, [](double t) { return t < 0.48 ? 0.1 : 0.3; });
  const Tracking tracking = TrackArm(log);
  EXPECT_EQ(tracking.at_target, false);
  EXPECT_NEAR(tracking.final_error_rad, -0.2, 1e-12);
  EXPECT_THAT(SummaryText(tracking, Summarise(log, false), false),
              ::testing::HasSubstr("arm NOT at its target 0.3000 rad"));
  EXPECT_EQ(TrackArm(MakeRun(500, still, [](double t) { return t; })).at_target, std::nullopt)
      << "a ramp moves";
}

// Tests that skipped ticks are a share of those that went by, as in hydro-launch's table; and that a fault of
// a sender which knew of no tick is not put at tick -1.
TEST(TrackingTest, CountsOfTicks) {
  const auto still = [](double) { return 0.2; };
  RunLog log = MakeRun(400, still, still);
  std::vector<state_t>& states = log.messages.Of<state_t>();
  states.erase(states.begin() + 100, states.begin() + 200);
  states[100].skipped_ticks = 100;
  fault_t fault{};
  fault.tick = -1;
  fault.code = "stale_state";
  fault.source = "pressure_ctrl";
  fault.active = 1;
  log.messages.Of<fault_t>().push_back(fault);
  const LogInfo info = Summarise(log, false);
  const std::string text = SummaryText(TrackArm(log), info, false);
  EXPECT_THAT(text, ::testing::HasSubstr("301 states over 0.400 s of plant time, 100 ticks skipped"));
  EXPECT_THAT(text, ::testing::HasSubstr("\n100 of 400 ticks (25 %) were skipped"));
  EXPECT_THAT(text,
              ::testing::HasSubstr("\nfault before the first tick: stale_state began (pressure_ctrl)\n"));
  EXPECT_THAT(InfoText(info), ::testing::HasSubstr("\nstates: 301, from tick 0 at 0 s to tick 400 at 0.4 s"));
  EXPECT_THAT(InfoText(info), ::testing::HasSubstr("\nfault: pressure_ctrl: stale_state begins"));
  EXPECT_THAT(SummaryJson(TrackArm(log), info), ::testing::HasSubstr("\"states\": 301,\n  \"ticks\": 400,"));
}

tuned_settings_t Version(int64_t version, const std::string& changes, int64_t session = 7) {
  tuned_settings_t settings{};
  settings.session = session;
  settings.version = version;
  settings.acts_at = 1000 * version;
  settings.stage = tuned_settings_t::IN_FORCE;
  settings.source = "hydro-set";
  settings.changes = changes;
  return settings;
}

// Tests that each version is told by what it changed of the one before it, with values that came back; of a
// log that begins in the middle, the first by how it differs from the configuration; and two plants' versions
// apart.
TEST(TuningHistoryTest, WhatEachVersionChanged) {
  RunMessages run;
  std::vector<tuned_settings_t>& told = run.Of<tuned_settings_t>();
  told = {Version(0, ""),
          Version(1, "position.c1 = 1\nposition.c2 = 2\n"),
          Version(2, "position.c1 = 1\nposition.c2 = 3\n"),
          Version(2, "position.c1 = 1\nposition.c2 = 3\n"),
          Version(3, "position.c2 = 3\n"),
          Version(4, "")};
  const auto texts = [&] {
    std::vector<std::string> lines;
    for (const TuningStep& step : TuningSteps(run)) lines.push_back(DescribeTuning(step));
    return lines;
  };
  EXPECT_THAT(texts(), ::testing::ElementsAre(
                           "version 1 from tick 1000 on: position.c1 = 1, position.c2 = 2 (hydro-set)",
                           "version 2 from tick 2000 on: position.c2 = 3 (hydro-set)",
                           "version 3 from tick 3000 on: position.c1 as configured (hydro-set)",
                           "version 4 from tick 4000 on: position.c2 as configured (hydro-set)"));
  told.erase(told.begin(), told.begin() + 2);
  told.push_back(Version(0, "", 8));
  told.push_back(Version(5, "noise.p1 = 9\n", 8));
  EXPECT_THAT(texts(),
              ::testing::ElementsAre(
                  "version 2 from tick 2000 on, which differs from the configuration: position.c1 = 1, "
                  "position.c2 = 3 (hydro-set)",
                  ::testing::_, ::testing::_, "version 5 from tick 5000 on: noise.p1 = 9 (hydro-set)"));
  EXPECT_EQ(DescribeInForce(Version(3, "position.c2 = 3\n")),
            "version 3 since tick 3000 (hydro-set); differs from the configuration: position.c2 = 3");
  EXPECT_EQ(DescribeInForce(Version(0, "")), "version 0: as configured");
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
