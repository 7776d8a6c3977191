// The whole path of a change, from the request to the loops, with the real plant and controllers on a
// simulated clock.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <hydro/arm_reference_t.hpp>
#include <hydro/fault_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/rearm_t.hpp>
#include <hydro/stop_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <hydro/tuning_answer_t.hpp>
#include <hydro/tuning_request_t.hpp>
#include <hydro/tuning_status_t.hpp>
#include <map>
#include <vector>

#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "tests/settings/texts.h"
#include "tune/live/change_check.h"

namespace hydro::tuning {
namespace {

using ::testing::HasSubstr;

class LiveTuningTest : public ::testing::Test {
 protected:
  void Listen() {
    bus_->Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
      states_.push_back(s);
      const auto due = at_.find(s.tick);
      if (due != at_.end()) due->second();
    });
    bus_->Subscribe<motor_command_t>("HYDRO_MOTOR_COMMAND",
                                     [this](const motor_command_t& c) { commands_.push_back(c); });
    bus_->Subscribe<pressure_command_t>("HYDRO_PRESSURE_COMMAND",
                                        [this](const pressure_command_t& c) { pressures_.push_back(c); });
    bus_->Subscribe<arm_reference_t>("HYDRO_ARM_REFERENCE",
                                     [this](const arm_reference_t& r) { references_.push_back(r); });
    bus_->Subscribe<tuning_answer_t>("HYDRO_TUNING_ANSWER",
                                     [this](const tuning_answer_t& a) { answers_.push_back(a); });
    bus_->Subscribe<tuned_settings_t>("HYDRO_SETTINGS",
                                      [this](const tuned_settings_t& s) { settings_.push_back(s); });
  }

  // From `config_`, for `duration_s`.
  int Run(double duration_s) {
    bus::SimulatedClock clock;
    bus_ = std::make_unique<bus::InProcessBus>(&clock);
    states_.clear();
    commands_.clear();
    Listen();
    if (listen_) listen_();
    settings::StackConfig config = settings::Changed(settings::Parsed(config_), {"time.mode=lockstep"});
    config.last_tick = std::llround(duration_s * config.plant.rate_hz);
    plant::SimulatedRig rig(config);
    plant::PlantApp plant(*bus_, clock, config, rig);
    pressure_ctrl::PressureApp pressure(*bus_, clock, config);
    position_ctrl::PositionApp position(*bus_, clock, config);
    bus_->Subscribe<state_t>("HYDRO_STATE", [&](const state_t&) {
      pressure.Poll();
      position.Poll();
    });
    if (!follow_.empty()) plant.FollowTuning(follow_);
    const int exit_code = plant.Run();
    while (bus_->HandleUntil(clock.Now()) > 0) {
    }
    return exit_code;
  }

  void Ask(int64_t number, const std::string& changes, int8_t kind = tuning_request_t::SET) {
    tuning_request_t request;
    request.tick = states_.back().tick;
    request.session = 77;
    request.request = number;
    request.addressee = states_.back().session;
    request.kind = kind;
    request.source = "a test";
    request.changes = changes;
    bus_->Publish("HYDRO_TUNING_REQUEST", request);
  }

  const tuning_answer_t* AnswerTo(int64_t number) const {
    for (const tuning_answer_t& answer : answers_) {
      if (answer.request == number) return &answer;
    }
    return nullptr;
  }

  void SayAsPositionLoop(int64_t ready_for, int64_t refused, const std::string& text) {
    tuning_status_t status;
    status.session = 55;
    status.role = "position_ctrl";
    status.plant = states_.back().session;
    status.in_force = 0;
    status.since = -1;
    status.ready_for = ready_for;
    status.refused = refused;
    status.text = text;
    bus_->Publish("HYDRO_TUNING_STATUS", status);
  }

  void ExpectNothingDecided() const {
    for (const tuned_settings_t& s : settings_) {
      EXPECT_NE(s.stage, tuned_settings_t::DECIDED) << s.version;
      EXPECT_TRUE(s.stage != tuned_settings_t::IN_FORCE || s.version == 0) << s.version;
    }
  }

  template <class Message>
  static const Message& AtTick(const std::vector<Message>& messages, int64_t tick) {
    for (const Message& message : messages) {
      if (message.tick == tick) return message;
    }
    throw std::runtime_error("no message of tick " + std::to_string(tick));
  }

