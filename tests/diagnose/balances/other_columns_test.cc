// Tests of columns that are no effect's amounts: those of the recorder, and of what repeats with the shaft.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/diagnose/balances/clean_runs.h"
#include "tests/diagnose/balances/clean_scan.h"
#include "tests/diagnose/balances/judged.h"

namespace hydro::testing {
namespace {

using diagnose::EffectVariant;

// Tests columns that every hypothesis has: a command that is recorded late, channels that are late, by
// seconds, and zeros of transducers, by psi.
TEST(Columns, OfRecordersMeetTheSimulation) {
  struct Case {
    std::vector<std::string> columns;
    model::EffectDescription effect;
    double amount;
  };
  std::vector<std::string> offsets;
  for (size_t run = 0; run < 3; ++run) offsets.push_back("p1_offset[" + std::to_string(run) + "]");
  const auto late = [](const char* channel, double by) {
    return model::EffectDescription{"sensor.skew", {{"delay", by}}, {{"signal", channel}}};
  };
  for (const double part : {0.5, 0.2}) {
    const double by = 1e-3 * part;
    const Case cases[] = {
        {{"late.motor_speed"}, late("motor_speed", by), by},
        {{"late.p2"}, late("p2", by), by},
        {{"late.p"}, {"sensor.pressure_lag", {{"tau", by}}, {}}, by},
        {{"late.arm_angle"}, late("arm_angle", by), by},
        {{"late.voltage"}, {"amp.delay", {{"delay", by}}, {}}, -by},  // recorded early
        {offsets, {"sensor.pressure_offset", {{"p1", 50 * part}, {"p2", 0}}, {}}, 50 * part}};
    for (const Case& one : cases) {
      const CleanScan scan = ScanClean(PlainMachine(), RunsOf(PlainMachine({one.effect})), {});
      std::vector<Share> shares;
      for (const std::string& column : one.columns) shares.push_back({scan.Column(column), one.amount});
      Judged judged;
      judged.Add(Compare(scan, shares));
      judged.Expect(one.columns[0] + " " + std::to_string(part));
    }
  }
}

// Tests that effects whose columns are made together have the same as each would alone.
TEST(Columns, DoNotDependOnWhatElseIsTried) {
  const std::vector<diagnose::RunData> runs = RunsOf(PlainMachine());
  for (const EffectVariant& variant : PlainScan().setup.variants) {
    if (variant.kind != EffectVariant::Kind::kAmounts) continue;
    const CleanScan alone = ScanClean(PlainMachine(), runs, {variant});
    for (const std::string& amount : variant.amounts) {
      const int here = alone.Column(variant.set + ":" + amount);
      const int there = PlainScan().Column(variant.set + ":" + amount);
      for (size_t r = 0; r < runs.size(); ++r) {
        for (size_t b = 0; b < diagnose::kBalanceKinds; ++b) {
          const auto &one = alone.table.series[r][b], &all = PlainScan().table.series[r][b];
          ASSERT_EQ(one.contains(here), all.contains(there)) << variant.set << ":" << amount;
          if (!one.contains(here)) continue;
          EXPECT_LE((one.at(here) - all.at(there)).norm(), 1e-9 * one.at(here).norm())
              << variant.set << ":" << amount;
        }
      }
    }
  }
}

// Tests what repeats with the shaft: sine and cosine parts of each run's wave.
TEST(Columns, OfWavesMeetTheSimulation) {
  constexpr int kPeriods = 9;
  for (EffectVariant variant : PlainScan().setup.variants) {
    if (variant.kind != EffectVariant::Kind::kWave) continue;
    Judged judged;
    for (const double size : {0.1, 0.03}) {
      double phase = 0;
      bool sine = false;
      std::map<std::string, double> values;
      double amplitude = 0;
      for (const model::ParameterInfo& parameter : model::FindEffect(variant.at.id)->parameters) {
        if (parameter.role == model::Role::kPeriods) values[parameter.name] = kPeriods;
        if (parameter.role == model::Role::kPhase) values[parameter.name] = phase = 0.4, sine = true;
        if (parameter.role == model::Role::kTorqueWave) values[parameter.name] = amplitude = 40 * size;
        if (parameter.role == model::Role::kDisplacementWave) values[parameter.name] = amplitude = size;
      }
      const CleanScan scan =
          ScanClean(PlainMachine(), RunsOf(With(variant, values)), {variant}, {}, {kPeriods});
      std::vector<Share> shares;
      for (size_t run = 0; run < scan.motions.size(); ++run) {
        for (const bool part : {true, false}) {
          const int column = scan.Column(variant.set + "|" + std::to_string(kPeriods) +
                                         (part ? ":sin[" : ":cos[") + std::to_string(run) + "]");
          const double unit = scan.setup.units[static_cast<size_t>(column)];
          const double share = !sine ? (part ? 0 : 1) : part ? std::cos(phase) : std::sin(phase);
          if (unit != 0) shares.push_back({column, amplitude * share / unit});
        }
      }
      judged.Add(Compare(scan, shares));
    }
    judged.Expect(variant.set);
    EXPECT_FALSE(judged.met.empty()) << variant.set << " shows nowhere";
  }
}

}  // namespace
}  // namespace hydro::testing
