// Tests of commands that stand in the wrong row of their table.
#include "diagnose/evidence/late_command.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>

#include "runs/measured/sample_times.h"
#include "tests/diagnose/small_runs.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::NoisyRig;
using testing::Table1With;

struct Bench {
  double step = 1e-3;
  uint64_t seed = 1;
  std::vector<model::EffectDescription> lacking = {};  // effects of the machine that the model lacks
  double b = 1;                                        // the machine's b in that of the model
};

// Two clamped runs, one of them with the bypass open, of a table whose command stands `rows` rows late.
std::vector<runs::MeasuredRun> Recorded(const Bench& bench, int rows) {
  NoisyRig rig;
  rig.step = bench.step;
  rig.seed = bench.seed;
  rig.model.parameters = testing::Table1();
  rig.model.parameters.b *= bench.b;
  rig.model.effects = bench.lacking;
  std::vector<runs::MeasuredRun> runs;
  for (const bool bypass : {false, true}) {
    const auto steps = [&](double t) {
      constexpr double kLevels[] = {3, -2, 6, 0.8, -5, 4, -7, 1.5, -3, 8, -6, 2};
      const auto level = static_cast<size_t>(t / 0.11) + bench.seed;
      return kLevels[level % 12] + std::sin(2 * std::numbers::pi * 3 * t);
    };
    runs::MeasuredRun run =
        rig.Record(bypass ? "open" : "steps", model::Shaft::kClamped, 0.1, 5, bypass, steps).measured;
    run.sidecar = "bench/run.toml";
    run.voltage.source.column = "u";
    EXPECT_TRUE(runs::RemoveDelays({{&runs::MeasuredRun::voltage, -rows * bench.step}}, &run));
    runs.push_back(std::move(run));
  }
  return runs;
}

// The number that follows `before` in the only one of these lines; NaN: there is none.
double NumberAfter(const std::string& before, const std::vector<std::string>& lines) {
  if (lines.size() != 1) return std::nan("");
  const size_t at = lines[0].find(before);
  return at == std::string::npos ? std::nan("") : std::strtod(lines[0].c_str() + at + before.size(), nullptr);
}

// Tests that a command that is a row late or early is said with the line that mends it, at several rates, and
// nothing is said where the command stands in its row.
TEST(LateCommand, IsSaidWithTheLineThatMendsIt) {
  for (const double step : {5e-4, 1e-3, 2e-3, 5e-3}) {
    for (const uint64_t seed : {1, 2, 3}) {
      SCOPED_TRACE(std::to_string(step) + " s, seed " + std::to_string(seed));
      const Bench bench{step, seed};
      const CommandRemarks none = RemarksOnCommands(Table1With(), Recorded(bench, 0), 1);
      EXPECT_THAT(none.late, IsEmpty());
      EXPECT_THAT(none.early, IsEmpty());
      const CommandRemarks late = RemarksOnCommands(Table1With(), Recorded(bench, 1), 1);
      EXPECT_NEAR(NumberAfter("the voltage is late by ", late.late), 1, 0.15);
      EXPECT_NEAR(NumberAfter("in run.toml, under [columns], mends it: voltage = { column = \"u\", delay = ",
                              late.late),
                  step, 1e-9);
      EXPECT_THAT(late.early, IsEmpty());
      const CommandRemarks early = RemarksOnCommands(Table1With(), Recorded(bench, -1), 1);
      EXPECT_THAT(early.late, IsEmpty());
      EXPECT_NEAR(NumberAfter("the voltage is early by ", early.early), 1, 0.15);
      EXPECT_NEAR(NumberAfter("delay = ", early.early), -step, 1e-9);
    }
  }
}