  std::string config_ = settings::Replaced(settings::kConfigText, "rate_hz = 1000", "rate_hz = 5000");
  std::unique_ptr<bus::InProcessBus> bus_;
  std::map<int64_t, std::function<void()>> at_;  // by tick
  std::vector<tuned_settings_t> follow_;
  std::function<void()> listen_;  // besides
  std::vector<state_t> states_;
  std::vector<motor_command_t> commands_;
  std::vector<pressure_command_t> pressures_;
  std::vector<arm_reference_t> references_;
  std::vector<tuning_answer_t> answers_;
  std::vector<tuned_settings_t> settings_;
};

// Tests that both loops act by a change from the tick that the answer names, and by nothing of it before.
TEST_F(LiveTuningTest, TakesEffectOnOneTickInBothLoops) {
  config_ += "[limits]\ntransfer_s = 0\n";
  at_[750] = [&] { Ask(1, "position.c2=500\npressure.natural_frequency_rad_s=130"); };
  ASSERT_EQ(Run(0.4), 0);
  const tuning_answer_t* answer = AnswerTo(1);
  ASSERT_NE(answer, nullptr);
  ASSERT_TRUE(answer->accepted) << answer->text;
  EXPECT_EQ(answer->version, 1);
  EXPECT_EQ(answer->acts_at % 25, 0) << "a tick of both loops";
  EXPECT_GT(answer->acts_at, 750);
  EXPECT_THAT(answer->text, HasSubstr("position.c2 = 500"));
  EXPECT_THAT(answer->text, HasSubstr("gain margin"));

  // The laws computed here from the states must give the commands, with the old gains before and the new ones
  // from then on.
  const settings::StackConfig before = settings::Parsed(config_);
  const settings::StackConfig after =
      settings::Changed(before, {"position.c2=500", "pressure.natural_frequency_rad_s=130"});
  const TunedValues old_values = ValuesOf(before), new_values = ValuesOf(after);
  int compared = 0;
  for (const motor_command_t& command : commands_) {
    if (command.status != motor_command_t::LAW || command.tick < 10) continue;
    const state_t& state = AtTick(states_, command.tick);
    const auto& law = command.tick < answer->acts_at ? old_values.pressure : new_values.pressure;
    const auto output = pressure_ctrl::PressureLaw(
        law, {command.pressure_ref, state.p1, state.p2, state.motor_speed, state.arm_speed});
    EXPECT_EQ(output.voltage, command.voltage) << command.tick;
    ++compared;
  }
  EXPECT_GT(compared, 1900);
  double previous_angle = NAN;
  for (const pressure_command_t& command : pressures_) {
    const double angle = AtTick(states_, command.tick).arm_angle;
    if (std::isfinite(previous_angle)) {
      const auto& law = command.tick < answer->acts_at ? old_values.position : new_values.position;
      const double error = angle - AtTick(references_, command.tick).value;
      EXPECT_DOUBLE_EQ(-law.c1 * error - law.c2 / law.sample_interval * (angle - previous_angle),
                       command.pressure_ref)
          << command.tick;
    }
    previous_angle = angle;
  }
}

// Tests that hydro-set's "would be unstable" and its acceptance come true: with gains beyond the edge the
// simulated arm swings on about its reference, with gains well within it comes to rest.
TEST_F(LiveTuningTest, WhatWouldBeUnstableSwings) {
  const settings::StackConfig configured = settings::Parsed(config_);
  const auto accepted = [&](double c1) {
    return PrepareChange(configured, configured, {"position.c1=" + std::to_string(c1)}, {}).config != nullptr;
  };
  double refused = 1000;
  while (accepted(refused)) refused *= 1.05;
  const std::string text = config_;
  const auto swing = [&](double c1) {
    config_ = settings::Replaced(text, "c1 = 10500", "c1 = " + std::to_string(c1));
    EXPECT_EQ(Run(3), 0);
    double least = INFINITY, most = -INFINITY;
    for (const state_t& state : states_) {
      if (state.time < 2) continue;
      least = std::min(least, state.arm_angle);
      most = std::max(most, state.arm_angle);
    }
    return most - least;
  };
  EXPECT_LT(swing(refused / 2), 1e-3);
  // The edge is that of the worst case, one side that compresses and the arm at its end, which the text
  // names. At mid-stroke, with friction, it takes some three times that.
  EXPECT_GT(swing(refused * 4), 1e-2);
}

