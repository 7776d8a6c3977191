// The score test: it finds the hidden change before anything is refitted.
#include "diagnose/search/scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

// Every effect without names, sensor.skew of one channel, and every base parameter but f, which duplicates
// pump.pressure_friction.
std::vector<diagnose::Change> AllChanges() {
  std::vector<diagnose::Change> changes;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (info.id == "sensor.sign") continue;
    changes.push_back({info.id, {}, ""});
    if (info.id == "sensor.skew") changes.back().names["signal"] = "p1";
  }
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    if (parameter.info.name != "f") changes.push_back({"", {}, parameter.info.name});
  }
  return changes;
}

// Runs of a rig, and Table 1 fitted to them as given.
struct Case {
  explicit Case(const model::ModelDescription& truth)
      : runs(OneOfEach(truth, 0.4, 1)), pointers(PointersTo(runs)) {
    current = diagnose::Fit(WithFree(Table1With(), {}), pointers, StartsOf(runs), {});
    sizes = diagnose::SizesOf(Table1With(), pointers);
  }
  std::vector<std::vector<diagnose::Scanned>> Judge(const std::vector<diagnose::Change>& changes,
                                                    int jobs = 1) const {
    return diagnose::Scan(current, pointers, changes, sizes, false, jobs);
  }

  std::vector<diagnose::RunData> runs;
  std::vector<const diagnose::RunData*> pointers;
  diagnose::Fitted current;
  diagnose::Sizes sizes;
};

model::ModelDescription Frictional() { return Table1With({{"pump.pressure_friction", {{"f", 4e-4}}, {}}}); }

// Tests that a change which acts linearly is ranked first, with the drop that its refit brings, and that the
// refit has little left to do.
TEST(Scan, RanksTheHiddenChangeFirst) {
  const Case one(Frictional());
  ASSERT_TRUE(one.current.ok());
  const std::vector<diagnose::Change> changes = AllChanges();
  const auto scanned = one.Judge(changes);
  ASSERT_EQ(scanned.size(), changes.size());
  const diagnose::Scanned* best = &scanned[0].front();
  for (const auto& rows : scanned) {
    ASSERT_FALSE(rows.empty());
    if (rows.front().failure.empty() && rows.front().expected > best->expected) best = &rows.front();
  }
  EXPECT_EQ(best->change.Label(), "pump.pressure_friction");
  diagnose::FitOptions options;
  options.tolerance = 1e-6;
  const diagnose::Fitted refit = diagnose::Fit(best->start, one.pointers, StartsOf(one.runs), options);
  ASSERT_TRUE(refit.ok());
  const double fall = one.current.sum - refit.sum;
  EXPECT_NEAR(best->expected, fall, 0.1 * fall);
  EXPECT_NEAR(refit.squared_gap(), 1, 0.1);
  EXPECT_NEAR(best->start.Free()[0].value, 4e-4, 0.2 * 4e-4);
}

// Tests that changes that share a simulation get the same numbers as alone.
TEST(Scan, TogetherAsAlone) {
  const Case one(Frictional());
  const std::vector<diagnose::Change> changes = AllChanges();
  const auto together = one.Judge(changes);
  double largest = 0;
  for (const auto& rows : together) largest = std::max(largest, rows.front().expected);
  for (size_t c = 0; c < changes.size(); ++c) {
    const auto alone = one.Judge({changes[c]});
    ASSERT_EQ(alone[0].size(), together[c].size());
    for (size_t s = 0; s < alone[0].size(); ++s) {
      EXPECT_EQ(alone[0][s].failure, together[c][s].failure) << changes[c].Label();
      EXPECT_NEAR(alone[0][s].expected, together[c][s].expected,
                  1e-3 * std::abs(alone[0][s].expected) + 1e-5 * largest)
          << changes[c].Label();
    }
  }
}

// Tests that with nothing missing no change promises more than chance would.
TEST(Scan, PromisesNothingWhereNothingIsMissing) {
  const Case one(Table1With());
  for (const auto& rows : one.Judge(AllChanges())) {
    if (!rows.front().failure.empty()) continue;
    EXPECT_LT(rows.front().expected, 0.01 * static_cast<double>(one.current.count))
        << rows.front().change.Label();
  }
}

// Tests that a parameter that is already free promises nothing more: derivatives are projected off those of
// all free ones.
TEST(Scan, WhatIsFreeAlreadyGainsNothing) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b = 0.02;
  const Case one(truth);
  const auto before = one.Judge({{"", {}, "b"}, {"", {}, "k_1"}});
  EXPECT_GT(before[0].front().expected, 1000);
  diagnose::FitOptions options;
  options.tolerance = 1e-6;
  const diagnose::Fitted fitted =
      diagnose::Fit(WithFree(Table1With(), {"b"}), one.pointers, StartsOf(one.runs), options);
  const auto after = diagnose::Scan(fitted, one.pointers, {{"", {}, "k_1"}, {"pump.quadratic_drag", {}, ""}},
                                    one.sizes, false, 1);
  for (const auto& rows : after) EXPECT_LT(rows.front().expected, 0.02 * before[0].front().expected);
}

// Tests that the order and the bits do not depend on the number of threads.
TEST(Scan, SameBitsForAnyNumberOfThreads) {
  const Case one(Frictional());
  const std::vector<diagnose::Change> changes = AllChanges();
  const auto a = one.Judge(changes, 1), b = one.Judge(changes, 2);
  for (size_t c = 0; c < changes.size(); ++c) {
    ASSERT_EQ(a[c].size(), b[c].size());
    for (size_t s = 0; s < a[c].size(); ++s) EXPECT_EQ(a[c][s].expected, b[c][s].expected);
  }
}

}  // namespace
}  // namespace hydro::testing
