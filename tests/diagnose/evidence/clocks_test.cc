#include "diagnose/evidence/clocks.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/input_error.h"
#include "base/word_list.h"
#include "diagnose/recording/recording_remarks.h"
#include "runs/measured/sample_times.h"
#include "tests/diagnose/prepare_run.h"
#include "tests/diagnose/small_runs.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::NoisyRig;
using testing::Table1With;
using ::testing::UnorderedElementsAre;

constexpr double kStep = 0.005;

// A recorded run: a clamped actuator at 200 Hz whose command never repeats.
runs::MeasuredRun Recorded(double friction_per_psi = 0) {
  NoisyRig rig;
  rig.step = kStep;
  rig.model.parameters = testing::Table1();
  rig.model.parameters.f = friction_per_psi;
  const auto waves = [](double t) {
    return 4 * std::sin(2 * std::numbers::pi * 0.7 * t) + 3 * std::sin(2 * std::numbers::pi * 1.9 * t + 1);
  };
  return rig.Record("waves", model::Shaft::kClamped, 0.1, 25, false, waves).measured;
}

// Delays these channels by this much.
runs::MeasuredRun Late(runs::MeasuredRun run, const std::vector<runs::SignalDelay>& delays) {
  std::vector<runs::SignalDelay> back;
  for (const auto& [signal, delay] : delays) back.emplace_back(signal, -delay);
  EXPECT_TRUE(RemoveDelays(back, &run));
  return run;
}

const ClockDelay* Of(const std::vector<ClockDelay>& clocks, const std::string& signal) {
  for (const ClockDelay& clock : clocks) {
    if (std::count(clock.signals.begin(), clock.signals.end(), signal) > 0) return &clock;
  }
  return nullptr;
}

// Tests that a late clock of motor and command is found, its delays are measured and corrected, whatever
// friction the model has.
TEST(Alignment, FindsALateClock) {
  const runs::MeasuredRun whole = Recorded(0.0005);
  runs::MeasuredRun run = Late(whole, {{&runs::MeasuredRun::voltage, 0.1},
                                       {&runs::MeasuredRun::motor_speed, 0.12},
                                       {&runs::MeasuredRun::motor_angle, 0.12}});
  const std::vector<ClockDelay> clocks = AlignClocks(Table1With(), &run);
  ASSERT_EQ(clocks.size(), 2u);
  const ClockDelay* const command = Of(clocks, "voltage");
  const ClockDelay* const motor = Of(clocks, "motor_speed");
  ASSERT_TRUE(command != nullptr && motor != nullptr);
  EXPECT_THAT(motor->signals, UnorderedElementsAre("motor_speed", "motor_angle"));
  EXPECT_NEAR(command->delay, 0.10, 0.01);
  EXPECT_NEAR(motor->delay, 0.12, 0.01);
  EXPECT_LT(motor->error, 0.03);
  EXPECT_THAT(DelayRemark(*motor), HasSubstr("motor_speed and motor_angle are late by 0.1"));
  // What remains is a piece of the original recording, with the pressures untouched.
  const auto at =
      std::search(whole.p1.values.begin(), whole.p1.values.end(), run.p1.values.begin(), run.p1.values.end());
  EXPECT_NE(at, whole.p1.values.end());
  EXPECT_GT(run.samples(), whole.samples() - 100);
}

void ExpectLeftAlone(const runs::MeasuredRun& recorded, const char* what) {
  runs::MeasuredRun run = recorded;
  EXPECT_THAT(AlignClocks(Table1With(), &run), IsEmpty()) << what;
  EXPECT_EQ(run.time, recorded.time) << what;
  EXPECT_EQ(run.voltage.values, recorded.voltage.values) << what;
  EXPECT_EQ(run.motor_speed.values, recorded.motor_speed.values) << what;
  EXPECT_EQ(run.p2.values, recorded.p2.values) << what;
}

// Tests that recordings on one clock, and delays that an effect of the catalogue describes, are left alone.
TEST(Alignment, LeavesTheRestToTheSearch) {
  const runs::MeasuredRun run = Recorded();
  ExpectLeftAlone(run, "nothing");
  ExpectLeftAlone(Late(run, {{&runs::MeasuredRun::motor_speed, 0.05}}), "a late sensor of speed");
  ExpectLeftAlone(Late(run, {{&runs::MeasuredRun::p2, 0.05}}), "a late sensor of pressure");
  ExpectLeftAlone(Late(run, {{&runs::MeasuredRun::p1, 0.1}, {&runs::MeasuredRun::p2, 0.1}}),
                  "late pressures");
  ExpectLeftAlone(Late(run, {{&runs::MeasuredRun::voltage, 0.05}}), "a command recorded late");
  ExpectLeftAlone(Late(run, {{&runs::MeasuredRun::voltage, -0.05}}), "an amplifier's delay");
  runs::MeasuredRun blind = run;
  blind.p1.values.clear();
  ExpectLeftAlone(blind, "one pressure only");
}

RunData Prepared(const runs::MeasuredRun& run, std::vector<ClockDelay>* clocks) {
  return PrepareAligned(run, AlignedRuns(Table1With(), {run}, 1).front(), Table1With(), clocks);
}

