// An effect gives way to a parameter only where that does as well, by a small move, beside another effect.
#include "diagnose/search/parameter_instead.h"

#include <gtest/gtest.h>

#include <utility>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

const diagnose::Change kRipple = {"pump.flow_ripple", {}, ""},
                       kAsymmetry = {"pump.friction_asymmetry", {}, ""}, kFriction = {"", {}, "T_s"};

diagnose::Explanation Of(std::vector<diagnose::Change> changes, double squared_gap, double factor = 1) {
  diagnose::Explanation one;
  one.fitted.hypothesis.model = Table1With();
  one.fitted.hypothesis.model.parameters.T_s *= factor;
  one.fitted.hypothesis.changes = std::move(changes);
  one.held_out.sum = 1000 * squared_gap;
  one.held_out.count = 1000;
  one.blocks.sums = {one.held_out.sum};
  return one;
}

const diagnose::Explanation* Instead(const diagnose::Explanation& best, const diagnose::Explanation& other) {
  static diagnose::SearchResult search;
  search = {};
  search.best = best;
  search.tried = {best, other};
  return diagnose::ParameterInstead(search, Table1With());
}

// Tests that a small move of a parameter that predicts as well takes an effect's place.
TEST(ParameterInstead, TakesThePlaceOfATinyEffect) {
  const diagnose::Explanation* instead =
      Instead(Of({kRipple, kAsymmetry}, 1.04), Of({kRipple, kFriction}, 1.12, 0.999));
  ASSERT_NE(instead, nullptr);
  EXPECT_TRUE(instead->fitted.hypothesis.Has(kFriction));
}

// Tests that it does not when it predicts worse, moves further, was not asked to predict, replaces no effect,
// leaves no other effect, or differs by more than that.
TEST(ParameterInstead, AndOtherwiseNot) {
  const diagnose::Explanation best = Of({kRipple, kAsymmetry}, 1.04);
  EXPECT_EQ(Instead(best, Of({kRipple, kFriction}, 1.3, 0.999)), nullptr);
  EXPECT_EQ(Instead(best, Of({kRipple, kFriction}, 1.04, 0.98)), nullptr);
  diagnose::Explanation fitted_only = Of({kRipple, kFriction}, 1.04, 0.999);
  fitted_only.blocks.sums.clear();
  EXPECT_EQ(Instead(best, fitted_only), nullptr);
  EXPECT_EQ(Instead(Of({kRipple, {"", {}, "b"}}, 1.04), Of({kRipple, kFriction}, 1.04, 0.999)), nullptr);
  EXPECT_EQ(Instead(Of({kRipple}, 1.04), Of({kFriction}, 1.04, 0.999)), nullptr);
  EXPECT_EQ(Instead(best, Of({{"amp.lag", {}, ""}, kFriction}, 1.04, 0.999)), nullptr);
}

}  // namespace
}  // namespace hydro::testing