// Tests that the commands do not jump at a change of gains, though the arm is far from its reference and
// moves.
TEST_F(LiveTuningTest, TheCommandsDoNotJump) {
  at_[650] = [&] { Ask(1, "position.c1=5000\nposition.c2=250\npressure.natural_frequency_rad_s=120"); };
  ASSERT_EQ(Run(0.5), 0);
  const tuning_answer_t* answer = AnswerTo(1);
  ASSERT_NE(answer, nullptr);
  ASSERT_TRUE(answer->accepted) << answer->text;
  const int64_t at = answer->acts_at;
  ASSERT_GT(at, 650);
  ASSERT_LT(at, 1250);
  const auto jump = [&](int64_t tick) {
    return std::fabs(AtTick(commands_, tick).voltage - AtTick(commands_, tick - 1).voltage);
  };
  const auto pressure_jump = [&](int64_t tick) {
    return std::fabs(AtTick(pressures_, tick).pressure_ref - AtTick(pressures_, tick - 25).pressure_ref);
  };
  double largest = 0, largest_pressure = 0;
  for (int64_t tick = at - 100; tick <= at + 100; ++tick) {
    if (tick != at && tick != at + 1) largest = std::max(largest, jump(tick));
    if (tick % 25 == 0 && tick != at) largest_pressure = std::max(largest_pressure, pressure_jump(tick));
  }
  EXPECT_LE(jump(at), largest);
  EXPECT_LE(jump(at + 1), largest) << "the new pressure acts from here on";
  EXPECT_LE(pressure_jump(at), largest_pressure);
  // Without the transfer both would have jumped: the new laws alone give something else here.
  const settings::StackConfig after =
      settings::Changed(settings::Parsed(config_),
                        {"position.c1=5000", "position.c2=250", "pressure.natural_frequency_rad_s=120"});
  const state_t& state = AtTick(states_, at);
  const auto& command = AtTick(commands_, at);
  const double alone = pressure_ctrl::UnlimitedPressureLaw(
      ValuesOf(after).pressure,
      {command.pressure_ref, state.p1, state.p2, state.motor_speed, state.arm_speed});
  EXPECT_GT(std::fabs(alone - command.voltage), 3 * largest);
  // And it passes: from 0.1 s after the change on the law is the new one alone.
  const state_t& later = AtTick(states_, at + 750);
  const auto& later_command = AtTick(commands_, at + 750);
  EXPECT_EQ(later_command.voltage, pressure_ctrl::PressureLaw(ValuesOf(after).pressure,
                                                              {later_command.pressure_ref, later.p1, later.p2,
                                                               later.motor_speed, later.arm_speed})
                                       .voltage);
}

// Tests that the pressure command does not jump either where another reference comes and the error is
// differentiated: the reference before was moving.
TEST_F(LiveTuningTest, AnotherReferenceDoesNotJump) {
  config_ = settings::Replaced(config_, "[position]", "[position]\nderivative = \"error\"");
  at_[1500] = [&] { Ask(1, "reference.kind=sine\nreference.amplitude=0.05\nreference.frequency_hz=2"); };
  at_[4000] = [&] { Ask(2, "reference.kind=steps\nreference.initial=0.05\nreference.steps=[]"); };
  ASSERT_EQ(Run(1.2), 0);
  const tuning_answer_t* answer = AnswerTo(2);
  ASSERT_NE(answer, nullptr);
  ASSERT_TRUE(answer->accepted) << answer->text;
  const int64_t at = answer->acts_at;
  const auto jump = [&](int64_t tick) {
    return std::fabs(AtTick(pressures_, tick).pressure_ref - AtTick(pressures_, tick - 25).pressure_ref);
  };
  double largest = 0;
  for (int64_t tick = at - 1000; tick < at; tick += 25) largest = std::max(largest, jump(tick));
  EXPECT_LE(jump(at), 1.5 * largest);
  // The reference itself stops: by the law alone that would be c2 times its speed.
  const double speed = (AtTick(references_, at - 25).value - AtTick(references_, at - 50).value) / 0.005;
  EXPECT_GT(ValuesOf(settings::Parsed(config_)).position.c2 * std::fabs(speed), 3 * largest);
}

