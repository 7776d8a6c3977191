#include "diagnose/recording/recording_damage.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Two seconds at 1 kHz: a square wave of the command, signals that follow it, with noise.
runs::MeasuredRun Bench(double noise = 1) {
  runs::MeasuredRun run;
  run.name = "bench";
  run.shaft = model::Shaft::kClamped;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (size_t i = 0; i < 2000; ++i) {
    const double t = 0.001 * static_cast<double>(i);
    run.time.push_back(t);
    run.voltage.values.push_back(i % 500 < 250 ? 2 : -2);
    run.motor_speed.values.push_back(20 * std::sin(9 * t) + 0.3 * noise * normal(random));
    run.p1.values.push_back(std::round(4 * (200 + 90 * std::cos(9 * t) + 1.5 * noise * normal(random))) / 4);
    run.p2.values.push_back(200 - 90 * std::cos(9 * t) + 1.5 * noise * normal(random));
  }
  return run;
}

size_t Missing(const std::vector<double>& values) {
  return static_cast<size_t>(
      std::count_if(values.begin(), values.end(), [](double value) { return std::isnan(value); }));
}

std::vector<std::string> LinesOf(std::vector<runs::MeasuredRun>* runs) {
  return SetAsideDamage({"Table 1", testing::Table1(), {}}, runs);
}

// Tests that a sound recording stays as it is, quantised pressures included.
TEST(RecordingDamage, NoneInASoundRecording) {
  std::vector<runs::MeasuredRun> runs = {Bench()};
  EXPECT_THAT(LinesOf(&runs), IsEmpty());
  ASSERT_EQ(runs.size(), 1u);
  EXPECT_EQ(runs[0].p1.values, Bench().p1.values);
}

// Tests that held values of one signal become missing, and those of its neighbours stay.
TEST(RecordingDamage, HeldValues) {
  std::vector<runs::MeasuredRun> runs = {Bench()};
  for (size_t i = 701; i < 712; ++i) runs[0].p2.values[i] = runs[0].p2.values[700];
  EXPECT_THAT(LinesOf(&runs),
              ElementsAre(HasSubstr("run bench: p2 repeats one value in 1 stretch, 11 samples")));
  EXPECT_EQ(Missing(runs[0].p2.values), 11u);
  EXPECT_TRUE(std::isnan(runs[0].p2.values[701]));
  EXPECT_FALSE(std::isnan(runs[0].p2.values[700]));
  EXPECT_EQ(Missing(runs[0].p1.values), 0u);
}

// Tests that a speed that repeats itself while the angle beside it advances as fast is no dropout, as it is
// where the angle does otherwise.
TEST(RecordingDamage, ASpeedOfEvenCounts) {
  for (const double turns : {1.0, 0.0}) {
    std::vector<runs::MeasuredRun> runs = {Bench()};
    runs::MeasuredRun& run = runs[0];
    std::vector<double>& speed = run.motor_speed.values;
    for (size_t i = 701; i < 712; ++i) speed[i] = speed[700];
    double angle = 0;
    for (size_t i = 0; i < speed.size(); ++i) {
      angle += (i > 700 && i < 712 ? turns : 1) * speed[i] * 1e-3;
      run.motor_angle.values.push_back(1e-4 * std::round(angle / 1e-4));
    }
    const std::vector<std::string> lines = LinesOf(&runs);
    EXPECT_EQ(lines.empty(), turns == 1) << turns;
    EXPECT_EQ(Missing(runs[0].motor_speed.values), turns == 1 ? 0u : 11u);
  }
}

// Tests that a sensor that is stuck for much of a run is found as well, with its noise or with its steps.
TEST(RecordingDamage, StuckForMostOfARun) {
  for (const size_t from : {1500, 1000, 400}) {
    std::vector<runs::MeasuredRun> runs = {Bench()};
    for (auto signal : {&runs::MeasuredRun::p1, &runs::MeasuredRun::p2}) {
      std::vector<double>& values = (runs[0].*signal).values;
      std::fill(values.begin() + static_cast<std::ptrdiff_t>(from) + 1, values.end(), values[from]);
    }
    EXPECT_THAT(LinesOf(&runs), ElementsAre(HasSubstr("p1 repeats one value in 1 stretch"),
                                            HasSubstr("p2 repeats one value in 1 stretch")))
        << from;
    EXPECT_EQ(Missing(runs[0].p2.values), 1999 - from);
  }
}

// Tests that a machine that rests for most of a run is not taken for stuck sensors: a coarse encoder and
// speed, coarse pressures, and fine sensors that repeat themselves while the command does not change.
TEST(RecordingDamage, RestsForMostOfARun) {
  runs::MeasuredRun rests = Bench();
  const auto steps = [](double value, double step) { return step * std::round(value / step); };
  for (size_t i = 0; i < 2000; ++i) {
    const size_t k = std::min<size_t>(i, 800);
    rests.motor_angle.values.push_back(steps(2 * std::sin(0.009 * static_cast<double>(k)), 0.0015));
    rests.p1.values[i] = steps(rests.p1.values[k], 12);
    rests.motor_speed.values[i] = i < 800 ? steps(rests.motor_speed.values[i], 0.8) : 5.6;
    rests.arm_angle.values.push_back(0.3);
    if (i < 800) continue;
    rests.voltage.values[i] = 0;
    rests.p2.values[i] = rests.p2.values[800];
  }
  std::vector<runs::MeasuredRun> runs = {rests};
  EXPECT_THAT(LinesOf(&runs), IsEmpty());
}

