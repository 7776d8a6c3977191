// Tests that each column says what the thing it stands for does to each balance: machines with one thing more
// are simulated exactly, and what their balances leave for the plain model must be minus the column times the
// true amount.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "tests/diagnose/balances/clean_runs.h"
#include "tests/diagnose/balances/clean_scan.h"
#include "tests/diagnose/balances/judged.h"

namespace hydro::testing {
namespace {

using diagnose::BalanceKind;
using diagnose::EffectVariant;

// Of the amount's unit, 15 % of the balance: what is not linear is met by one of the smaller ones, what is
// small by the largest.
constexpr double kAmounts[] = {1, 0.3, 0.1, 0.03};

// What these runs cannot show.
const std::map<std::string, std::string>& Unseen() {
  static const std::map<std::string, std::string> unseen = {
      {"sensor.skew(motor_angle)", "the speed is measured, and nothing repeats with the shaft"},
  };
  return unseen;
}

// An effect shows at one of its shapes at least.
void ExpectOneOfEach(EffectVariant::Kind kind, const std::set<std::string>& met) {
  for (const EffectVariant& variant : PlainScan().setup.variants) {
    if (variant.kind != kind || Unseen().contains(variant.set)) continue;
    EXPECT_TRUE(met.contains(variant.at.id)) << variant.set << " shows nowhere";
  }
}

// Tests that each effect is tried, but what has no number of how much of it there is.
TEST(Columns, AreThereForEveryEffect) {
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (info.on_request || info.of_bare_motors) continue;
    const std::vector<EffectVariant>& variants = PlainScan().setup.variants;
    const bool tried = std::any_of(variants.begin(), variants.end(),
                                   [&](const EffectVariant& variant) { return variant.at.id == info.id; });
    EXPECT_EQ(tried, info.id != "sensor.sign") << info.id;
  }
}

// Tests base parameters: amounts are relative deviations.
TEST(Columns, OfBaseParametersMeetTheSimulation) {
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) {
    const model::BaseParameter& base = model::BaseParameters()[i];
    const bool fixed = base.info.name == "k_1" || base.info.name == "k_2";
    Judged judged;
    for (const double part : {1.0, 0.3, 0.1, 0.03}) {
      model::ModelDescription truth = PlainMachine();
      double& value = truth.parameters.*base.member;
      const double given = value;
      // What Table 1 has at 0: of a tenth of the arm's weight or of the motor's torque.
      const double unit = given != 0 ? given : base.info.name == "f" ? 1e-3 : 100;
      value += part * unit;
      const CleanScan scan = ScanClean(PlainMachine(), RunsOf(truth), {}, {i});
      if (fixed) {
        EXPECT_TRUE(std::none_of(scan.table.columns.begin(), scan.table.columns.end(),
                                 [&](const auto& one) { return one.name == base.info.name; }));
        continue;
      }
      const int column = scan.Column(base.info.name);
      // A bulk modulus divides.
      const double by = base.info.name == "beta" ? part / (1 + part) : part;
      const double amount = by * unit / (given != 0 ? given : scan.setup.units[static_cast<size_t>(column)]);
      std::vector<Comparison> all = Compare(scan, {{column, amount}});
      // The flows measure all else by D.
      if (base.info.name == "D")
        std::erase_if(all, [](const Comparison& one) { return one.balance != BalanceKind::kTorque; });
      judged.Add(all);
    }
    if (fixed) continue;
    judged.Expect(base.info.name);
    EXPECT_FALSE(judged.met.empty()) << base.info.name << " shows nowhere";
  }
}

// Tests each amount in which an effect is linear near 0.
TEST(Columns, OfAmountsMeetTheSimulation) {
  std::set<std::string> seen;
  for (const EffectVariant& variant : PlainScan().setup.variants) {
    if (variant.kind != EffectVariant::Kind::kAmounts || Unseen().contains(variant.set)) continue;
    for (const std::string& name : variant.amounts) {
      const std::string column = variant.set + ":" + name;
      const auto place = static_cast<size_t>(PlainScan().Column(column));
      Judged judged;
      for (const double amount : kAmounts) {
        const double value = amount * PlainScan().setup.units[place];
        const CleanScan scan = ScanClean(PlainMachine(), RunsOf(With(variant, {{name, value}})), {variant});
        const int found = scan.Column(column);
        judged.Add(Compare(scan, {{found, value / scan.setup.units[static_cast<size_t>(found)]}}),
                   variant.at.id);
      }
      judged.Expect(column);
      if (!judged.met.empty()) seen.insert(variant.at.id);
    }
  }
  ExpectOneOfEach(EffectVariant::Kind::kAmounts, seen);
}

// Tests effects that stand as they are at points of a grid, and the derivatives by what has no grid.
TEST(Columns, OfWholeEffectsMeetTheSimulation) {
  std::set<std::string> seen;
  for (const EffectVariant& variant : PlainScan().setup.variants) {
    if (variant.kind != EffectVariant::Kind::kWhole) continue;
    const CleanScan scan = ScanClean(PlainMachine(), RunsOf(With(variant, {})), {variant});
    Judged judged;
    judged.Add(Compare(scan, {{scan.Column(variant.set + ":whole"), 1}}), variant.at.id);
    judged.Expect(variant.set);
    if (!judged.met.empty()) seen.insert(variant.at.id);
    for (const std::string& moved : variant.moved) {
      constexpr double kBy = 0.1;
      const double value = variant.at.parameters.at(moved) * std::exp(kBy);
      const CleanScan apart = ScanClean(PlainMachine(), RunsOf(With(variant, {{moved, value}})), {variant});
      const int whole = apart.Column(variant.set + ":whole"), more = apart.Column(variant.set + ":" + moved);
      const std::vector<Comparison> without = Compare(apart, {{whole, 1}}),
                                    with = Compare(apart, {{whole, 1}, {more, kBy}});
      for (size_t i = 0; i < with.size(); ++i) {
        if (without[i].apart < kAboveSmoothing * Smoothing(with[i].balance)) continue;
        EXPECT_LT(with[i].apart, 0.3 * without[i].apart)
            << variant.set << " " << moved << " " << NameOf(with[i].balance) << " " << with[i].run;
      }
    }
  }
  ExpectOneOfEach(EffectVariant::Kind::kWhole, seen);
}

}  // namespace
}  // namespace hydro::testing