// Tests that of a decision nothing but its time is taken: its values and its reference are those that were
// prepared.
TEST_F(LiveTuningTest, ADecisionThatDiffersFromItsProposalChangesNothingElse) {
  tuned_settings_t forged;
  at_[1000] = [&] {
    forged = settings_.back();
    forged.version = 900;
    forged.stage = tuned_settings_t::PROPOSED;
    forged.acts_at = -1;
    bus_->Publish("HYDRO_SETTINGS", forged);
    forged.stage = tuned_settings_t::DECIDED;
    forged.acts_at = 1100;
    forged.reference = "kind = [";
    for (double& value : forged.values) value = NAN;
    bus_->Publish("HYDRO_SETTINGS", forged);
  };
  ASSERT_EQ(Run(0.4), 0);
  for (const pressure_command_t& command : pressures_)
    ASSERT_TRUE(std::isfinite(command.pressure_ref)) << command.tick;
  EXPECT_EQ(commands_.back().status, motor_command_t::LAW);
}

// Tests that a torque limit that is tightened below what is just asked for trips nothing: the command on its
// way is from before.
TEST_F(LiveTuningTest, ATighterTorqueLimitTripsNothing) {
  std::vector<fault_t> faults;
  listen_ = [&] { bus_->Subscribe<fault_t>("HYDRO_FAULT", [&](const fault_t& f) { faults.push_back(f); }); };
  at_[510] = [&] { Ask(1, "limits.arm_torque=1000"); };
  ASSERT_EQ(Run(0.3), 0);
  const tuning_answer_t* answer = AnswerTo(1);
  ASSERT_NE(answer, nullptr);
  ASSERT_TRUE(answer->accepted) << answer->text;
  EXPECT_GT(AtTick(pressures_, answer->acts_at - 25).pressure_ref, 1.2 * 1000 / 3.68)
      << "more was asked for before";
  EXPECT_DOUBLE_EQ(AtTick(pressures_, answer->acts_at).pressure_ref, 1000 / 3.68);
  EXPECT_TRUE(faults.empty()) << faults.front().text;
}

// Tests that what is refused changes nothing, to the last bit, and says why.
TEST_F(LiveTuningTest, WhatIsRefusedChangesNothing) {
  ASSERT_EQ(Run(0.3), 0);
  const std::vector<motor_command_t> undisturbed = commands_;
  at_[500] = [&] { Ask(1, "position.c1=10500\nposition.c2=5000"); };
  at_[600] = [&] { Ask(2, "limits.pressure=9000\nposition.c2=400"); };
  at_[700] = [&] { Ask(3, "nonsense"); };
  at_[800] = [&] { Ask(4, "", tuning_request_t::UNDO); };
  ASSERT_EQ(Run(0.3), 0);
  for (int64_t number = 1; number <= 4; ++number) {
    ASSERT_NE(AnswerTo(number), nullptr) << number;
    EXPECT_FALSE(AnswerTo(number)->accepted);
    EXPECT_EQ(AnswerTo(number)->acts_at, -1);
  }
  EXPECT_THAT(AnswerTo(1)->text, HasSubstr("would be unstable"));
  EXPECT_THAT(AnswerTo(4)->text, HasSubstr("nothing to undo"));
  ASSERT_EQ(commands_.size(), undisturbed.size());
  for (size_t i = 0; i < commands_.size(); ++i) EXPECT_EQ(commands_[i].voltage, undisturbed[i].voltage) << i;
}

// Tests that a change is taken back as a whole, and that a request is acted on once however often it comes.
TEST_F(LiveTuningTest, UndoAndRepeats) {
  at_[500] = [&] { Ask(1, "position.c1=9000\nposition.c2=400"); };
  at_[505] = [&] { Ask(1, "position.c1=9000\nposition.c2=400"); };
  at_[900] = [&] { Ask(1, "position.c1=9000\nposition.c2=400"); };
  at_[1000] = [&] { Ask(2, "position.c2=450"); };
  at_[1500] = [&] { Ask(3, "", tuning_request_t::UNDO); };
  at_[2000] = [&] { Ask(4, "", tuning_request_t::UNDO); };
  ASSERT_EQ(Run(0.5), 0);
  std::map<int64_t, std::string> changes;
  for (const tuned_settings_t& s : settings_) {
    if (s.stage == tuned_settings_t::DECIDED) changes[s.version] = s.changes;
  }
  const std::map<int64_t, std::string> expected{{1, "position.c1 = 9000\nposition.c2 = 400\n"},
                                                {2, "position.c1 = 9000\nposition.c2 = 450\n"},
                                                {3, "position.c1 = 9000\nposition.c2 = 400\n"},
                                                {4, ""}};
  EXPECT_EQ(changes, expected);
}

