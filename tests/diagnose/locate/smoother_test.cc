// The parts of the disturbance smoother: what it reads and estimates, its modes, its forward pass and the
// record that it leaves.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnose/locate/smoother_filter.h"
#include "diagnose/locate/smoother_mode.h"
#include "diagnose/locate/smoother_record.h"
#include "diagnose/locate/smoother_setup.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

namespace smoother = diagnose::smoother;
using diagnose::Balance;

constexpr size_t kPumpTorque = static_cast<size_t>(Balance::kPumpTorque);
constexpr size_t kFlow1 = static_cast<size_t>(Balance::kFlow1);
constexpr size_t kFlow2 = static_cast<size_t>(Balance::kFlow2);
constexpr size_t kArmTorque = static_cast<size_t>(Balance::kArmTorque);

smoother::Record::Update UpdateOf(int sensor) {
  return {sensor, 10.0 * sensor, smoother::RowOfColumns::Constant(0.5 * sensor)};
}

struct Rig {
  model::ModelDescription model = Table1With();
  diagnose::RunData run;
  explicit Rig(model::Shaft shaft, bool bypass = false, double duration = 0.4)
      : run(SmallRun(model, shaft, bypass, duration, 0, 1)) {}
  smoother::Setup Setup(const diagnose::PressureOffsets& offsets = {}) const {
    return smoother::MakeSetup(model, run, offsets);
  }
};

// Tests that each balance whose quantity is measured has a disturbance behind the model's states: the arm's
// only where it is free, and flows only where no bypass hides them.
TEST(SmootherSetup, GivesMeasuredBalancesADisturbance) {
  const Rig clamped(model::Shaft::kClamped);
  const smoother::Setup setup = clamped.Setup();
  EXPECT_EQ(setup.states, 4);
  EXPECT_EQ(setup.size, 7);
  EXPECT_EQ(setup.place[kPumpTorque], 4);
  EXPECT_EQ(setup.place[kFlow1], 5);
  EXPECT_EQ(setup.place[kFlow2], 6);
  EXPECT_EQ(setup.place[kArmTorque], -1);
  EXPECT_DOUBLE_EQ(setup.interval, 1e-3);

  const Rig free(model::Shaft::kFree);
  EXPECT_EQ(free.Setup().place[kArmTorque], free.Setup().size - 1);
  const Rig bypass(model::Shaft::kClamped, true);
  EXPECT_EQ(bypass.Setup().place[kFlow1], -1);
  EXPECT_EQ(bypass.Setup().place[kFlow2], -1);
}

// Tests that a sensor reads its state, that its offset is known, and that valves feel the pressure without
// it.
TEST(SmootherSetup, SensorsReadStates) {
  const Rig rig(model::Shaft::kClamped);
  const smoother::Setup plain = rig.Setup(), corrected = rig.Setup({.p1 = 12, .p2 = -3});
  ASSERT_EQ(plain.sensors.size(), 4u);
  for (const smoother::Sensor& sensor : corrected.sensors) {
    EXPECT_EQ(sensor.row.cwiseAbs().sum(), 1);
    if (sensor.channel == model::Channel::kP1) {
      EXPECT_EQ(sensor.row[model::kP1], 1);
      EXPECT_EQ(sensor.offset, 12);
    }
  }
  ASSERT_EQ(plain.observed.p1.size(), rig.run.samples());
  EXPECT_NEAR(corrected.observed.p1[100], plain.observed.p1[100] - 12, 1e-9);
  EXPECT_NEAR(corrected.observed.p2[100], plain.observed.p2[100] + 3, 1e-9);
  EXPECT_NEAR(plain.Variance(model::Channel::kP1), 1.5 * 1.5, 0.4);  // the noise is estimated
  EXPECT_EQ(plain.Variance(model::Channel::kArmSpeed), 0);
}

