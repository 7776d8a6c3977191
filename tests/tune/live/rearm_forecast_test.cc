// What is said before a re-arm, held against what the simulated arm then does: the real plant and loops on a
// simulated clock.
#include "tune/live/rearm_forecast.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <hydro/arm_plan_t.hpp>
#include <hydro/arm_reference_t.hpp>
#include <hydro/fault_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/tuning_request_t.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bus/in_process_bus.h"
#include "model/started_actuator.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "settings/stack_config.h"

namespace hydro::tuning {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr double kRate = 1000;     // Hz, of config/demo.toml
constexpr int64_t kTrips = 350;    // ticks: the arm is on its way to its first step
constexpr int64_t kIsWell = 700;   // the fault has ended, and is latched
constexpr int64_t kRearms = 1200;  // and is ended

class RearmForecastTest : public ::testing::Test {
 protected:
  // A run in which a loop reports a fault in mid-motion, and the plant is re-armed later; `forecast_` is of
  // that tick.
  void Run(std::vector<std::string> changes, double duration_s = 13.5) {
    changes.insert(changes.end(), {"time.mode=lockstep", "limits.rearm=explicit", "noise.arm_angle_rad=0"});
    settings::StackConfig config = settings::LoadStackConfig(HYDRO_TEST_CONFIG, changes);
    config.last_tick = std::llround(duration_s * kRate);
    bus::SimulatedClock clock;
    bus::InProcessBus bus(&clock);
    bus_ = &bus;
    Listen();
    plant::SimulatedRig rig(config);
    plant::PlantApp plant(bus, clock, config, rig);
    pressure_ctrl::PressureApp pressure(bus, clock, config);
    position_ctrl::PositionApp position(bus, clock, config);
    bus.Subscribe<state_t>("HYDRO_STATE", [&](const state_t&) {
      pressure.Poll();
      position.Poll();
    });
    plant.Run();
    while (bus.HandleUntil(clock.Now()) > 0) {
    }
    ASSERT_EQ(accepted_, 1);
  }

  void Listen() {
    bus_->Subscribe<state_t>("HYDRO_STATE", [this](const state_t& state) { OnState(state); });
    bus_->Subscribe<run_description_t>("HYDRO_RUN",
                                       [this](const run_description_t& run) { heard_.run = run; });
    bus_->Subscribe<tuned_settings_t>("HYDRO_SETTINGS", [this](const tuned_settings_t& settings) {
      if (settings.stage == tuned_settings_t::IN_FORCE) heard_.in_force = settings;
    });
    bus_->Subscribe<arm_plan_t>("HYDRO_ARM_PLAN", [this](const arm_plan_t& plan) { heard_.plan = plan; });
    bus_->Subscribe<arm_reference_t>("HYDRO_ARM_REFERENCE",
                                     [this](const arm_reference_t& r) { references_[r.tick] = r.value; });
    bus_->Subscribe<rearm_t>(
        "HYDRO_REARM", [this](const rearm_t& answer) { accepted_ += answer.kind == rearm_t::ACCEPTED; });
  }

  void OnState(const state_t& state) {
    angles_.push_back(state.arm_angle);
    pressures_.push_back(state.p2 - state.p1);
    if (state.tick > kRearms + 1 && state.command_tick < 0 && !ended_) ended_ = state.tick;
    if (state.tick == kTrips || state.tick == kIsWell) SayFault(state.tick == kTrips);
    if (const auto due = at_.find(state.tick); due != at_.end()) due->second(state);
    if (state.tick != kRearms) return;
    heard_.state = state;
    forecast_ = ForecastRearm(heard_);
    rearm_t request;
    request.tick = state.tick;
    request.session = 77;
    request.addressee = state.session;
    request.kind = rearm_t::REQUEST;
    bus_->Publish("HYDRO_REARM", request);
  }

  void SayFault(bool active) {
    fault_t fault;
    fault.session = 55;
    fault.source = "pressure_ctrl";
    fault.code = "nonfinite_state";
    fault.active = active;
    bus_->Publish("HYDRO_FAULT", fault);
  }

  // The published reference at a time after the re-arm.
  double ReferenceAfter(double seconds) const {
    return std::prev(references_.upper_bound(kRearms + std::llround(seconds * kRate)))->second;
  }
  double PressureAfter(double seconds) const {
    return pressures_.at(kRearms + std::llround(seconds * kRate));
  }
  double ArmAfter(double seconds) const { return angles_.at(kRearms + std::llround(seconds * kRate)); }