// Tests that a command that is several rows late is said with all of them; one that is early by as many may
// be a late amplifier, and is left to the search.
TEST(LateCommand, OfSeveralRows) {
  for (const double step : {1e-3, 5e-3}) {
    for (const int rows : {2, 3, 4, 5}) {
      if (rows * step > 0.0201) continue;
      SCOPED_TRACE(std::to_string(step) + " s, rows " + std::to_string(rows));
      const Bench bench{step, static_cast<uint64_t>(rows)};
      const CommandRemarks late = RemarksOnCommands(Table1With(), Recorded(bench, rows), 2);
      EXPECT_NEAR(NumberAfter("the voltage is late by ", late.late), rows, 0.3);
      EXPECT_NEAR(NumberAfter("delay = ", late.late), rows * step, 1e-9);
      EXPECT_NEAR(NumberAfter("a row holds what acted ", late.late), rows, 0);
      const CommandRemarks early = RemarksOnCommands(Table1With(), Recorded(bench, -rows), 2);
      EXPECT_THAT(early.late, IsEmpty());
      EXPECT_THAT(early.early, IsEmpty());
    }
  }
}

// Tests that other values and friction that the model lacks are not taken for rows of the
// command, and do not hide them.
TEST(LateCommand, IsNoMissingEffect) {
  const model::EffectDescription stribeck{
      .id = "pump.stribeck", .parameters = {{"static_excess", 0.5}, {"speed", 3}}, .names = {}};
  const model::EffectDescription pressed{
      .id = "pump.pressure_friction", .parameters = {{"f", 0.001}}, .names = {}};
  const std::vector<model::EffectDescription> lacks[] = {{}, {stribeck}, {pressed}};
  for (const auto& lacking : lacks) {
    SCOPED_TRACE(lacking.empty() ? "b" : lacking.front().id);
    const Bench bench{.step = 1e-3, .seed = 4, .lacking = lacking, .b = 1.5};
    const CommandRemarks none = RemarksOnCommands(Table1With(), Recorded(bench, 0), 2);
    EXPECT_THAT(none.late, IsEmpty());
    EXPECT_THAT(none.early, IsEmpty());
    EXPECT_THAT(RemarksOnCommands(Table1With(), Recorded(bench, 1), 2).late,
                ElementsAre(HasSubstr("is late by")));
  }
}

// Tests that the estimate is in rows, with an error that holds the truth, for runs that are moved by several.
TEST(LateCommand, IsMeasuredInRows) {
  for (const int rows : {-2, -1, 0, 1, 2}) {
    const LateCommand found = FindLateCommand(Table1With(), Recorded({.step = 1e-3, .seed = 6}, rows), 0, 1);
    EXPECT_NEAR(found.rows, rows, 0.15 + 2 * found.error) << rows;
    EXPECT_LT(found.error, 0.2) << rows;
  }
}

// Tests that times as clocks give them move no command: those of a clock that is 20 millionths fast, in whole
// microseconds, and seconds since 1970, which a double holds to a quarter of a microsecond.
TEST(LateCommand, IsNotOneOfAnOrdinaryClock) {
  const auto fast = [](double t) { return 1e-6 * std::round(1e6 * 1.00002 * t); };
  const auto since_1970 = [](double t) { return 1767225600.25 + t; };
  for (const std::function<double(double)>& clock : {std::function<double(double)>(fast), {since_1970}}) {
    for (const int rows : {0, 1}) {
      std::vector<runs::MeasuredRun> runs = Recorded({.step = 1e-3, .seed = 7}, rows);
      for (runs::MeasuredRun& run : runs) std::ranges::transform(run.time, run.time.begin(), clock);
      const LateCommand found = FindLateCommand(Table1With(), runs, 0, 1);
      EXPECT_NEAR(found.rows, rows, 0.15 + 2 * found.error);
    }
  }
}

// Tests that logs of a stack, and runs without the motor's motion, say nothing.
TEST(LateCommand, IsLeftOutWhereNothingIsKnown) {
  std::vector<runs::MeasuredRun> logs = Recorded({}, 1);
  for (runs::MeasuredRun& run : logs) run.sidecar = "";
  EXPECT_THAT(RemarksOnCommands(Table1With(), logs, 1).late, IsEmpty());
  std::vector<runs::MeasuredRun> blind = Recorded({}, 1);
  for (runs::MeasuredRun& run : blind) run.motor_speed = run.motor_angle = {};
  EXPECT_THAT(RemarksOnCommands(Table1With(), blind, 1).late, IsEmpty());
}

}  // namespace
}  // namespace hydro::diagnose