// Tests that the record gives readings back in reverse, each sample's own only.
TEST(SmootherRecord, GivesReadingsBackInReverse) {
  smoother::Record record(2, 3);
  smoother::Vector gain(3);
  for (const int sensor : {1, 2, 3}) {
    gain << sensor, 0, -sensor;
    record.Add(sensor < 3 ? 0 : 1, UpdateOf(sensor), gain);
  }
  smoother::Record::Update update = UpdateOf(0);
  for (const auto& [sample, sensor] : {std::pair{1, 3}, {0, 2}, {0, 1}}) {
    ASSERT_TRUE(record.Take(sample, &update, &gain));
    EXPECT_EQ(update.sensor, sensor);
    EXPECT_EQ(update.variance, 10.0 * sensor);
    EXPECT_EQ(update.innovation[diagnose::kNoiseDraws], 0.5 * sensor);
    EXPECT_EQ(gain[2], -sensor);
  }
  EXPECT_FALSE(record.Take(0, &update, &gain));
  EXPECT_FALSE(record.Take(1, &update, &gain));
}

// Tests that forgotten readings are gone and those of other samples stay.
TEST(SmootherRecord, Forgets) {
  smoother::Record record(2, 1);
  smoother::Vector gain = smoother::Vector::Ones(1);
  record.Add(0, UpdateOf(1), gain);
  record.Add(1, UpdateOf(2), gain);
  record.Add(1, UpdateOf(2), gain);
  record.Forget(1);
  smoother::Record::Update update = UpdateOf(0);
  EXPECT_FALSE(record.Take(1, &update, &gain));
  EXPECT_TRUE(record.Take(0, &update, &gain));
}

// Tests that the pump's mode is the way that the data say it turns, and that the torque balance counts there.
TEST(SmootherMode, PumpFollowsTheData) {
  const Rig rig(model::Shaft::kClamped);
  const smoother::Setup setup = rig.Setup();
  const model::Equations equations(rig.model, setup.options);
  double state[model::kMaxStates];
  model::Mode mode;
  setup.Begin(equations, state, &mode);
  model::Terms<double> terms;
  double rate[model::kMaxStates];
  smoother::ModeAtSample at(setup);
  int turning[3] = {0, 0, 0};
  for (size_t k = 0; k < rig.run.samples(); ++k) {
    if (setup.observed.turns[k] == 0) continue;
    std::array<uint8_t, diagnose::kBalances> informative{};
    at.Set(equations, k, rig.run.stimulus.voltage[k], state, &mode, &terms, rate, &informative);
    ASSERT_EQ(mode.pump, setup.observed.turns[k]) << k;
    EXPECT_EQ(informative[kPumpTorque], setup.observed.passes[k] ? 0 : 1) << k;
    ++turning[1 + mode.pump];
  }
  EXPECT_GT(turning[0], 50);
  EXPECT_GT(turning[2], 50);
}

// Tests that the forward pass of a true model follows the motor within its noise and adds no torque beyond
// what the noise alone adds.
TEST(SmootherFilter, FollowsATrueModel) {
  const Rig rig(model::Shaft::kClamped);
  const smoother::Setup setup = rig.Setup();
  smoother::Record record = smoother::Filter(setup).Run();
  const std::vector<double>& measured = rig.run.Find(model::Channel::kMotorSpeed)->values;
  double off = 0, torque = 0, by_noise = 0, count = 0;
  for (size_t k = 50; k < rig.run.samples(); ++k) {
    if (!record.informative(k)[kPumpTorque]) continue;
    const double difference = record.state(k)(model::kMotorSpeed, 0) - measured[k];
    off += difference * difference;
    torque += std::pow(record.state(k)(setup.place[kPumpTorque], 0), 2);
    by_noise += std::pow(record.state(k)(setup.place[kPumpTorque], 1), 2);
    count += 1;
  }
  ASSERT_GT(count, 200);
  // The sensor's noise, 0.3 rad/s: the root mean square of some 300 samples is within 12 % of it, rare cases
  // apart.
  EXPECT_LT(std::sqrt(off / count), 1.12 * 0.3);
  EXPECT_LT(torque, 4 * by_noise);  // two signals of equal size differ by chance
}

}  // namespace
}  // namespace hydro::testing
