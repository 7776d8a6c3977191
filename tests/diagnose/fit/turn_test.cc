// The shaft's angle at a run's start, where no sensor shows its zero.
#include "diagnose/fit/turn.h"

#include <gmock/gmock.h>

#include <optional>

#include "diagnose/fit/fit.h"
#include "diagnose/fit/residuals.h"
#include "model/terms/state.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::Optional;

model::ModelDescription Cogging() {
  return testing::Table1With({{"motor.cogging", {{"amplitude", 2}, {"periods", 6}, {"phase", 0.7}}, {}}});
}
model::ModelDescription Ripple() {
  return testing::Table1With({{"pump.flow_ripple", {{"amplitude", 0.1}, {"periods", 7}}, {}}});
}

RunData RunFrom(const model::ModelDescription& truth, double turn, bool angle_measured) {
  testing::NoisyRig rig;
  rig.model = truth;
  rig.turn = turn;
  rig.angle_measured = angle_measured;
  return rig.Record("turned", model::Shaft::kClamped, 0.1, 1, false,
                    [](double t) { return t < 0.5 ? 4.0 : -5.0; });
}

// Tests that a shaft's angle is found wherever it starts, with a sensor of it and without, of torque and of
// displacement.
TEST(Turn, IsFoundFromAnywhere) {
  for (const model::ModelDescription& truth : {Cogging(), Ripple()}) {
    for (const double turn : {0.3, 0.55, 0.8}) {
      for (const bool measured : {true, false}) {
        const RunData run = RunFrom(truth, turn, measured);
        Hypothesis held;
        held.model = truth;
        const Fitted fitted = Fit(held, {&run}, {run.start}, {});
        ASSERT_TRUE(fitted.ok());
        EXPECT_LT(fitted.squared_gap(), 1.15) << truth.effects[0].id << " " << turn << " " << measured;
        const double count = static_cast<double>(fitted.count);
        EXPECT_GT(SumOfSquares(truth, run, run.start) / count, 2) << truth.effects[0].id << " " << turn;
      }
    }
  }
}

// Tests when the angle is unknown: never without an effect that repeats; in the run from which phases count,
// where the effect has none; and that the number that stands for it is the sensor's offset, or the start
// itself without a sensor.
TEST(Turn, IsUnknownWhereNothingShowsIt) {
  RunData run = RunFrom(Cogging(), 0, true);
  EXPECT_EQ(UnknownTurn(testing::Table1With(), run), std::nullopt);
  EXPECT_THAT(UnknownTurn(Cogging(), run), Optional(model::kTurn));
  run.angle_counts = true;
  EXPECT_EQ(UnknownTurn(Cogging(), run), std::nullopt);
  EXPECT_THAT(UnknownTurn(Ripple(), run), Optional(model::kTurn));
  EXPECT_THAT(UnknownTurn(Cogging(), RunFrom(Cogging(), 0, false)), Optional(size_t{model::kMotorAngle}));
  EXPECT_EQ(AtBestTurn(Cogging(), run, run.start), run.start);
}

// Tests that a window is searched once for models with the same periods and nearly the same phases, whatever
// else they have, and again for others.
TEST(Turn, IsSearchedOnceForTheSamePeriods) {
  const RunData run = RunFrom(Cogging(), 0.55, true);
  KnownTurns known(2);
  const auto turn = [&](size_t place, const model::ModelDescription& model) {
    return known.Turned(place, model, run, run.start)[model::kTurn];
  };
  const double found = turn(0, Cogging());
  EXPECT_EQ(found, AtBestTurn(Cogging(), run, run.start)[model::kTurn]);

  model::ModelDescription heavy = Cogging(), seven = Cogging();
  heavy.parameters.J *= 2;
  heavy.effects[0].parameters["phase"] = 0.8;
  seven.effects[0].parameters["periods"] = 7;
  const double of_heavy = AtBestTurn(heavy, run, run.start)[model::kTurn];
  ASSERT_NE(of_heavy, found);
  EXPECT_EQ(turn(0, heavy), found);
  EXPECT_EQ(turn(1, heavy), of_heavy);
  EXPECT_EQ(turn(0, seven), AtBestTurn(seven, run, run.start)[model::kTurn]);
  heavy.effects[0].parameters["phase"] = 2.5;
  EXPECT_EQ(turn(0, heavy), AtBestTurn(heavy, run, run.start)[model::kTurn]);
  EXPECT_EQ(known.Turned(0, testing::Table1With(), run, run.start), run.start);
}

}  // namespace
}  // namespace hydro::diagnose
