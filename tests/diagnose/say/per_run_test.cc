// Values that belong to a run.
#include "diagnose/say/per_run.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using ::testing::HasSubstr;

// Three runs of a rig whose Coulomb friction is this many times that of its model, the last held out.
struct Days {
  std::vector<diagnose::RunData> runs;
  diagnose::ProofContext context;
  std::vector<size_t> allowed;

  explicit Days(const std::vector<double>& frictions) {
    for (size_t i = 0; i < frictions.size(); ++i) {
      model::ModelDescription rig = Table1With();
      rig.parameters.T_s *= frictions[i];
      runs.push_back(SmallRun(rig, model::Shaft::kClamped, false, 2.5, static_cast<int>(i), 7));
    }
    context.given = Table1With();
    context.runs = PointersTo(runs);
    context.held_out = {context.runs.back()};
    context.runs.pop_back();
    for (const char* name : {"k_1", "J", "T_s", "beta"}) allowed.push_back(model::BasePlace(name));
  }

  std::vector<diagnose::ValueByRun> Found(const std::vector<std::string>& asked = {}) const {
    return diagnose::ValuesByRun(context, context.given, asked, allowed);
  }
};

// Tests that friction of the day is found, with the value of each run and the gap that it takes.
TEST(ValuesByRun, FrictionOfTheDay) {
  const std::vector<diagnose::ValueByRun> found = Days({1, 1.2, 0.8}).Found();
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "T_s");
  EXPECT_EQ(found[0].unit, "in-lbf");
  ASSERT_EQ(found[0].values.size(), 3u);
  const double expected[] = {1, 1.2, 0.8};
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(found[0].values[i].value / Table1().T_s, expected[i], 0.02) << found[0].values[i].name;
    EXPECT_LE(found[0].values[i].low, found[0].values[i].value);
    EXPECT_GE(found[0].values[i].high, found[0].values[i].value);
  }
  EXPECT_NEAR(found[0].Spread(), 0.2, 0.02);
  EXPECT_LT(found[0].after, 0.8 * found[0].before);
  EXPECT_THAT(diagnose::RemarkOn(found[0]), HasSubstr("T_s differs from run to run by 20 %"));
  EXPECT_THAT(diagnose::RemarkOnOwnValues({"T_s"}),
              HasSubstr("so the held-out gap tests everything but T_s, which windows"));
  // The parts of a single recording are no runs.
  const diagnose::ValueByRun parts{
      "T_s", "in-lbf", {{"rig", 4, 4, 4, ""}, {"rig, last third", 6, 6, 6, ""}}, 2, 1};
  EXPECT_THAT(diagnose::RemarkOn(parts),
              HasSubstr("T_s differs from one part of the recording to the other by"));
  diagnose::ValueByRun unconfirmed = parts;
  unconfirmed.after = 2.1;
  EXPECT_THAT(diagnose::RemarkOn(unconfirmed), HasSubstr("neither confirm nor deny it"));
}

// Tests that runs of one rig have no values of their own, unless they are asked for.
TEST(ValuesByRun, NoneWhereNoneDiffers) {
  const Days same({1, 1, 1});
  EXPECT_TRUE(same.Found().empty());
  const std::vector<diagnose::ValueByRun> asked = same.Found({"J"});
  ASSERT_EQ(asked.size(), 1u);
  EXPECT_EQ(asked[0].name, "J");
  EXPECT_LT(asked[0].Spread(), 0.02);
  EXPECT_EQ(diagnose::RemarkOn(asked[0]), "J does not differ from run to run");
  EXPECT_TRUE(same.Found({"k_1"}).empty());  // what torques are measured by
}

}  // namespace
}  // namespace hydro::testing
