// Models drawn from what is known of one.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "model/terms/description.h"
#include "model/terms/parameter_info.h"
#include "tests/table1.h"

namespace hydro::testing {
namespace {

using model::BaseParameters;
using model::BasePlace;

constexpr int kDraws = 20000;

model::ModelDescription Known() {
  model::ModelDescription known;
  known.name = "known";
  known.parameters = Table1();
  known.parameters.mgl = -562;
  known.uncertainty = {{"J", 0.2}};
  return known;
}

// Tests that each parameter's logarithm is normal about its value, with the stated deviation or that of its
// kind: mean, variance, third and fourth moment.
TEST(DrawnModel, HasTheStatedDeviations) {
  const model::ModelDescription known = Known();
  std::vector<std::vector<double>> deviations(BaseParameters().size());
  for (uint64_t i = 0; i < kDraws; ++i) {
    const model::ModelDescription drawn = DrawnModel(known, 1, i);
    for (size_t base = 0; base < BaseParameters().size(); ++base) {
      const auto member = BaseParameters()[base].member;
      if (known.parameters.*member == 0) continue;
      const double change = drawn.parameters.*member / (known.parameters.*member);
      const double stated =
          BaseParameters()[base].info.name == "J" ? 0.2 : BaseParameters()[base].uncertainty;
      deviations[base].push_back(std::log(change) / stated);
    }
  }
  for (const std::vector<double>& of_one : deviations) {
    double moments[5] = {};
    for (const double z : of_one) {
      for (int power = 1; power <= 4; ++power) moments[power] += std::pow(z, power) / kDraws;
    }
    if (of_one.empty()) continue;  // f, which is 0
    // Five standard errors each, with the variances of a normal distribution's moments: 1, 2, 15 and 96.
    EXPECT_NEAR(moments[1], 0, 5 / std::sqrt(kDraws));
    EXPECT_NEAR(moments[2], 1, 5 * std::sqrt(2.0 / kDraws));
    EXPECT_NEAR(moments[3], 0, 5 * std::sqrt(15.0 / kDraws));
    EXPECT_NEAR(moments[4], 3, 5 * std::sqrt(96.0 / kDraws));
  }
}

// Tests that no two parameters, neighbouring draws or seeds have to do with each other.
TEST(DrawnModel, AreIndependent) {
  const double allowed = 6 / std::sqrt(kDraws);  // of 150 correlations
  const auto correlation = [](const auto& first, const auto& second) {
    double sum = 0;
    for (uint64_t i = 0; i < kDraws; ++i) sum += first(i) * second(i);
    return sum / kDraws;
  };
  const auto drawn = [](const std::string& name, uint64_t seed = 1, uint64_t shift = 0) {
    return [=](uint64_t i) { return model::DrawnDeviation(seed, i + shift, name); };
  };
  for (const model::BaseParameter& a : BaseParameters()) {
    const std::string& name = a.info.name;
    EXPECT_NEAR(correlation(drawn(name), drawn(name, 1, 1)), 0, allowed) << name;
    EXPECT_NEAR(correlation(drawn(name), drawn(name, 2)), 0, allowed) << name;
    for (const model::BaseParameter& b : BaseParameters()) {
      if (&b == &a) break;
      EXPECT_NEAR(correlation(drawn(name), drawn(b.info.name)), 0, allowed) << name << ' ' << b.info.name;
    }
  }
}

// Tests that draws are the same bits in any order, and that a parameter's is the same whatever is known of
// the others.
TEST(DrawnModel, DependOnNothingElse) {
  const model::ModelDescription known = Known();
  const model::Parameters fifth = DrawnModel(known, 3, 5).parameters;
  std::set<double> values;
  for (uint64_t i = 10; i-- > 0;) {
    const model::Parameters again = DrawnModel(known, 3, i).parameters;
    values.insert(again.J_a);
    if (i != 5) continue;
    for (const model::BaseParameter& parameter : BaseParameters()) {
      EXPECT_EQ(again.*parameter.member, fifth.*parameter.member) << parameter.info.name;
    }
  }
  EXPECT_EQ(values.size(), 10);
  model::ModelDescription other = known;
  other.parameters.J *= 3;
  other.uncertainty = {{"D", 1.0}, {"T_s", 1e-3}};
  EXPECT_EQ(DrawnModel(other, 3, 5).parameters.J_a, fifth.J_a);
  EXPECT_NE(DrawnModel(other, 3, 5).parameters.D, fifth.D);
  EXPECT_NE(DrawnModel(known, 4, 5).parameters.J_a, fifth.J_a);
  // From the definition, computed by a program of its own (Python).
  EXPECT_NEAR(model::DrawnDeviation(1, 0, "k_1"), 0.42236109346485684, 1e-14);
  EXPECT_NEAR(model::DrawnDeviation(20, 9999, "J_a"), -0.025897216494027653, 1e-14);
  EXPECT_NEAR(model::DrawnDeviation(~uint64_t{0}, 3, "mgl"), 1.056335989499442, 1e-14);
}

// Tests that signs and bounds stay however little is known, that 0 stays 0, and that nothing else changes.
TEST(DrawnModel, StaysPhysical) {
  model::ModelDescription known = Known();
  for (const model::BaseParameter& parameter : BaseParameters()) known.uncertainty[parameter.info.name] = 100;
  known.effects.push_back({.id = "amp.lag", .parameters = {{"tau", 0.001}}, .names = {}});
  for (uint64_t i = 0; i < 1000; ++i) {
    const model::ModelDescription drawn = DrawnModel(known, 1, i);
    for (const model::BaseParameter& parameter : BaseParameters()) {
      const double given = known.parameters.*parameter.member;
      const double value = drawn.parameters.*parameter.member;
      ASSERT_TRUE(std::isfinite(value));
      ASSERT_EQ(std::signbit(value), std::signbit(given)) << parameter.info.name;
      ASSERT_EQ(value == 0, given == 0) << parameter.info.name;
      ASSERT_LE(value, parameter.info.max);
    }
    ASSERT_EQ(drawn.name, "known");
    ASSERT_EQ(drawn.uncertainty, known.uncertainty);
    ASSERT_EQ(drawn.effects.size(), 1);
    ASSERT_EQ(drawn.effects[0].parameters, known.effects[0].parameters);
  }
}

// Tests the size of a step of so many deviations.
TEST(DrawnModel, DeviatesByFactors) {
  model::ModelDescription model = Known();
  const double before = model.parameters.T_s;
  Deviate(&model, BasePlace("T_s"), 1);
  EXPECT_DOUBLE_EQ(model.parameters.T_s, before * std::exp(0.3));
  Deviate(&model, BasePlace("T_s"), -1);
  EXPECT_DOUBLE_EQ(model.parameters.T_s, before);
  Deviate(&model, BasePlace("J"), 2);
  EXPECT_DOUBLE_EQ(model.parameters.J, Known().parameters.J * std::exp(0.4));
}

}  // namespace
}  // namespace hydro::testing