// Tests that pieces put on one clock claim no more certainty than that allows.
TEST(Alignment, TimingCountsAsNoise) {
  const runs::MeasuredRun run = Recorded();
  std::vector<ClockDelay> clocks;
  const RunData plain = Prepared(run, &clocks);
  EXPECT_THAT(clocks, IsEmpty());
  EXPECT_EQ(plain.Find(model::Channel::kP2)->noise,
            PrepareRun(run, testing::Table1()).Find(model::Channel::kP2)->noise);
  const RunData late = Prepared(Late(run, {{&runs::MeasuredRun::voltage, 0.1},
                                           {&runs::MeasuredRun::motor_speed, 0.1},
                                           {&runs::MeasuredRun::motor_angle, 0.1}}),
                                &clocks);
  EXPECT_EQ(clocks.size(), 2u);
  EXPECT_GT(late.Find(model::Channel::kP2)->noise, 2 * plain.Find(model::Channel::kP2)->noise);
}

// Tests that pressures that hardly leave their noise are no clock, and that a long run is read in part: what
// is wrong with every model would look sure in it.
TEST(Alignment, NeedsPressuresThatChange) {
  runs::MeasuredRun run = Late(Recorded(), {{&runs::MeasuredRun::voltage, 0.1},
                                            {&runs::MeasuredRun::motor_speed, 0.1},
                                            {&runs::MeasuredRun::motor_angle, 0.1}});
  EXPECT_THAT(AlignClocks(Table1With(), &run), ::testing::SizeIs(2));
  run.p1.noise = run.p2.noise = 1000;
  EXPECT_THAT(AlignClocks(Table1With(), &run), IsEmpty());
}

// Tests that runs in which nothing moves judge no model, unless one beside them has motion, or a command that
// moves nothing.
TEST(RequireMotion, RefusesRest) {
  runs::MeasuredRun rest = Recorded();
  const RunData moves = PrepareRun(rest, Table1With());
  for (const auto signal : {&runs::MeasuredRun::motor_speed, &runs::MeasuredRun::motor_angle,
                            &runs::MeasuredRun::p1, &runs::MeasuredRun::p2}) {
    double sign = 0.01;
    for (double& value : (rest.*signal).values) value = (sign = -sign);
  }
  const RunData sticks = PrepareRun(rest, Table1With());
  RunData rests = PrepareRun(rest, Table1With());
  std::fill(rests.stimulus.voltage.begin(), rests.stimulus.voltage.end(), 0.0);
  EXPECT_NO_THROW(RequireMotion({&rests, &moves}, "fitted"));
  EXPECT_NO_THROW(RequireMotion({&sticks}, "fitted"));
  EXPECT_NO_THROW(RequireMotion({}, "held-out"));
  EXPECT_THAT([&] { RequireMotion({&rests}, "held-out"); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("found held-out recordings in which nothing")));
}

// Tests the sentences about recordings that hold little, or are not what they claim to be.
TEST(RecordingRemarks, SayWhatIsWrong) {
  runs::MeasuredRun run = Recorded();
  const RunData good = PrepareRun(run, testing::Table1());
  EXPECT_THAT(RecordingRemarks({}, {&good}, {}), IsEmpty());

  run.p1.noise = 0.5;
  run.time.back() += 3;
  for (double& value : run.motor_speed.values) value = std::abs(value);
  for (size_t i = 1000; i < 1500; ++i) run.p2.values[i] = NAN;
  const RunData bad = PrepareRun(run, testing::Table1());
  EXPECT_THAT(RecordingRemarks({}, {&bad}, {}),
              ElementsAre(HasSubstr("the samples show more noise than is stated"),
                          HasSubstr("1 gap in time, up to 3"), HasSubstr("p2 is missing in 10 % of the rows"),
                          HasSubstr("one way only")));
  for (size_t i = 100; i < 130; ++i)
    run.motor_speed.values[i] *= -1;  // an overshoot says nothing about the other way
  const RunData overshoots = PrepareRun(run, testing::Table1());
  EXPECT_THAT(RecordingRemarks({}, {&overshoots}, {}), ::testing::Contains(HasSubstr("one way only")));
}

// Tests that the way in which tables were read is one remark for all runs that share it, and none for plain
// ones; and that noise is in the model's units.
TEST(LayoutRemarks, SayHowTablesWereRead) {
  runs::MeasuredRun run = Recorded();
  run.layout = "decimal commas";
  run.name = "first";
  const RunData first = PrepareRun(run, testing::Table1());
  run.name = "second";
  const RunData second = PrepareRun(run, testing::Table1());
  run.layout.clear();
  const RunData plain = PrepareRun(run, testing::Table1());
  EXPECT_THAT(
      LayoutRemarks({&first, &plain, &second}),
      ElementsAre(RunNamed("first") + ", " + RunNamed("second") + ": table read with decimal commas"));
  EXPECT_THAT(RecordingRemarks({}, {&first, &plain}, {&second}), IsEmpty());  // no fault
  run.p1.noise = 0.5;
  run.units = kSiUnits;
  const RunData noisy = PrepareRun(run, testing::Table1());
  EXPECT_THAT(RecordingRemarks({}, {&noisy}, {}), ElementsAre(HasSubstr(" Pa, 3 times the stated 0.5")));
}

// Tests that few samples whose times are most uneven say nothing of a clock: their means would be no run.
TEST(Alignment, LeavesUnevenTimes) {
  runs::MeasuredRun run = Recorded();
  run.Keep(0, 220);
  for (size_t i = 1; i < run.samples(); ++i) run.time[i] = run.time[i - 1] + (i % 5 < 3 ? 3e-5 : 0.03);
  ExpectLeftAlone(run, "uneven times");
}

}  // namespace
}  // namespace hydro::diagnose
