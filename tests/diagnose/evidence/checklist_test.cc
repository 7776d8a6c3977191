#include "diagnose/evidence/checklist.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "base/number_text.h"
#include "tests/diagnose/recording/line_in_checklist.h"

namespace hydro::diagnose {
namespace {

using State = ChecklistLine::State;
using testing::LineInChecklist;
using testing::Table1Model;

// A recording without what can be worked out from the rest.
runs::MeasuredRun PlainSwing(model::Shaft shaft, bool bypass = false) {
  runs::MeasuredRun run = testing::Swing(shaft, bypass);
  run.motor_angle = run.arm_speed = {};
  return run;
}

void Negate(runs::MeasuredSignal* signal) {
  for (double& value : signal->values) value = -value;
}

// Tests that all signs of a good run are found good: free, clamped, with the bypass open.
TEST(ChecklistTest, GoodRuns) {
  for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped}) {
    for (const bool bypass : {false, true}) {
      for (const ChecklistLine& line : Checklist(Table1Model(), PlainSwing(shaft, bypass))) {
        if (bypass && !line.item.starts_with("sign")) continue;  // the arm rests
        EXPECT_NE(line.state, State::kLook) << Written(line);
      }
    }
  }
}

// Tests --si: ranges and pressures in the units that a reader of SI expects, one unit in a line.
TEST(ChecklistTest, Si) {
  const runs::MeasuredRun run = PlainSwing(model::Shaft::kFree);
  EXPECT_THAT(LineInChecklist(run, "p1"), ::testing::EndsWith(" psi"));
  EXPECT_THAT(LineInChecklist(run, "p1", true), ::testing::ContainsRegex(" [kM]Pa$"));
  const std::string charge = LineInChecklist(run, "charge pressure", true);
  EXPECT_THAT(charge, ::testing::HasSubstr("kPa, the model's p_3 is " + ShortNumber(100 * 6.894757293168361) +
                                           " kPa"));
  EXPECT_THAT(charge, ::testing::Not(::testing::HasSubstr("psi")));
}

// Tests that a side below the charge pressure is none to look at where the model's valves are that stiff, and
// that a weight keeps one side of a linear arm above the other.
TEST(ChecklistTest, WhatTheModelKnowsOfTheCharge) {
  const auto charge = [](const model::ModelDescription& model, const runs::MeasuredRun& run) {
    const std::vector<ChecklistLine> lines = Checklist(model, run);
    const auto line = std::find_if(lines.begin(), lines.end(),
                                   [](const ChecklistLine& one) { return one.item == "charge pressure"; });
    return line == lines.end() ? "" : Written(*line);
  };
  model::ModelDescription model = Table1Model();
  const double p_3 = model.parameters.p_3;
  runs::MeasuredRun low = PlainSwing(model::Shaft::kFree), loaded = low;
  for (double& p1 : low.p1.values) p1 -= 0.25 * p_3;
  for (double& p2 : loaded.p2.values) p2 += 0.9 * p_3;
  EXPECT_THAT(charge(model, low), ::testing::StartsWith("look"));
  EXPECT_THAT(charge(model, loaded), ::testing::StartsWith("look"));
  model.effects = {
      {.id = "valve.pilot_check",
       .parameters = {{"ratio", 3}, {"cracking", 0.05 * p_3}, {"range", 0.25 * p_3}, {"conductance", 5}},
       .names = {}}};
  EXPECT_THAT(charge(model, low), ::testing::StartsWith("ok"));
  model.effects.clear();
  model.units.linear_arm = true;
  model.parameters.mgl = 0.8 * p_3 * model.parameters.k_2;
  EXPECT_THAT(charge(model, loaded), ::testing::StartsWith("ok"));
}

// Tests that one side whose scale is wrong is worth a look, though the other side is at the charge pressure.
TEST(ChecklistTest, SidesDiffer) {
  runs::MeasuredRun run = PlainSwing(model::Shaft::kFree);
  EXPECT_THAT(LineInChecklist(run, "charge pressure"), ::testing::StartsWith("ok"));
  for (double& p1 : run.p1.values) p1 *= 2.5;
  EXPECT_THAT(LineInChecklist(run, "charge pressure"), ::testing::StartsWith("look"));
}

