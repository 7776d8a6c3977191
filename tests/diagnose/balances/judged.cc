#include "tests/diagnose/balances/judged.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnose/balances/clean_runs.h"

namespace hydro::testing {

using diagnose::BalanceKind;

namespace {

// A sign that is wrong makes -1.
constexpr double kCorrelation = 0.98;
// Where the balance is linear in the amount the rest is smoothing, of a tenth at most; a friction that turns,
// or sticks, within the smoothing takes some per cent of the column.
constexpr double kRatio = 0.06;

struct Tolerance {
  double correlation = kCorrelation, ratio = kRatio;
};
Tolerance ToleranceOf(const std::string& effect, const Comparison& where) {
  // Leakage and friction change exponentially with time, by a half in these runs where they show in the
  // torque.
  if (effect == "fluid.warming") return {.ratio = 0.45};
  // Except in the slow run, the pump passes the speeds of the excess within the smoothing.
  if (effect == "pump.stribeck" && where.run != "slow") return {.correlation = 0.85, .ratio = 0.2};
  // In the slow run the shaft stops and starts within the smoothing, where friction in proportion to the
  // speed is small.
  if (effect == "pump.shear_thinning" && where.run == "slow") return {.correlation = 0.94};
  return {};
}

// Whether a balance changes otherwise than by what the effect adds to it.
bool IsBeside(const std::string& effect, BalanceKind balance) {
  // Soft oil makes a side near the level look as if it were held there.
  return effect == "fluid.entrained_air" && balance >= BalanceKind::kLevel1;
}

// Each effect that is looked for without being asked for, with each name that it can take.
std::vector<diagnose::Change> AllChanges() {
  std::vector<diagnose::Change> changes;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (info.on_request || info.of_bare_motors) continue;
    std::vector<diagnose::Change> here = {{info.id, {}, ""}};
    for (const model::ParameterInfo& parameter : info.parameters) {
      if (!parameter.is_name()) continue;
      std::vector<diagnose::Change> named;
      for (const diagnose::Change& one : here) {
        for (const std::string& name : parameter.names) {
          named.push_back(one);
          named.back().names[parameter.name] = name;
        }
      }
      here = named;
    }
    changes.insert(changes.end(), here.begin(), here.end());
  }
  return changes;
}

}  // namespace

double Smoothing(BalanceKind balance) {
  constexpr double kLeast[] = {0.1, 2e-3, 2e-3, 0.2, 1, 1};
  static const std::vector<Comparison> plain = [] {
    const model::ModelDescription given = PlainMachine();
    return Compare(ScanClean(given, Prepared(MeasureAll(given), given.parameters), {}), {});
  }();
  double most = kLeast[static_cast<size_t>(balance)];
  for (const Comparison& one : plain) {
    const bool level = balance >= BalanceKind::kLevel1 && one.balance >= BalanceKind::kLevel1;
    if (one.balance == balance || level) most = std::max(most, one.left);
  }
  return most;
}

void Judged::Add(const std::vector<Comparison>& all, const std::string& effect) {
  for (const Comparison& one : all) {
    const Tolerance allowed = ToleranceOf(effect, one);
    const std::pair<std::string, BalanceKind> place = {one.run, one.balance};
    if (IsBeside(effect, one.balance)) continue;
    if (std::max(one.said, one.left) < kAboveSmoothing * Smoothing(one.balance)) continue;
    const double ratio = one.said > 0 ? one.correlation * one.left / one.said : 0;
    if (one.correlation > allowed.correlation && std::abs(ratio - 1) < allowed.ratio) {
      met.insert(place);
    } else {
      failed[place] += "\n  " + one.run + ", " + NameOf(one.balance) + ": correlation " +
                       std::to_string(one.correlation) + ", left over said " + std::to_string(ratio);
    }
  }
}

void Judged::Expect(const std::string& what) const {
  for (const auto& [place, text] : failed) EXPECT_TRUE(met.contains(place)) << what << text;
}

std::vector<diagnose::RunData> RunsOf(const model::ModelDescription& truth) {
  return Prepared(MeasureAll(truth), PlainMachine().parameters);
}

const CleanScan& PlainScan() {
  static const CleanScan scan = [] {
    const model::ModelDescription given = PlainMachine();
    const std::vector<diagnose::RunData> runs = RunsOf(given);
    const diagnose::Sizes sizes = diagnose::SizesOf(given, diagnose::PointersTo(runs));
    return ScanClean(given, runs, diagnose::VariantsOf(AllChanges(), sizes));
  }();
  return scan;
}

model::ModelDescription With(const diagnose::EffectVariant& variant,
                             const std::map<std::string, double>& values) {
  model::ModelDescription truth = PlainMachine({variant.at});
  for (const auto& [name, value] : values) truth.effects[0].parameters[name] = value;
  return truth;
}

}  // namespace hydro::testing