// Tests that a stack that began with an unstable loop, and whose loop was mended, goes back to it by an undo
// and by nothing else.
TEST_F(LiveTuningTest, UndoOfAMendedLoop) {
  config_ = settings::Replaced(config_, "c2 = ", "c2 = 5000 # ");
  at_[500] = [&] { Ask(1, "position.c2=400"); };
  at_[700] = [&] { Ask(2, "position.c2=5000"); };
  at_[900] = [&] { Ask(3, "", tuning_request_t::UNDO); };
  Run(0.25);
  for (const int64_t number : {1, 2, 3}) ASSERT_NE(AnswerTo(number), nullptr) << number;
  EXPECT_TRUE(AnswerTo(1)->accepted) << AnswerTo(1)->text;
  EXPECT_FALSE(AnswerTo(2)->accepted);
  EXPECT_THAT(AnswerTo(2)->text, HasSubstr("would be unstable"));
  EXPECT_TRUE(AnswerTo(3)->accepted) << AnswerTo(3)->text;
  EXPECT_THAT(AnswerTo(3)->text, HasSubstr("an UNSTABLE loop, as it was"));
}

// Tests that a new reference is reached from where the old one was, and counts its time from its beginning.
// Tests that a request for what is in force already is answered, makes no version, and leaves the undo what
// it was.
TEST_F(LiveTuningTest, WhatIsInForceMakesNoVersion) {
  at_[500] = [&] { Ask(1, "position.c2=500"); };
  at_[1000] = [&] { Ask(2, "position.c2=500"); };
  at_[1500] = [&] { Ask(3, "", tuning_request_t::UNDO); };
  ASSERT_EQ(Run(0.5), 0);
  const tuning_answer_t *first = AnswerTo(1), *same = AnswerTo(2), *undo = AnswerTo(3);
  ASSERT_TRUE(first != nullptr && same != nullptr && undo != nullptr);
  EXPECT_TRUE(same->accepted);
  EXPECT_EQ(same->version, first->version);
  EXPECT_EQ(same->acts_at, first->acts_at);
  EXPECT_THAT(same->text, HasSubstr("nothing differs"));
  EXPECT_TRUE(undo->accepted);
  EXPECT_THAT(undo->text, HasSubstr("position.c2 = "));
  EXPECT_EQ(undo->version, first->version + 1);
}

TEST_F(LiveTuningTest, AReferenceBeginsAtItsTick) {
  config_ += "[limits]\nreturn_s = 0.1\n";
  at_[1500] = [&] { Ask(1, "reference.steps=[[0, 0.2], [0.2, 0.05]]"); };
  ASSERT_EQ(Run(0.9), 0);
  const tuning_answer_t* answer = AnswerTo(1);
  ASSERT_NE(answer, nullptr);
  ASSERT_TRUE(answer->accepted) << answer->text;
  const int64_t at = answer->acts_at;
  EXPECT_EQ(AtTick(references_, at - 25).value, 0.1);
  EXPECT_EQ(AtTick(references_, at).value, 0.1);
  EXPECT_NEAR(AtTick(references_, at + 250).value, 0.15, 1e-12);
  EXPECT_EQ(AtTick(references_, at + 500).value, 0.2);
  EXPECT_EQ(AtTick(references_, at + 975).value, 0.2);
  EXPECT_EQ(AtTick(references_, at + 1000).value, 0.05);
}