// Tests that raw currents of sensors are seen, and still when somebody has called them a pressure.
TEST(ChecklistTest, Currents) {
  runs::MeasuredRun run = PlainSwing(model::Shaft::kFree);
  for (runs::MeasuredSignal* signal : {&run.p1, &run.p2}) {
    for (double& value : signal->values) value = 145.0377 * (4 + 16 * value / 5000);
  }
  EXPECT_THAT(LineInChecklist(run, "charge pressure"), ::testing::Not(::testing::HasSubstr("mA")));
  run.p1.source.scale = run.p2.source.scale = 145.0377;
  EXPECT_THAT(LineInChecklist(run, "charge pressure"),
              ::testing::ContainsRegex("^look .*currents of 4 to 20 mA"));
}

// Tests that pressures which a sidecar states in bar, and whose numbers are between 4 and 20 as those of
// currents are, are pressures: they fit the model's charge.
TEST(ChecklistTest, PressuresInBarAreNoCurrents) {
  runs::MeasuredRun run = PlainSwing(model::Shaft::kFree);
  const double low = std::min(*std::min_element(run.p1.values.begin(), run.p1.values.end()),
                              *std::min_element(run.p2.values.begin(), run.p2.values.end()));
  const double high = std::max(*std::max_element(run.p1.values.begin(), run.p1.values.end()),
                               *std::max_element(run.p2.values.begin(), run.p2.values.end()));
  for (runs::MeasuredSignal* signal : {&run.p1, &run.p2}) {
    for (double& value : signal->values)
      value = low + (value - low) * std::min(1.0, (280 - low) / (high - low));
    signal->source.scale = 14.5038;  // "bar"
  }
  ASSERT_GT(low / 14.5038, 3.8);
  ASSERT_LT(low / 14.5038, 8);
  EXPECT_THAT(LineInChecklist(run, "charge pressure"), ::testing::ContainsRegex("^ok "));
}

// Tests that each turned sign is seen where it shows.
TEST(ChecklistTest, TurnedSigns) {
  runs::MeasuredRun run = PlainSwing(model::Shaft::kFree);
  Negate(&run.voltage);
  EXPECT_THAT(LineInChecklist(run, "sign of the command"), ::testing::StartsWith("look"));
  run = PlainSwing(model::Shaft::kFree);
  Negate(&run.arm_angle);
  EXPECT_THAT(LineInChecklist(run, "sign of the arm"),
              ::testing::ContainsRegex("^look .*the arm moves down while"));
  EXPECT_THAT(LineInChecklist(run, "sign of the command"), ::testing::StartsWith("ok"));
  run = PlainSwing(model::Shaft::kClamped);
  std::swap(run.p1, run.p2);
  EXPECT_THAT(LineInChecklist(run, "sign of the pressures"),
              ::testing::ContainsRegex("^look .*exchange p1 and p2"));
}

// Tests that of pressures that are exchanged nothing good is said, however the shaft is held, and of others
// that they rise.
TEST(ChecklistTest, ExchangedPressures) {
  for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped}) {
    runs::MeasuredRun run = PlainSwing(shaft);
    EXPECT_THAT(LineInChecklist(run, "sign of the command"),
                ::testing::ContainsRegex("^ok .*raises p2 over p1"));
    std::swap(run.p1, run.p2);
    EXPECT_THAT(LineInChecklist(run, "sign of the command"),
                ::testing::Not(::testing::HasSubstr("raises p2 over p1")));
    EXPECT_THAT(LineInChecklist(run, "sign of the pressures"),
                ::testing::ContainsRegex("^look .*exchange p1 and p2"));
  }
}