// Tests that a cell that no sensor reads counts as a spike, however large it is, and that a column in another
// unit has none.
TEST(RecordingDamage, ImpossibleCells) {
  for (const double cell : {2e5, 1e10, 1e14, -1e14}) {
    std::vector<runs::MeasuredRun> runs = {Bench()};
    runs[0].p2.values[300] = cell;
    EXPECT_THAT(LinesOf(&runs),
                ElementsAre("run bench: p2 has 1 spike, the first at 0.3 s; it counts as missing"))
        << cell;
    EXPECT_EQ(Missing(runs[0].p2.values), 1u);
  }
  std::vector<runs::MeasuredRun> runs = {Bench()};
  for (double& value : runs[0].p2.values) value *= 345;  // the highest are just beyond half the bulk modulus
  EXPECT_THAT(LinesOf(&runs), IsEmpty());
}

// Tests that readings of 0 in the midst of others become missing, the first one too.
TEST(RecordingDamage, Zeros) {
  std::vector<runs::MeasuredRun> runs = {Bench()};
  for (size_t i = 300; i < 320; ++i) runs[0].p1.values[i] = 0;
  EXPECT_THAT(LinesOf(&runs), ElementsAre(HasSubstr("20 samples")));
  EXPECT_EQ(Missing(runs[0].p1.values), 20u);
}

// Tests that a few equal values far from all others, as a recorder writes for "nothing", become missing
// whatever their number.
TEST(RecordingDamage, Sentinels) {
  for (const size_t length : {2, 3, 5, 7}) {
    std::vector<runs::MeasuredRun> runs = {Bench()};
    for (size_t i = 300; i < 300 + length; ++i) runs[0].p1.values[i] = -999;
    EXPECT_THAT(LinesOf(&runs), ElementsAre(HasSubstr(std::to_string(length) + " samples"))) << length;
    EXPECT_EQ(Missing(runs[0].p1.values), length);
  }
}

// Tests that the end of a sensor's range, an encoder at rest and a slow sensor are no dropouts.
TEST(RecordingDamage, WhatIsNone) {
  runs::MeasuredRun saturated = Bench();
  for (double& value : saturated.p1.values) value = std::min(value, 250.0);
  runs::MeasuredRun encoder = Bench();
  for (size_t i = 0; i < 2000; ++i) {
    const double moves = static_cast<double>(i < 900 ? i : i < 1000 ? 900 : i - 100);
    encoder.motor_angle.values.push_back(0.001 * std::round(0.7 * moves));
  }
  runs::MeasuredRun slow = Bench();
  for (size_t i = 0; i < 2000; ++i) slow.p2.values[i] = slow.p2.values[i - i % 10];
  runs::MeasuredRun rests = Bench();  // and its speed reads 0
  for (size_t i = 1047; i < 1130; ++i) rests.motor_speed.values[i] = 0;
  for (const size_t i : {1046, 1130}) rests.motor_speed.values[i] = 0.5;
  std::vector<runs::MeasuredRun> runs = {saturated, encoder, slow, rests};
  EXPECT_THAT(LinesOf(&runs), IsEmpty());
}

// Tests that single samples far outside their neighbours are set aside, and a steep step is not.
TEST(RecordingDamage, Spikes) {
  std::vector<runs::MeasuredRun> runs = {Bench()};
  for (const size_t i : {50, 400, 1200}) runs[0].motor_speed.values[i] += 30;
  for (size_t i = 1500; i < 2000; ++i) runs[0].p2.values[i] += 300;
  EXPECT_THAT(LinesOf(&runs),
              ElementsAre("run bench: motor_speed has 3 spikes, the first at 0.05 s; they count as missing"));
  EXPECT_EQ(Missing(runs[0].motor_speed.values), 3u);
}

// Tests that rows lost across a step of the command cut the run in two, and others do not.
TEST(RecordingDamage, RowsLostAcrossAStep) {
  for (const size_t first : {size_t{745}, size_t{600}}) {
    std::vector<runs::MeasuredRun> runs(1);
    runs::MeasuredRun& run = runs[0];
    run = Bench();
    for (std::vector<double>* values :
         {&run.time, &run.voltage.values, &run.motor_speed.values, &run.p1.values, &run.p2.values}) {
      values->erase(values->begin() + static_cast<std::ptrdiff_t>(first),
                    values->begin() + static_cast<std::ptrdiff_t>(first) + 10);
    }
    const std::vector<std::string> lines = LinesOf(&runs);
    if (first == 600) {
      EXPECT_THAT(lines, IsEmpty());
      EXPECT_EQ(runs.size(), 1u);
      continue;
    }
    EXPECT_THAT(lines, ElementsAre(HasSubstr("after 0.744 s: the run is cut in two")));
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_EQ(runs[0].samples(), 745u);
    EXPECT_EQ(runs[1].samples(), 1245u);
    EXPECT_EQ(runs[1].name, "bench, from 0.755 s");
  }
}

// Tests the same where the recorder repeats its last row: then nobody knows when the command stepped.
TEST(RecordingDamage, RowsHeldAcrossAStep) {
  std::vector<runs::MeasuredRun> runs = {Bench()};
  for (std::vector<double>* values :
       {&runs[0].voltage.values, &runs[0].motor_speed.values, &runs[0].p1.values, &runs[0].p2.values}) {
    for (size_t i = 741; i < 761; ++i) (*values)[i] = (*values)[740];
  }
  const std::vector<std::string> lines = LinesOf(&runs);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_THAT(lines.back(), HasSubstr("cut in two"));
  EXPECT_EQ(runs[0].samples(), 741u);
  EXPECT_EQ(runs[1].time.front(), 0.761);
}

}  // namespace
}  // namespace hydro::diagnose