// Tests that a change that one controller cannot act by changes nothing in the others, and that a controller
// that has been heard once and then says nothing ends a request too.
TEST_F(LiveTuningTest, AControllerThatCannotEndsTheRequest) {
  // A third controller, played here: it takes part, and refuses whatever is proposed.
  listen_ = [&] {
    bus_->Subscribe<tuned_settings_t>("HYDRO_SETTINGS", [this](const tuned_settings_t& s) {
      if (s.stage == tuned_settings_t::PROPOSED)
        SayAsPositionLoop(s.version - 1, s.version, "its file is gone");
    });
  };
  at_[500] = [&] { Ask(1, "pressure.natural_frequency_rad_s=130"); };
  ASSERT_EQ(Run(0.3), 0);
  ASSERT_NE(AnswerTo(1), nullptr);
  EXPECT_FALSE(AnswerTo(1)->accepted);
  EXPECT_THAT(AnswerTo(1)->text,
              HasSubstr("position_ctrl cannot act by it: its file is gone; nothing has changed"));
  ExpectNothingDecided();
}

TEST_F(LiveTuningTest, AControllerThatIsSilentEndsTheRequest) {
  listen_ = [&] {
    bus_->Subscribe<tuned_settings_t>("HYDRO_SETTINGS", [this](const tuned_settings_t& s) {
      // Says again and again that it acts by version 0.
      if (s.stage == tuned_settings_t::PROPOSED) SayAsPositionLoop(0, -1, "");
    });
  };
  at_[500] = [&] { Ask(1, "pressure.natural_frequency_rad_s=130"); };
  ASSERT_EQ(Run(1.0), 0);
  ASSERT_NE(AnswerTo(1), nullptr);
  EXPECT_FALSE(AnswerTo(1)->accepted);
  EXPECT_THAT(AnswerTo(1)->text, HasSubstr("position_ctrl has not answered; nothing has changed"));
  ExpectNothingDecided();
}

// Tests values that are asked for while a latched fault holds zero volts: limits may be loosened then,
// nothing moves before the re-arm, and after it the loops act by them.
TEST_F(LiveTuningTest, SetsDuringALatchedFault) {
  config_ += "[limits]\nrearm = \"explicit\"\nmotor_speed_rad_s = 20\n";
  std::vector<fault_t> faults;
  std::vector<rearm_t> rearmed;
  listen_ = [&] {
    bus_->Subscribe<fault_t>("HYDRO_FAULT", [&](const fault_t& f) { faults.push_back(f); });
    bus_->Subscribe<rearm_t>("HYDRO_REARM", [&](const rearm_t& r) {
      if (r.kind != rearm_t::REQUEST) rearmed.push_back(r);
    });
  };
  const auto rearm = [&] {
    rearm_t request{};
    request.tick = states_.back().tick;
    request.session = 77;
    request.addressee = states_.back().session;
    request.kind = rearm_t::REQUEST;
    bus_->Publish("HYDRO_REARM", request);
  };
  at_[2000] = [&] { Ask(1, "limits.motor_speed_rad_s=900\nposition.c2=400"); };
  at_[3000] = rearm;
  at_[5000] = [&] { Ask(2, "limits.motor_speed_rad_s=1000"); };
  ASSERT_EQ(Run(1.2), 0);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults.front().code, "motor_speed_limit");
  EXPECT_LT(faults.front().tick, 2000);
  ASSERT_NE(AnswerTo(1), nullptr);
  EXPECT_TRUE(AnswerTo(1)->accepted) << AnswerTo(1)->text;
  ASSERT_EQ(rearmed.size(), 1u);
  EXPECT_EQ(rearmed[0].kind, rearm_t::ACCEPTED) << rearmed[0].text;
  double after = 0;
  for (const state_t& state : states_) {
    if (state.tick > faults.front().tick + 1 && state.tick <= 3000) {
      ASSERT_EQ(state.voltage, 0) << state.tick << ": a set is no re-arm";
    }
    if (state.tick > 3100) after = std::max(after, std::fabs(state.voltage));
  }
  EXPECT_GT(after, 0.1);
  ASSERT_NE(AnswerTo(2), nullptr);
  EXPECT_FALSE(AnswerTo(2)->accepted) << "it may move again";
}