// Tests that other units, a shaft that is not as stated and gaps in time are seen.
TEST(ChecklistTest, UnitsShaftAndTime) {
  runs::MeasuredRun run = PlainSwing(model::Shaft::kFree);
  for (runs::MeasuredSignal* signal : {&run.p1, &run.p2}) {
    for (double& value : signal->values) value /= 14.5038;
  }
  EXPECT_THAT(LineInChecklist(run, "charge pressure"),
              ::testing::ContainsRegex("^look .*: p1 and p2 are in bar"));
  run = PlainSwing(model::Shaft::kFree);
  const double fifth = 0.2 * *std::min_element(run.p1.values.begin(), run.p1.values.end());
  for (runs::MeasuredSignal* signal : {&run.p1, &run.p2}) {
    for (double& value : signal->values) value -= fifth;
  }
  EXPECT_THAT(LineInChecklist(run, "charge pressure"),
              ::testing::ContainsRegex("^look .*gauge against absolute"));
  run = PlainSwing(model::Shaft::kFree);
  run.shaft = model::Shaft::kClamped;
  for (double& angle : run.arm_angle.values) angle *= 20;
  EXPECT_THAT(LineInChecklist(run, "shaft"), ::testing::ContainsRegex("^look .*clamped, as is said"));
  run = PlainSwing(model::Shaft::kFree);
  for (size_t i = 500; i < run.time.size(); ++i) run.time[i] += 0.05;
  EXPECT_THAT(LineInChecklist(run, "samples"), ::testing::ContainsRegex("^look .*once none for 51 ms"));
}

// Tests that pressures in any other unit than the sidecar says have it named by the charge alone: of both,
// and of one.
TEST(ChecklistTest, UnitsOfPressures) {
  const double psi = 6894.757;  // Pa
  struct {
    const char* said;
    const char* is;
    double said_size, is_size;  // Pa
  } cases[] = {{"bar", "mbar", 1e5, 100}, {"bar", "kPa", 1e5, 1e3}, {"bar", "Pa", 1e5, 1},
               {"mbar", "bar", 100, 1e5}, {"MPa", "bar", 1e6, 1e5}, {"kPa", "MPa", 1e3, 1e6},
               {"bar", "psi", 1e5, psi},  {"Pa", "mbar", 1, 100}};
  for (const auto& one : cases) {
    for (const bool both : {true, false}) {
      runs::MeasuredRun run = PlainSwing(model::Shaft::kClamped);
      for (runs::MeasuredSignal* signal : {&run.p1, &run.p2}) {
        signal->source.scale = one.said_size / psi;
        if (signal == &run.p2 && !both) continue;
        for (double& value : signal->values) value *= one.said_size / one.is_size;
      }
      EXPECT_THAT(LineInChecklist(run, "charge pressure"),
                  ::testing::HasSubstr(std::string(both ? ": p1 and p2 are in " : ": p1 is in ") + one.is +
                                       ", not in " + one.said))
          << one.said << " for " << one.is;
    }
  }
}

// Tests that what is not recorded is absent, and that a run that rests says nothing of signs.
TEST(ChecklistTest, AbsentAndStill) {
  runs::MeasuredRun run = PlainSwing(model::Shaft::kFree);
  EXPECT_THAT(LineInChecklist(run, "motor_angle"), ::testing::StartsWith("absent"));
  for (runs::MeasuredSignal* signal : {&run.voltage, &run.motor_speed, &run.p1, &run.p2, &run.arm_angle}) {
    std::fill(signal->values.begin(), signal->values.end(), signal->values.front());
  }
  EXPECT_THAT(LineInChecklist(run, "sign of the command"), ::testing::HasSubstr("moves too little to tell"));
  EXPECT_THAT(LineInChecklist(run, "motor_speed"), ::testing::HasSubstr("it never changes"));
  run.bypass_valve.values.assign(run.samples(), 1);
  EXPECT_THAT(LineInChecklist(run, "bypass"), ::testing::ContainsRegex("^ok .*1 to 1 1?$"));
}

}  // namespace
}  // namespace hydro::diagnose
