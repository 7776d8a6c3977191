// The mean of what balances say and of what the proof makes of it.
#include "diagnose/say/two_witnesses.h"

#include <gtest/gtest.h>

#include "diagnose/prove/unrecorded.h"
#include "tests/diagnose/say/made_up.h"

namespace hydro::testing {
namespace {

using diagnose::Diagnosis;
using diagnose::Proof;
using diagnose::WeightedSet;

// A lag leaves the noise, a delay a little more, other values a hundred times as much.
Proof OfALag() {
  return ProofOf({Leaving(100, Freed({})), Leaving(81, Freed({"b", "T_s", "J", "beta"})),
                  Leaving(1.5, Freed({}, {kDelay})), Leaving(1.4, Freed({}, {kLag}))});
}

Diagnosis Heard(const Proof& proof, std::vector<WeightedSet> explanations) {
  Diagnosis d;
  d.explanations = std::move(explanations);
  for (const diagnose::Change& change : proof.Best().Effects()) d.effects.emplace_back().id = change.effect;
  HearBothWitnesses(proof, &d);
  return d;
}

double WeightIn(const Diagnosis& d, const std::vector<std::string>& changes) {
  for (const WeightedSet& one : d.explanations) {
    if (one.changes == changes) return one.weight;
  }
  return -1;
}

double SumOf(const Diagnosis& d) {
  double sum = 0;
  for (const WeightedSet& one : d.explanations) sum += one.weight;
  return sum;
}

// Tests that where both witnesses agree the weight stays near one, and that where they do not none is surer
// than even and both are in the set of nine in ten.
TEST(HearBothWitnesses, AgreementAndDisagreement) {
  const Diagnosis agree = Heard(OfALag(), {{{"amp.lag"}, 0.98}, {{}, 0.02}});
  EXPECT_GT(WeightIn(agree, {"amp.lag"}), 0.8);
  EXPECT_NEAR(SumOf(agree), 1, 1e-12);
  const Diagnosis apart = Heard(OfALag(), {{{"pump.stribeck"}, 1}});
  EXPECT_DOUBLE_EQ(WeightIn(apart, {"pump.stribeck"}), 0.5);
  EXPECT_GT(WeightIn(apart, {"amp.lag"}), 0.3);
  EXPECT_LT(WeightIn(apart, {"amp.lag"}), 0.5);
  EXPECT_GE(apart.set_90, 2u);
  EXPECT_DOUBLE_EQ(apart.effects.at(0).weight, WeightIn(apart, {"amp.lag"}));
}

// Tests that what predicts nearly as well keeps a part of the proof's weight, and what predicts far worse
// none.
TEST(HearBothWitnesses, PartsOfWhatPredictsNearlyAsWell) {
  const Diagnosis d = Heard(OfALag(), {{{"amp.lag"}, 1}});
  EXPECT_GT(WeightIn(d, {"amp.delay"}), 0.05);
  EXPECT_LT(WeightIn(d, {"amp.delay"}), WeightIn(d, {"amp.lag"}));
  EXPECT_LT(WeightIn(d, {}), 1e-6);
}

// Tests that a curve is one explanation however the two witnesses write it, and that values count as none.
TEST(HearBothWitnesses, CurvesAndValuesByOneName) {
  const Proof curve =
      ProofOf({Leaving(100, Freed({})), Leaving(81, Freed({"b"})),
               Leaving(1, Freed({}, {{"closure.flow_1", {}, ""}, {"closure.flow_2", {}, ""}}))});
  const Diagnosis d = Heard(curve, {{{"closure.cross_flow(p2 - p1)"}, 0.7}, {{"value.c_I"}, 0.3}});
  ASSERT_EQ(d.explanations.size(), 2u);
  EXPECT_NEAR(WeightIn(d, {"closure.cross_flow(p2 - p1)"}), 0.85, 1e-6);
  EXPECT_NEAR(WeightIn(d, {"value.c_I"}), 0.15, 1e-6);
}

// Tests that the balances' weights stay where nothing can be simulated, and where pressures were not
// recorded, of which simulation says nothing.
TEST(HearBothWitnesses, OneWitnessAlone) {
  Proof silent = OfALag();
  for (diagnose::WindowGap& gap : silent.sets.back().near) gap.tested = false;
  EXPECT_EQ(WeightIn(Heard(silent, {{{"amp.lag"}, 0.3}, {{}, 0.7}}), {"amp.lag"}), 0.3);
  const std::vector<WeightedSet> oil = {{{diagnose::kSomeOil}, 0.9}, {{}, 0.1}};
  EXPECT_EQ(WeightIn(Heard(OfALag(), oil), {diagnose::kSomeOil}), 0.9);
}

}  // namespace
}  // namespace hydro::testing
