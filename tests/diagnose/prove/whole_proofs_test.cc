// Tests that exact simulation on held-out runs chooses what is true, on made-up rigs. Under the sanitizers
// each takes a minute or more, so prove_test has there those that end sooner.
#include <gmock/gmock.h>

#include "diagnose/prove/blind_changes.h"
#include "diagnose/prove/chooser.h"
#include "diagnose/say/conclusion.h"
#include "tests/diagnose/prove/made_proofs.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Tests that a true effect that is proposed with a wrong amount is chosen, with the amount mended, before an
// effect that is not there, and that the verdict names it alone.
TEST_F(ProveTest, TrueEffectWithAWrongAmountWins) {
  Record(Table1With({Drag(2e-4)}));
  const Proof proved =
      Prove({Proposed({}, {}), Proposed({kBias}, {Bias(0.5)}), Proposed({kDrag}, {Drag(1.6e-4)})});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag));
  EXPECT_NEAR(ValueOf(proved, "pump.quadratic_drag", "k"), 2e-4, 1e-5);
  EXPECT_LT(NearGap(proved, {kDrag}), 1.2);
  EXPECT_LT(NearGap(proved, {kDrag}), 0.8 * NearGap(proved, {}));
  const diagnose::Diagnosis d = diagnose::Conclude(context_, proved);
  EXPECT_EQ(d.verdict, diagnose::Verdict::kNamed) << d.sentence;
  ASSERT_EQ(d.effects.size(), 1u);
  EXPECT_EQ(d.effects[0].id, "pump.quadratic_drag");
  EXPECT_LE(d.effects[0].parameters[0].low, 2e-4);
  EXPECT_GE(d.effects[0].parameters[0].high, 2e-4);
}

// Tests that both of two true effects are kept.
TEST_F(ProveTest, BothOfTwoAreKept) {
  Record(Table1With({Drag(2e-4), Bias(0.6)}));
  const Proof proved =
      Prove({Proposed({kDrag}, {Drag(2e-4)}), Proposed({kDrag, kBias}, {Drag(1.9e-4), Bias(0.5)})});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag, kBias));
}

// Tests that a wrong value is said as a value, although an effect was proposed for it.
TEST_F(ProveTest, ValueIsAValue) {
  model::ModelDescription truth = Table1With();
  truth.parameters.b *= 1.6;
  Record(truth);
  const Proof proved = Prove({Proposed({kDrag}, {Drag(2e-5)})});
  EXPECT_THAT(proved.Found().changes, IsEmpty());
  EXPECT_NEAR(proved.Found().model.parameters.b, truth.parameters.b, 0.03 * truth.parameters.b);
}

// Tests that the gain of the pressures is said, and nothing of the values, where eight values that are off
// alike would do what it does: torques and flows have no unit of their own.
TEST_F(ProveTest, OneGainForManyValues) {
  constexpr double kGain = 0.05;
  const Change gain = {"sensor.pressure_gain", {}, ""};
  const model::EffectDescription effect = {gain.effect, {{"gain", kGain}}, {}};
  Record(Table1With({effect}));
  Proposal values = Proposed({}, {});
  values.base.clear();
  for (const char* name : {"k_1", "T_pmax", "J", "b", "T_s", "beta", "p_3", "J_a", "mgl", "c_E", "c_I"}) {
    const size_t place = model::BasePlace(name);
    const double by = name[0] == 'c' ? 1 / (1 + kGain) : 1 + kGain;
    values.model.parameters.*model::BaseParameters()[place].member *= by;
    values.base.push_back(place);
  }
  const Proof proved = Prove({values, Proposed({gain}, {effect})});
  EXPECT_LT(NearGap(proved, {}), 1.2);
  EXPECT_THAT(proved.Found().changes, ElementsAre(gain));
  EXPECT_THAT(proved.Found().base, IsEmpty());
  EXPECT_NEAR(ValueOf(proved, gain.effect, "gain"), kGain, 0.002);
}

// Tests that an effect that no balance shows is found by racing it, once the best proposal leaves a gap.
TEST_F(ProveTest, BlindEffectIsRaced) {
  Record(Table1With({{"valve.relief", {{"set", 700}, {"conductance", 2e-3}}, {}}}));
  const Proof proved = Prove({}, diagnose::BlindChanges(context_));
  EXPECT_THAT(proved.Found().changes, ElementsAre(kRelief));
  EXPECT_NEAR(ValueOf(proved, "valve.relief", "set"), 700, 20);
}

// Tests that a speed that is late by less than balances care about, as one that a drive computes, is found by
// racing it; beside a recorded angle it has been moved before.
TEST_F(ProveTest, ALateSpeedIsRaced) {
  const Change skew{"sensor.skew", {{"signal", "motor_speed"}}, ""};
  Record(Table1With({{"sensor.skew", {{"delay", 4e-3}}, {{"signal", "motor_speed"}}}}));
  context_.changes = {skew, {"sensor.skew", {{"signal", "p1"}}, ""}};
  EXPECT_THAT(diagnose::BlindChanges(context_), ::testing::IsEmpty()) << "a recorded angle";
  for (diagnose::RunData& run : runs_) run.measured.motor_angle.values.clear();
  const std::vector<Change> blind = diagnose::BlindChanges(context_);
  EXPECT_THAT(blind, ElementsAre(skew));
  const Proof proved = Prove({}, blind);
  EXPECT_THAT(proved.Found().changes, ElementsAre(skew));
  EXPECT_NEAR(ValueOf(proved, "sensor.skew", "delay"), 4e-3, 1e-3);
}

// Tests that runs are held out in turn where none is named: every other window judges.
TEST_F(ProveTest, InTurn) {
  Record(Table1With({Drag(2e-4)}));
  context_.held_out.clear();
  Proposal drag = Proposed({kDrag}, {Drag(1.8e-4)});
  drag.without.assign(3, drag.model);
  const Proof proved = Prove({drag});
  EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag));
  EXPECT_THAT(proved.runs, ::testing::Contains(runs_[0].name));
}

// Tests that an effect that is not there is left out though it is proposed beside one that is, and no set
// without it was proposed, and that one and two threads give the same bits.
TEST_F(ProveTest, FurtherEffectIsVetoedByAnyNumberOfJobs) {
  Record(Table1With({Drag(2e-4)}));
  std::vector<double> gaps[2];
  double amounts[2] = {};
  for (const int jobs : {1, 2}) {
    context_.jobs = jobs;
    const Proof proved = Prove({Proposed({kBias, kDrag}, {Bias(0.05), Drag(1.9e-4)})});
    EXPECT_THAT(proved.Found().changes, ElementsAre(kDrag));
    EXPECT_LT(NearGap(proved, {kDrag}), 1.2);
    for (const ProvedSet& one : proved.sets) gaps[jobs - 1].push_back(TypicalGap(one.near));
    amounts[jobs - 1] = ValueOf(proved, "pump.quadratic_drag", "k");
  }
  EXPECT_EQ(gaps[0], gaps[1]);
  EXPECT_EQ(amounts[0], amounts[1]);
}

}  // namespace
}  // namespace hydro::testing