// Tests that a request beside a stop, in whatever order they arrive, ends with the run, in order and at zero
// volts.
TEST_F(LiveTuningTest, SetsDuringAStop) {
  for (const int64_t later : {-3, -1, 0, 1, 3}) {
    at_.clear();
    answers_.clear();
    const auto ask = [&] { Ask(1, "position.c2=400"); };
    const auto stop = [&] {
      stop_t message{};
      message.session = 78;
      message.source = "launch";
      message.reason = "a test";
      message.addressee = states_.back().session;
      bus_->Publish("HYDRO_STOP", message);
    };
    at_[1000] = [&, later] {
      if (later >= 0) stop();
      if (later <= 0) ask();
    };
    if (later > 0) at_[1000 + later] = ask;
    if (later < 0) at_[1000 - later] = stop;
    EXPECT_EQ(Run(1), 0) << later;
    EXPECT_LT(states_.back().tick, 1100) << "it has ended";
    for (const motor_command_t& command : commands_) EXPECT_TRUE(std::isfinite(command.voltage));
  }
}

// Tests that a run that has just begun has nothing to undo, whatever was changed in the one before it.
TEST_F(LiveTuningTest, NothingIsUndoneAfterARestart) {
  at_[500] = [&] { Ask(1, "position.c2=400"); };
  ASSERT_EQ(Run(0.3), 0);
  ASSERT_TRUE(AnswerTo(1) != nullptr && AnswerTo(1)->accepted);
  at_.clear();
  answers_.clear();
  settings_.clear();
  at_[500] = [&] { Ask(2, "", tuning_request_t::UNDO); };
  ASSERT_EQ(Run(0.3), 0);
  ASSERT_NE(AnswerTo(2), nullptr);
  EXPECT_FALSE(AnswerTo(2)->accepted);
  EXPECT_THAT(AnswerTo(2)->text, HasSubstr("nothing to undo"));
  ExpectNothingDecided();
}

// Tests that a request that is old, for another plant, or not one, changes nothing.
TEST_F(LiveTuningTest, StrangeRequests) {
  at_[500] = [&] {
    tuning_request_t request;
    request.tick = 500;
    request.session = 78;
    request.request = 1;
    request.addressee = states_.back().session + 1;
    request.kind = tuning_request_t::SET;
    request.changes = "position.c2=400";
    bus_->Publish("HYDRO_TUNING_REQUEST", request);  // another plant's
    Ask(1, "position.c2=400", 7);
    Ask(2, std::string(70000, 'x'));
    Ask(3, "position.c2=400\nposition.c2=401");
  };
  at_[600] = [&] { Ask(4, std::string(70000, 'x')); };
  at_[700] = [&] { Ask(5, "position.c2=400\nposition.c2=401"); };
  ASSERT_EQ(Run(0.3), 0);
  ASSERT_NE(AnswerTo(1), nullptr);
  EXPECT_THAT(AnswerTo(1)->text, HasSubstr("unknown kind"));
  ASSERT_NE(AnswerTo(4), nullptr);
  EXPECT_THAT(AnswerTo(4)->text, HasSubstr("longer than 64 KiB"));
  ASSERT_NE(AnswerTo(5), nullptr);
  EXPECT_THAT(AnswerTo(5)->text, HasSubstr("found twice"));
  ExpectNothingDecided();
}

// Tests that another run that follows the decisions of this one is the same, bit by bit.
TEST_F(LiveTuningTest, AnotherRunFollowsTheDecisions) {
  at_[500] = [&] { Ask(1, "position.c1=9000\nposition.c2=400\nnoise.p1=0.5"); };
  at_[1000] = [&] { Ask(2, "reference.steps=[[0, 0.15]]"); };
  at_[1500] = [&] { Ask(3, "", tuning_request_t::UNDO); };
  ASSERT_EQ(Run(0.5), 0);
  std::map<int64_t, tuned_settings_t> decided;
  for (const tuned_settings_t& s : settings_) {
    if (s.stage == tuned_settings_t::DECIDED) decided.emplace(s.version, s);
  }
  ASSERT_EQ(decided.size(), 3U);
  const std::vector<state_t> states = states_;
  at_.clear();
  for (const auto& [version, settings] : decided) follow_.push_back(settings);
  ASSERT_EQ(Run(0.5), 0);
  ASSERT_EQ(states_.size(), states.size());
  for (size_t i = 0; i < states.size(); ++i) {
    EXPECT_EQ(states_[i].p1, states[i].p1) << i;
    EXPECT_EQ(states_[i].arm_angle, states[i].arm_angle) << i;
    EXPECT_EQ(states_[i].voltage, states[i].voltage) << i;
  }
}

}  // namespace
}  // namespace hydro::tuning
