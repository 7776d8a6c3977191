// The scale of torques and flows.
#include "diagnose/fit/likeliest_scale.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/response.h"
#include "tests/diagnose/small_runs.h"
#include "tests/model/some_of_each.h"

namespace hydro::testing {
namespace {

using diagnose::MoveToLikeliestScale;

std::vector<size_t> Places(const std::vector<std::string>& names) {
  std::vector<size_t> places;
  for (const std::string& name : names) places.push_back(model::BasePlace(name));
  return places;
}

const std::vector<size_t>& Everything() {
  static const std::vector<size_t> all =
      Places({"k_1", "T_pmax", "D", "J", "b", "T_s", "beta", "V_ms", "c", "c_E", "c_I", "p_3", "k_2", "J_a"});
  return all;
}

// Table 1, whose geometry is known to one part in a hundred and all else to five.
model::ModelDescription Given() {
  model::ModelDescription given = Table1With();
  for (const char* name : {"D", "V_ms", "c"}) given.uncertainty[name] = 0.01;
  for (const char* name : {"b", "T_s", "c_E", "c_I"}) given.uncertainty[name] = 0.2;
  return given;
}

// The torques of the motor, the flows and the volumes of Table 1, all larger by a factor.
model::Parameters Larger(double by) {
  model::Parameters p = Table1();
  for (double model::Parameters::*member :
       {&model::Parameters::k_1, &model::Parameters::T_pmax, &model::Parameters::D, &model::Parameters::J,
        &model::Parameters::b, &model::Parameters::T_s, &model::Parameters::f, &model::Parameters::V_ms,
        &model::Parameters::c, &model::Parameters::c_E, &model::Parameters::c_I})
    p.*member *= by;
  return p;
}

// The largest difference of a channel, relative to its largest value.
double LargestDifference(const model::Response& a, const model::Response& b) {
  double largest = 0;
  for (size_t c = 0; c < model::kChannels; ++c) {
    double size = 0, difference = 0;
    for (size_t k = 0; k < a.values[c].size(); ++k) {
      size = std::max(size, std::abs(a.values[c][k]));
      difference = std::max(difference, std::abs(a.values[c][k] - b.values[c][k]));
    }
    if (size > 0) largest = std::max(largest, difference / size);
  }
  return largest;
}

// Tests that every effect of the catalogue predicts the same after such a move, so that none of its numbers
// is forgotten.
TEST(MoveToLikeliestScale, PredictsTheSame) {
  const diagnose::RunData run = SmallRun(Table1With(), model::Shaft::kFree, false, 0.3, 0, 1);
  const double by = std::exp(0.095);  // which the search meets exactly
  int moved = 0;
  for (const auto& [id, effect] : SomeOfEach()) {
    SCOPED_TRACE(id);
    model::ModelDescription model{"larger", Larger(by), {effect}};
    const model::Response before = model::Respond(model, run.stimulus, run.start, {}, {});
    MoveToLikeliestScale(Given(), Everything(), {}, &model);
    EXPECT_NEAR(model.parameters.k_1, Table1().k_1, 1e-9);
    const model::Response after = model::Respond(model, run.stimulus, run.start, {}, {});
    EXPECT_LT(LargestDifference(before, after), 1e-9);
    ++moved;
  }
  EXPECT_GT(moved, 15);
}

// Tests that an estimate that holds a wrong k_1 gives its error back to k_1.
TEST(MoveToLikeliestScale, FindsTheWrongOne) {
  model::ModelDescription model{"estimate", Table1(), {}};
  for (double model::Parameters::*member :
       {&model::Parameters::T_pmax, &model::Parameters::D, &model::Parameters::J, &model::Parameters::b,
        &model::Parameters::T_s, &model::Parameters::c, &model::Parameters::c_E, &model::Parameters::c_I})
    model.parameters.*member *= 0.9;
  model.parameters.beta /= 0.9;
  MoveToLikeliestScale(Given(), Everything(), {}, &model);
  EXPECT_NEAR(model.parameters.k_1, Table1().k_1 / 0.9, 3e-3 * Table1().k_1);
  EXPECT_NEAR(model.parameters.D, Table1().D, 2e-3 * Table1().D);
  EXPECT_NEAR(model.parameters.c, Table1().c, 2e-3 * Table1().c);
  EXPECT_NEAR(model.parameters.V_ms, Table1().V_ms, 2e-3 * Table1().V_ms);
  EXPECT_NEAR(model.parameters.beta, Table1().beta, 3e-3 * Table1().beta);
}

// Tests what moves nothing: one value that is far off by itself, small errors, a displacement that the change
// itself calls wrong, and values that may not move.
TEST(MoveToLikeliestScale, MovesNothingWithoutReason) {
  const auto moves = [](const model::Parameters& values, const std::vector<size_t>& base,
                        const std::vector<diagnose::Change>& changes) {
    model::ModelDescription model{"estimate", values, {}};
    MoveToLikeliestScale(Given(), base, changes, &model);
    return model.parameters.k_1 != values.k_1;
  };
  model::Parameters heavy = Table1();
  heavy.J *= 1.4;
  EXPECT_FALSE(moves(heavy, Everything(), {}));
  model::Parameters slight = Table1();
  slight.J *= 1.03;
  slight.D *= 1.01;
  EXPECT_FALSE(moves(slight, Everything(), {}));
  model::Parameters displaced = Table1();
  displaced.D *= 0.8;
  EXPECT_FALSE(moves(displaced, Places({"k_1", "D", "J"}), {{"", {}, "D"}}));
  EXPECT_FALSE(moves(Larger(1.1), Places({"k_1", "J", "b", "T_s"}), {})) << "a bare motor";
  EXPECT_FALSE(moves(Larger(1.1), Places({"D", "J", "b", "T_s"}), {})) << "k_1 is held";
  EXPECT_TRUE(moves(Larger(1.1), Everything(), {}));
}

}  // namespace
}  // namespace hydro::testing