  // The fastest that the reference changes between two samples on its way back, unless it jumps there.
  double FastestReference() const {
    double fastest = 0;
    for (auto next = references_.upper_bound(kRearms + 5), last = next++; next != references_.end();
         last = next++) {
      if (next->first > kRearms + std::llround(forecast_.return_s * kRate)) break;
      const double rate =
          std::fabs(next->second - last->second) * kRate / static_cast<double>(next->first - last->first);
      if (rate < 20 * forecast_.top_rate) fastest = std::max(fastest, rate);
    }
    return fastest;
  }

  // Everything that the forecast says of the reference came true.
  void ExpectTrue() const {
    ASSERT_TRUE(forecast_.known) << forecast_.text;
    // It is sampled every 5 ms, and acts from the next tick on.
    const double slack = 0.01 * std::max(0.01, forecast_.top_rate);
    EXPECT_NEAR(ReferenceAfter(forecast_.return_s + 0.006), forecast_.target, slack);
    EXPECT_NEAR(FastestReference(), forecast_.top_rate, 0.02 * forecast_.top_rate);
    double lowest = INFINITY, highest = -INFINITY;
    for (const auto& [tick, value] : references_) {
      const double after = static_cast<double>(tick - kRearms) / kRate - forecast_.return_s;
      if (after < 0.006 || after > kForecast_s) continue;
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
    EXPECT_NEAR(lowest, forecast_.lowest, slack);
    EXPECT_NEAR(highest, forecast_.highest, slack);
    EXPECT_NEAR(ReferenceAfter(forecast_.return_s + kForecast_s), forecast_.last, slack);
    for (const ReferenceTurn& turn : forecast_.turns) {
      double least = INFINITY;
      for (const auto& [tick, value] : references_) {
        const double after = static_cast<double>(tick - kRearms) / kRate;
        if (after > 0 && after <= forecast_.return_s) least = std::min(least, std::fabs(value - turn.at));
      }
      EXPECT_LT(least, 0.006 * forecast_.top_rate + slack);
    }
    for (const ReferenceStep& step : forecast_.steps)
      EXPECT_NEAR(ReferenceAfter(step.after_s + 0.006) - ReferenceAfter(step.after_s - 0.006), step.by,
                  0.012 * forecast_.top_rate + slack);
  }

  // What was said of the machine came true: it ends at that limit at that time, or it is where it was said to
  // be. `slack` is that of the quantity.
  void ExpectTheMachineDoes(double slack) const {
    const RearmMotion& motion = forecast_.motion;
    ASSERT_EQ(motion.unforeseen, "");
    const double at = motion.seconds,
                 quantity = forecast_.quantity == "arm_angle" ? ArmAfter(at) : PressureAfter(at);
    EXPECT_EQ(ended_.has_value(), !motion.ended_by.empty()) << forecast_.text;
    if (ended_) {
      EXPECT_NEAR(static_cast<double>(*ended_ - kRearms) / kRate, at, 0.01) << forecast_.text;
    } else {
      EXPECT_NEAR(motion.reaches, quantity, slack) << forecast_.text;
      EXPECT_NEAR(at, forecast_.return_s + kForecast_s, 1e-9);
    }
  }

  bus::InProcessBus* bus_ = nullptr;
  std::map<int64_t, std::function<void(const state_t&)>> at_;
  HeardOfStack heard_;
  RearmForecast forecast_;
  int accepted_ = 0;
  std::vector<double> angles_, pressures_;  // by tick
  std::optional<int64_t> ended_;            // at zero volts again since this tick
  std::map<int64_t, double> references_;
};

// Tests a step that was half done when the fault came: the arm goes to where the step leads, not to where the
// published reference stands while it follows the arm.
TEST_F(RearmForecastTest, AStepInMidMotion) {
  Run({"reference.steps=[[0.2, 0.3]]"});
  ExpectTrue();
  EXPECT_EQ(forecast_.target, 0.3);
  EXPECT_EQ(forecast_.return_s, 0.5);
  EXPECT_LT(forecast_.present, 0.2);
  EXPECT_NEAR(forecast_.present, ReferenceAfter(-0.01), 2e-3) << "what the page used to tell from";
  EXPECT_FALSE(forecast_.jumps);
  const double way = forecast_.target - forecast_.present;
  EXPECT_NEAR(forecast_.top_rate, way / 0.5, 1e-9);
  EXPECT_NEAR(ArmAfter(3) - ArmAfter(0), way, 0.02 * way) << "the arm goes that way";
  EXPECT_GT(ArmAfter(0.5) - ArmAfter(0), 0.5 * way) << "about as fast";
  EXPECT_THAT(forecast_.text, StartsWith("the arm is at "));
  EXPECT_THAT(forecast_.text, HasSubstr("; its reference comes back to 0.3 rad: the reference moves by +"));
  EXPECT_THAT(forecast_.text, HasSubstr(" in 0.5 s, at up to "));
}

// Tests that the other direction, another time and a later step are told.
TEST_F(RearmForecastTest, BackwardsAndALaterStep) {
  Run({"reference.steps=[[0.2, 0.3], [0.9, -0.3], [6, 0.1]]", "limits.return_s=1.5"});
  ExpectTrue();
  EXPECT_EQ(forecast_.target, -0.3);
  EXPECT_EQ(forecast_.highest, 0.1);
  EXPECT_NEAR(ArmAfter(4.5), -0.3, 0.01);
  EXPECT_THAT(forecast_.text, HasSubstr("the reference moves by -"));
  EXPECT_THAT(forecast_.text, HasSubstr("in the 10 s after that it goes from -0.3 rad to 0.1 rad;"));
}

// Tests that a way down is told as one, from its beginning to its end.
TEST_F(RearmForecastTest, DownAfterwards) {
  Run({"reference.steps=[[0.2, 0.3], [4, 0.2], [6, -0.1]]"});
  ExpectTrue();
  EXPECT_TRUE(forecast_.one_way);
  EXPECT_THAT(forecast_.text, HasSubstr("in the 10 s after that it goes from 0.3 rad to -0.1 rad;"));
}

// Tests that a pulse between two samples of the forecast is seen, and that it is no way.
TEST_F(RearmForecastTest, APulseAfterwards) {
  Run({"reference.steps=[[0.2, 0.3], [4.002, 0.4], [4.012, 0.2], [4.02, 0.3]]"});
  ExpectTrue();
  EXPECT_THAT(forecast_.text, HasSubstr("in the 10 s after that it is between 0.2 rad and 0.4 rad;"));
}

// Tests a torque limit that binds: the arm's load holds it far from where its reference goes. The forecast
// promises the reference alone, which comes true, and names the limit.
TEST_F(RearmForecastTest, ALimitThatBinds) {
  Run({"reference.steps=[[0.2, 0.3]]", "limits.arm_torque=1"});
  ExpectTrue();
  const double way = forecast_.target - forecast_.present;
  EXPECT_LT(std::fabs(ArmAfter(3) - ArmAfter(0)), 0.5 * std::fabs(way)) << "the arm does not go that way";
  ExpectTheMachineDoes(2e-3);
  EXPECT_THAT(forecast_.text,
              HasSubstr("; by its model no limit ends that within 10.5 s, after which the arm is at "));
  EXPECT_THAT(forecast_.text, HasSubstr(" rad, held back by limits.arm_torque 1 in-lbf"));
}

// Tests a speed limit that the way back exceeds: the arm is stopped on it, at zero volts, as the forecast
// says.
TEST_F(RearmForecastTest, ALimitThatStopsAgain) {
  Run({"reference.steps=[[0.2, 0.3]]", "limits.return_s=0.02", "limits.motor_speed=20"});
  ASSERT_TRUE(forecast_.known);
  EXPECT_GT(std::fabs(ArmAfter(3) - forecast_.target), 0.02) << "the arm does not get there";
  ExpectTheMachineDoes(0);
  EXPECT_EQ(forecast_.motion.ended_by, "limits.motor_speed 20 rad/s");
  EXPECT_THAT(forecast_.text, HasSubstr("; by its model the machine is at zero volts again after 0.0"));
  EXPECT_THAT(forecast_.text, HasSubstr(" s, beyond limits.motor_speed 20 rad/s, when the arm is at "));
}

// Tests references that move all the time, and one that jumps on the way back.
TEST_F(RearmForecastTest, ReferencesThatMove) {
  Run(
      {"reference={signal = \"arm_angle\", kind = \"sine\", amplitude = 0.2, frequency_hz = 0.3, offset = "
       "0.05}"});
  ExpectTrue();
  EXPECT_NEAR(forecast_.highest, 0.25, 1e-3);
  EXPECT_FALSE(forecast_.one_way);
  EXPECT_THAT(forecast_.text, HasSubstr("in the 10 s after that it is between -0.15 rad and 0.25 rad;"));
}

TEST_F(RearmForecastTest, AJumpOnTheWay) {
  Run({"reference.steps=[[0.2, 0.3], [1.5, -0.1]]"});
  ExpectTrue();
  EXPECT_TRUE(forecast_.jumps);
  EXPECT_EQ(forecast_.target, -0.1);
  ASSERT_EQ(forecast_.steps.size(), 1u);
  EXPECT_NEAR(forecast_.steps[0].after_s, 0.3, 1e-3);
  EXPECT_NEAR(forecast_.steps[0].by, -0.6 * 0.4, 1e-3)
      << "six tenths of the way from the arm to the reference";
  EXPECT_THAT(forecast_.text,
              HasSubstr(" rad (the other direction) after 0.3 s, and jumps by -0.24 rad after 0.3 s"));
}

// Tests steps at the very ends of the way back, and several on it.
TEST_F(RearmForecastTest, JumpsOnTheWay) {
  Run({"reference.steps=[[0.2, 0.3], [1.3, 0.1], [1.5, 0.2], [1.7, -0.1]]"});
  ExpectTrue();
  EXPECT_EQ(forecast_.steps.size(), 3u);
  EXPECT_THAT(forecast_.text, HasSubstr(" after 0.1 s and 2 more times"));
  EXPECT_EQ(forecast_.target, -0.1);
}

// Tests a way back that leads the other way before it leads where it ends, and one that leads beyond that:
// the net move alone would tell neither.
TEST_F(RearmForecastTest, TheOtherWayFirst) {
  Run({"reference.steps=[[0.2, 0.3], [1.21, -0.3], [1.6, 0.3]]"});
  ExpectTrue();
  ASSERT_EQ(forecast_.turns.size(), 1u);
  EXPECT_NEAR(forecast_.turns[0].after_s, 0.4, 2e-3);
  EXPECT_NEAR(forecast_.turns[0].at, forecast_.present + 0.8 * (-0.3 - forecast_.present), 2e-3);
  EXPECT_LT(ArmAfter(0.4), ArmAfter(0) - 0.05) << "the arm goes that way, too";
  EXPECT_THAT(forecast_.text, HasSubstr("the reference moves by +"));
  EXPECT_THAT(forecast_.text, HasSubstr(", by way of -"));
  EXPECT_THAT(forecast_.text, HasSubstr(" rad (the other direction) after 0.4 s"));
}

TEST_F(RearmForecastTest, BeyondItsEnd) {
  Run({"reference.steps=[[0.2, 0.3], [1.6, 0.1]]"});
  ExpectTrue();
  ASSERT_EQ(forecast_.turns.size(), 1u);
  EXPECT_GT(forecast_.turns[0].at, std::max(forecast_.present, forecast_.target));
}

// Tests an arm that moves when it is asked: the direction in which it goes on is told where it is not that of
// the reference.
TEST(RearmForecast, AnArmThatMoves) {
  const settings::StackConfig config =
      settings::LoadStackConfig(HYDRO_TEST_CONFIG, {"reference.steps=[[0.1, 0.3]]"});
  HeardOfStack heard;
  heard.state.emplace();
  heard.state->command_tick = -1;
  heard.state->time = 2;
  heard.run.emplace();
  heard.run->rate_hz = kRate;
  heard.run->config_text = config.text;
  heard.run->model_text = config.model.text;
  for (const double speed : {-0.5, 0.5, -0.01, 0.0, double{NAN}}) {
    heard.state->arm_speed = speed;
    const RearmForecast forecast = ForecastRearm(heard);
    EXPECT_NEAR(forecast.target, 0.3, 1e-9);
    if (speed == -0.5) {
      EXPECT_THAT(
          forecast.text,
          StartsWith(
              "the arm is at 0 rad and moves at -0.5 rad/s, the other way, in which it goes on at first; "));
    } else {
      EXPECT_THAT(forecast.text, StartsWith("the arm is at 0 rad; "));
    }
  }
}

// Tests that a way back that no sensor shows is called none, and that a position that differs from zero by
// rounding is zero; and that the smallest way that a sensor does show is said.
TEST(RearmForecast, NoMove) {
  for (const double target : {0.0, 0.3}) {
    const settings::StackConfig config = settings::LoadStackConfig(
        HYDRO_TEST_CONFIG, {"reference.steps=[[0.1, " + std::to_string(target) + "]]"});
    HeardOfStack heard;
    heard.state.emplace();
    heard.state->command_tick = -1;
    heard.state->time = 2;
    heard.state->arm_speed = 1e-8;
    heard.run.emplace();
    heard.run->rate_hz = kRate;
    heard.run->config_text = config.text;
    heard.run->model_text = config.model.text;
    heard.state->arm_angle = target - 2.98e-9;
    const std::string at = target == 0 ? "0 rad" : "0.3 rad";
    EXPECT_THAT(ForecastRearm(heard).text,
                StartsWith("the arm is at " + at + "; its reference comes back to " + at +
                           ": the reference does not move; by its model no limit ends that within 10.5 s, "));
    EXPECT_FALSE(ForecastRearm(heard).jumps);
    heard.state->arm_angle = target - 1e-5;
    EXPECT_THAT(ForecastRearm(heard).text, HasSubstr("the reference moves by +1e-05 rad in 0.5 s"));
  }
}

// Tests that nothing is called slow that is not.
TEST_F(RearmForecastTest, AtOnce) {
  Run({"reference.steps=[[0.2, 0.3]]", "limits.return_s=0"});
  ASSERT_TRUE(forecast_.known);
  EXPECT_NEAR(ReferenceAfter(0.006), 0.3, 1e-12);
  EXPECT_EQ(forecast_.target, 0.3);
  EXPECT_TRUE(forecast_.jumps);
  EXPECT_THAT(forecast_.text, HasSubstr(" rad at once"));
}

// Tests that a reference that was changed while the stack runs counts, from the tick at which it began.
TEST_F(RearmForecastTest, AReferenceSetMeanwhile) {
  at_[800] = [this](const state_t& state) {
    tuning_request_t request;
    request.tick = state.tick;
    request.session = 78;
    request.request = 1;
    request.addressee = state.session;
    request.kind = tuning_request_t::SET;
    request.changes = "reference.steps=[[0.1, -0.05], [3, 0.2]]";
    bus_->Publish("HYDRO_TUNING_REQUEST", request);
  };
  Run({"reference.steps=[[0.2, 0.3]]"});
  ASSERT_EQ(heard_.in_force->version, 1);
  ExpectTrue();
  EXPECT_EQ(forecast_.target, -0.05);
  EXPECT_EQ(forecast_.highest, 0.2);
}

// Tests a planner: the reference comes back to where its newest plan ends, or, where it has fallen silent in
// the middle of that, to where it was followed last.
TEST_F(RearmForecastTest, APlan) {
  for (const bool silent : {false, true}) {
    at_[100] = [&, this](const state_t& state) {
      arm_plan_t plan{};
      plan.tick = state.tick;
      plan.session = 5;
      plan.count = 2;
      plan.time = {0, 0.6};
      plan.arm_angle = {0, 0.15};
      plan.arm_speed = {0, 0};
      plan.torque = {0, 0};
      bus_->Publish("HYDRO_ARM_PLAN", plan);
    };
    heard_ = {};
    accepted_ = 0;
    angles_.clear();
    references_.clear();
    Run({std::string("reference={signal = \"arm_angle\", kind = \"planner\", timeout_s = ") +
         (silent ? "0.2" : "30.0") + "}"},
        3);
    ASSERT_TRUE(forecast_.known) << forecast_.text;
    if (silent) {
      EXPECT_GT(forecast_.target, 0.04);
      EXPECT_LT(forecast_.target, 0.11);
    } else {
      EXPECT_EQ(forecast_.target, 0.15);
    }
    EXPECT_NEAR(ReferenceAfter(0.51), forecast_.target, silent ? 2e-3 : 1e-9);
    EXPECT_NEAR(ArmAfter(1.5), forecast_.target, 5e-3);
    EXPECT_THAT(forecast_.text, HasSubstr(" rad (by the newest plan)"));
  }
}

// Tests a reference that is no angle: its return, and where the arm runs by it.
TEST_F(RearmForecastTest, APressure) {
  Run({"reference={signal = \"pressure\", kind = \"steps\", steps = [[0.2, 60.0]]}", "noise.p1_psi=0",
       "noise.p2_psi=0"},
      3);
  ASSERT_TRUE(forecast_.known) << forecast_.text;
  EXPECT_EQ(forecast_.quantity, "pressure");
  EXPECT_EQ(forecast_.target, 60);
  EXPECT_NEAR(forecast_.present, pressures_.at(kRearms), 1e-9);
  EXPECT_NEAR(ReferenceAfter(0.51), 60, 1e-9);
  ExpectTheMachineDoes(0);
  EXPECT_THAT(forecast_.motion.ended_by, StartsWith("limits.arm_angle 0.8"));
  EXPECT_THAT(forecast_.text, HasSubstr(" s, beyond limits.arm_angle 0.8"));
}

// Tests a pressure, and a torque, that a limit lets through in part only: that limit is named beside where
// the reference comes back to, and where the machine comes to is what it lets through.
TEST_F(RearmForecastTest, APressureThatALimitHoldsBack) {
  Run({"reference={signal = \"pressure\", kind = \"steps\", steps = [[0.2, 400.0]]}", "model.shaft=clamped",
       "noise.p1_psi=0", "noise.p2_psi=0"});
  ExpectTheMachineDoes(0.5);
  EXPECT_NEAR(forecast_.motion.reaches, 500 / 3.68, 10) << "friction of the pump stays";
  EXPECT_EQ(forecast_.motion.held_by, "limits.arm_torque 500 in-lbf");
  EXPECT_THAT(
      forecast_.text,
      HasSubstr(
          "; its reference comes back to 400 psi (limits.arm_torque 500 in-lbf lets through 135.9 psi): "
          "the reference moves by +"));
  EXPECT_THAT(forecast_.text,
              HasSubstr("; by its model no limit ends that within 10.5 s, after which the pressure "
                        "p2 - p1 is at 1"));
  EXPECT_THAT(forecast_.text, HasSubstr(" psi, held back by limits.arm_torque 500 in-lbf"));
}

TEST_F(RearmForecastTest, ATorqueThatALimitHoldsBack) {
  Run({"reference={signal = \"torque\", kind = \"steps\", steps = [[0.2, 200.0], [4, -300.0]]}",
       "model.shaft=clamped", "limits.arm_torque=250", "noise.p1_psi=0", "noise.p2_psi=0"});
  EXPECT_THAT(forecast_.text,
              HasSubstr("; its reference comes back to 200 in-lbf: the reference moves by +"));
  EXPECT_THAT(forecast_.text, HasSubstr("; limits.arm_torque 250 in-lbf lets through 250 in-lbf of that; "));
  EXPECT_EQ(forecast_.motion.held_by, "limits.arm_torque 250 in-lbf");
}

// Tests that a pressure beyond the limit of the sides is foreseen to end there.
TEST_F(RearmForecastTest, APressureThatEndsAtItsLimit) {
  Run({"reference={signal = \"pressure\", kind = \"steps\", steps = [[0.2, 20.0], [1, 130.0]]}",
       "model.shaft=clamped", "limits.pressure=150", "noise.p1_psi=0", "noise.p2_psi=0"});
  ExpectTheMachineDoes(0);
  EXPECT_EQ(forecast_.motion.ended_by, "limits.pressure 150 psi");
}

// Tests a voltage, which nothing but the machine answers.
TEST_F(RearmForecastTest, AVoltage) {
  Run({"reference={signal = \"voltage\", kind = \"steps\", steps = [[0.2, 2.5]]}", "limits.motor_speed=70"});
  ASSERT_TRUE(forecast_.known) << forecast_.text;
  const RearmMotion& motion = forecast_.motion;
  EXPECT_EQ(ended_.has_value(), !motion.ended_by.empty()) << forecast_.text;
  if (ended_) {
    EXPECT_NEAR(static_cast<double>(*ended_ - kRearms) / kRate, motion.seconds, 0.01);
  }
}

// Tests an arm that moves as it is re-armed, and that moves on while the plant skips ticks: it may pass its
// limit on that way alone.
TEST(RearmForecast, SkippedTicks) {
  settings::StackConfig config =
      settings::LoadStackConfig(HYDRO_TEST_CONFIG, {"reference.steps=[[0.1, 0.3]]"});
  const model::Parameters& p = config.model.description.parameters;
  HeardOfStack heard;
  heard.state.emplace();
  heard.state->command_tick = -1;
  heard.state->time = 2;
  heard.state->tick = 2000;
  heard.state->arm_angle = 0.3;
  heard.state->arm_speed = 0.5;
  heard.state->motor_speed = 0.5 * p.c / p.D;
  heard.state->p1 = heard.state->p2 = p.p_3;
  constexpr int kSkipped = 300;
  model::StartedActuator coasts(config.model.description, {},
                                model::StartOf({.motor_speed = heard.state->motor_speed,
                                                .arm_angle = 0.3,
                                                .arm_speed = 0.5,
                                                .p1 = p.p_3,
                                                .p2 = p.p_3},
                                               model::Shaft::kFree),
                                0);
  coasts.Advance(0, kSkipped / kRate);
  const double limit = 0.3 + 0.95 * (coasts.Measure().arm_angle - 0.3);
  config = settings::Changed(config, {"limits.arm_angle=" + std::to_string(limit)});
  heard.run.emplace();
  heard.run->rate_hz = kRate;
  heard.run->config_text = config.text;
  heard.run->model_text = config.model.text;
  const RearmMotion at_once = ForecastRearm(heard).motion;
  EXPECT_EQ(at_once.unforeseen, "");
  EXPECT_EQ(at_once.ended_by, "");
  EXPECT_NEAR(at_once.reaches, 0.3, 5e-3);
  heard.state->skipped_ticks = kSkipped;
  EXPECT_THAT(ForecastRearm(heard).motion.ended_by, StartsWith("limits.arm_angle 0."));
}

// Tests that what cannot be known is said instead of a number.
TEST(RearmForecast, Unknown) {
  const settings::StackConfig config = settings::LoadStackConfig(HYDRO_TEST_CONFIG);
  HeardOfStack heard;
  EXPECT_THAT(ForecastRearm(heard).text, HasSubstr("no state is heard"));
  heard.state.emplace();
  heard.state->command_tick = -1;
  EXPECT_THAT(ForecastRearm(heard).text, HasSubstr("has not described itself"));
  heard.run.emplace();
  heard.run->rate_hz = kRate;
  heard.run->config_text = config.text;
  heard.run->config_file = "demo.toml";
  heard.run->model_text = config.model.text;
  heard.run->model_file = "table1.toml";
  EXPECT_TRUE(ForecastRearm(heard).known);
  HeardOfStack unmeasured = heard;
  unmeasured.state->motor_speed = NAN;
  EXPECT_THAT(
      ForecastRearm(unmeasured).text,
      HasSubstr("; what the machine will do cannot be foreseen, because the motor's speed is not measured; "
                "limits.arm_torque 500 in-lbf may hold it back; zero volts again beyond limits.pressure "
                "2000 psi, limits.arm_angle 0.8"));
  heard.state->arm_angle = NAN;
  EXPECT_THAT(ForecastRearm(heard).text, HasSubstr("the arm is not measured"));
  heard.state->arm_angle = 0.1;
  heard.state->command_tick = 4;
  EXPECT_THAT(ForecastRearm(heard).text, HasSubstr("nothing holds the voltage at zero"));
  heard.state->command_tick = -1;
  HeardOfStack own = heard;
  own.run->config_text += "\n[[process]]\ncommand = [\"./pid.py\"]\nrole = \"position_ctrl\"\n";
  const std::string ours = "[[process]]\nprogram = \"hydro-position-ctrl\"\n";
  if (const size_t at = own.run->config_text.find(ours); at != std::string::npos)
    own.run->config_text.erase(at, ours.size());
  EXPECT_THAT(ForecastRearm(own).text, HasSubstr("a program of your own, ./pid.py"));
  own.run->config_text = "[nonsense";
  EXPECT_FALSE(ForecastRearm(own).known);
}

// Tests that the figures are in the units of the model.
TEST(RearmForecast, Units) {
  const settings::StackConfig config =
      settings::LoadStackConfig(HYDRO_SI_CONFIG, {"reference.signal=pressure"});
  HeardOfStack heard;
  heard.state.emplace();
  heard.state->command_tick = -1;
  heard.run.emplace();
  heard.run->config_text = config.text;
  heard.run->model_text = config.model.text;
  EXPECT_EQ(ForecastRearm(heard).unit, "Pa");
}

}  // namespace
}  // namespace hydro::tuning
