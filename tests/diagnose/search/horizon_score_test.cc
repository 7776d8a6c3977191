// What a model that is wrong is worth over several horizons.
#include "diagnose/search/horizon_score.h"

#include <gtest/gtest.h>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

// Tests that the rig's own model is at the noise, that a worse model scores higher, and that threads change nothing.
TEST(HorizonScore, OrdersModels) {
  std::vector<diagnose::RunData> runs;
  runs.push_back(SmallRun(Table1With(), model::Shaft::kClamped, false, 2.5, 0, 3));
  const auto score = [&](double friction, int jobs) {
    model::ModelDescription model = Table1With();
    model.parameters.T_s *= friction;
    return diagnose::HorizonScore(model, PointersTo(runs), 0.4, jobs);
  };
  EXPECT_NEAR(score(1, 1), 0, 0.1);
  EXPECT_GT(score(1.1, 1), score(1, 1) + 0.2);
  EXPECT_GT(score(1.5, 1), score(1.1, 1) + 0.2);
  EXPECT_EQ(score(1.1, 2), score(1.1, 1));
}

}  // namespace
}  // namespace hydro::testing
