// How what was proved is described: shares, weights, ties and values.
#include "diagnose/say/found.h"

#include <gmock/gmock.h>

#include "diagnose/say/claims.h"
#include "tests/diagnose/say/made_up.h"

namespace hydro::testing {
namespace {

using diagnose::Diagnosis;
using diagnose::Proof;
using diagnose::ProvedSet;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

diagnose::ProofContext OfTable1() {
  diagnose::ProofContext context;
  context.given = Table1With();
  return context;
}

// A lag that takes nearly all of the gap, beside these other sets.
Proof OfALag(const std::vector<ProvedSet>& others) {
  std::vector<ProvedSet> sets = {Leaving(100, Freed({})), Leaving(81, Freed({"b", "T_s", "J", "beta"}))};
  sets.insert(sets.end(), others.begin(), others.end());
  sets.push_back(Leaving(1, Freed({}, {kLag}), 1.2));
  return ProofOf(std::move(sets));
}

Diagnosis Described(const Proof& proof, std::vector<diagnose::WeightedSet> explanations = {},
                    size_t set_90 = 1) {
  Diagnosis d;
  d.explanations = std::move(explanations);
  d.set_90 = set_90;
  DescribeFound(OfTable1(), proof, &d);
  return d;
}

// Tests that the weight is that of all explanations that have the effect.
TEST(DescribeFound, WeightsOfTheBalances) {
  const Diagnosis d =
      Described(OfALag({}), {{{"amp.lag"}, 0.5}, {{"amp.lag", "valve.relief"}, 0.2}, {{"amp.delay"}, 0.3}});
  ASSERT_THAT(d.effects, SizeIs(1));
  EXPECT_NEAR(d.effects[0].weight, 0.7, 1e-12);
  const diagnose::Change skew{"sensor.skew", {{"signal", "p1"}}, ""};
  EXPECT_EQ(diagnose::NameInSets(skew), "sensor.skew(p1)");
  EXPECT_EQ(diagnose::WeightOf(skew, {{{"sensor.skew(p1)"}, 0.4}, {{"sensor.skew(p2)"}, 0.6}}), 0.4);
}

// Tests shares: of what was proved without the effect, as a part of the gap that the model's own values
// leave.
TEST(DescribeFound, SharesOfTheTypicalGap) {
  const Proof both =
      ProofOf({Leaving(1000, Freed({})), Leaving(101, Freed({"b"})), Leaving(81, Freed({}, {kRelief})),
               Leaving(11, Freed({}, {kLag})), Leaving(1, Freed({}, {kLag, kRelief}))});
  const Diagnosis d = Described(both);
  ASSERT_THAT(d.effects, SizeIs(2));
  EXPECT_NEAR(d.effects[0].share, 0.8, 1e-12);
  EXPECT_NEAR(d.effects[1].share, 0.1, 1e-12);
  const Proof nothing = ProofOf({Leaving(0.98, Freed({})), Leaving(0.9, Freed({}, {kLag}))});
  EXPECT_TRUE(std::isnan(Described(nothing).effects[0].share)) << "there is no gap to take";
}

// Tests that a likely explanation that predicts as well within the scatter of windows is a tie, and that one
// that predicts worse, one that is not likely, and a part of what was found are none.
TEST(DescribeFound, TiesThatTheProofDoesNotTellApart) {
  const ProvedSet delay = Leaving(1.05, Freed({}, {kDelay}), 1 / 1.2), drag = Leaving(9, Freed({}, {kDrag}));
  const Proof proof = OfALag({delay, drag});
  const std::vector<diagnose::WeightedSet> said = {
      {{"amp.lag"}, 0.4}, {{"amp.delay"}, 0.3}, {{"pump.quadratic_drag"}, 0.3}};
  EXPECT_THAT(Described(proof, said, 3).effects[0].tied_with, ElementsAre("amp.delay"));
  EXPECT_THAT(Described(proof, said, 1).effects[0].tied_with, IsEmpty());
  EXPECT_THAT(Described(proof).effects[0].tied_with, ElementsAre("amp.delay"))
      << "where balances say nothing";
}

// Tests that weights tell apart what windows do not only by nine to one: an effect of a third of the weight
// is a tie, one of a fiftieth is none.
TEST(DescribeFound, TiesWhatWeightsDoNotSeparate) {
  const Proof proof = OfALag({Leaving(1.0, Freed({}, {kDelay}), 1.2)});
  EXPECT_THAT(Described(proof, {{{"amp.lag"}, 0.7}, {{"amp.delay"}, 0.3}}, 2).effects[0].tied_with,
              ElementsAre("amp.delay"));
  EXPECT_THAT(Described(proof, {{{"amp.lag"}, 0.98}, {{"amp.delay"}, 0.02}}, 2).effects[0].tied_with,
              IsEmpty());
}

// Tests that over two whole runs, whose gaps scatter, what leaves most of the gap replaces nothing.
TEST(DescribeFound, WhatLeavesMostOfWholeRunsIsNoTie) {
  const ProvedSet value = Leaving({2.4, 1.4}, Freed({"b"}, {{"", {}, "b"}}));
  Proof proof = ProofOf({Leaving({2.5, 1.5}, Freed({})), value, Leaving({0.9, 1.1}, Freed({}, {kLag}))});
  EXPECT_THAT(Described(proof).effects[0].tied_with, ElementsAre("parameter b")) << "of windows";
  proof.seconds = 0;
  EXPECT_THAT(Described(proof).effects[0].tied_with, IsEmpty());
}

// Tests that what balances cannot see may stand in an effect's place whatever they say, that other values
// may, and that a curve may not.
TEST(DescribeFound, TiesWithTheUnseenAndWithValues) {
  const ProvedSet relief = Leaving(1, Freed({}, {kRelief}), 1 / 1.2);
  const ProvedSet curve = Leaving(1, Freed({}, {{"closure.pump_torque", {}, ""}}), 1 / 1.2);
  const ProvedSet value = Leaving(1, Freed({"b"}, {{"", {}, "b"}}), 1 / 1.2);
  const Proof proof = OfALag({relief, curve, value});
  EXPECT_THAT(Described(proof, {{{"amp.lag"}, 1.0}}).effects[0].tied_with,
              ElementsAre("valve.relief", "parameter b"));
  EXPECT_THAT(Described(proof, {{{"amp.lag"}, 0.6}, {{"value.b"}, 0.4}}, 2).effects[0].tied_with,
              ElementsAre("valve.relief", "parameter b"));
}

// Tests each kind of claim: effects in order, whatever values are fitted beside them; few values by name;
// more as "parameters"; none; and sets as the balances name them.
TEST(ClaimOf, EachKind) {
  using diagnose::ClaimOf;
  EXPECT_EQ(ClaimOf(Freed({})), "as given");
  EXPECT_EQ(ClaimOf(Freed({"b"}, {{"", {}, "b"}})), "parameter b");
  EXPECT_EQ(ClaimOf(Freed({"b"})), "parameter b") << "the refit of the only value that is free";
  EXPECT_EQ(ClaimOf(Freed({"b", "T_s", "J", "beta"})), "parameters");
  EXPECT_EQ(ClaimOf(Freed({}, {kLag})), "amp.lag");
  EXPECT_EQ(ClaimOf(Freed({"b", "T_s", "J", "beta"}, {kLag})), "amp.lag");
  EXPECT_EQ(ClaimOf(Freed({}, {{"sensor.skew", {{"signal", "p1"}}, ""}, kLag})),
            "amp.lag + sensor.skew (p1)");
  EXPECT_EQ(diagnose::ClaimOfSet({}), "as given");
  EXPECT_EQ(diagnose::ClaimOfSet({"sensor.skew(p1)", "amp.lag", "value.b"}), "amp.lag + sensor.skew (p1)");
  EXPECT_EQ(diagnose::ClaimOfSet({"value.b"}), "parameter b");
  EXPECT_EQ(diagnose::ClaimOfSet({"run.T_s"}), "run.T_s");
}

// Tests that a value that moves by more than a factor of two is called implausible, down as well as up, and
// nothing of what was 0.
TEST(DescribeFound, ImplausibleValues) {
  const auto moved = [](const std::string& name, double factor, double to = 0) {
    diagnose::Hypothesis hypothesis = Freed({name});
    double& value = hypothesis.model.parameters.*model::BaseParameters()[model::BasePlace(name)].member;
    value = factor * value + to;
    return Described(ProofOf({Leaving(100, Freed({})), Leaving(1, hypothesis)})).parameters.at(0);
  };
  EXPECT_FALSE(moved("b", 1.9).implausible);
  EXPECT_EQ(moved("b", 3).why, "moves by a factor of 3");
  EXPECT_EQ(moved("b", 0.25).why, "moves by a factor of 0.25");
  EXPECT_FALSE(moved("mgl", 1, 25).implausible);
}

// Tests that a limit which no run reaches, fitted or held out, has no value of its own: it stays as given,
// and a remark says that nothing shows it. One that a run reaches is a value like any other.
TEST(DescribeFound, WhatNoRunReachesStaysAsGiven) {
  diagnose::Hypothesis hypothesis = Freed({"T_pmax", "b"});
  hypothesis.model.parameters.T_pmax *= 1.05;
  hypothesis.model.parameters.b *= 1.5;
  const Proof proof = ProofOf({Leaving(100, Freed({})), Leaving(1, hypothesis)});
  const double limit = Table1().T_pmax / Table1().k_1;
  for (const double most : {0.9 * limit, 1.1 * limit}) {
    NoisyRig rig;
    rig.model = Table1With();
    const diagnose::RunData small = rig.Record("small", model::Shaft::kClamped, 0, 0.3, false, [&](double t) {
      return std::fmod(t, 0.1) < 0.05 ? 0.5 * limit : -0.5 * limit;
    });
    const diagnose::RunData large = rig.Record("large", model::Shaft::kClamped, 0, 0.3, false,
                                               [&](double t) { return t < 0.1 ? most : -0.2 * most; });
    diagnose::ProofContext context = OfTable1();
    context.runs = {&small};
    context.held_out = {&large};
    Diagnosis d;
    d.model = hypothesis.model;
    DescribeFound(context, proof, &d);
    std::vector<std::string> names;
    for (const diagnose::ChangedParameter& changed : d.parameters) names.push_back(changed.fitted.name);
    if (most > limit) {
      EXPECT_THAT(names, ElementsAre("T_pmax", "b"));
      EXPECT_EQ(d.model.parameters.T_pmax, hypothesis.model.parameters.T_pmax);
      EXPECT_THAT(d.remarks, IsEmpty());
    } else {
      EXPECT_THAT(names, ElementsAre("b"));
      EXPECT_EQ(d.model.parameters.T_pmax, Table1().T_pmax);
      EXPECT_THAT(d.remarks, ElementsAre(::testing::HasSubstr("These runs do not show T_pmax: nothing")));
    }
  }
}

}  // namespace
}  // namespace hydro::testing
