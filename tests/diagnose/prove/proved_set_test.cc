// Tests the rules by which sets of changes are compared, on made-up gaps of windows.
#include "diagnose/prove/proved_set.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace hydro::diagnose {
namespace {

constexpr size_t kWindows = 20;

// A window with these squared gaps of the speed and of p1.
WindowGap Window(double speed, double p1) {
  WindowGap gap;
  gap.tested = true;
  gap.squared.fill(std::numeric_limits<double>::quiet_NaN());
  gap.squared[static_cast<size_t>(model::Channel::kMotorSpeed)] = speed;
  gap.squared[static_cast<size_t>(model::Channel::kP1)] = p1;
  gap.sum = 100 * (speed + p1);
  gap.count = 200;
  return gap;
}

// Windows whose gap is `gap`, a little different from each other.
std::vector<WindowGap> Windows(double gap, double scatter = 0.01) {
  std::vector<WindowGap> windows;
  for (size_t w = 0; w < kWindows; ++w) {
    const double own = gap * std::exp(w % 2 == 0 ? scatter : -scatter);
    windows.push_back(Window(own * own, own * own));
  }
  return windows;
}

ProvedSet SetOf(const std::vector<std::string>& effects, std::vector<WindowGap> near, double far = 10) {
  ProvedSet set;
  for (const std::string& effect : effects) set.hypothesis.changes.push_back({effect, {}, ""});
  set.near = std::move(near);
  set.far = Windows(far);
  return set;
}

std::vector<WindowGap> Untested() { return std::vector<WindowGap>(kWindows); }

// Tests what counts as next to nothing: less than a hundredth of the squared gap that other values leave,
// while much more than noise is left; nothing that cannot be tested.
TEST(EffectIsKept, NotForNextToNothing) {
  const ProvedSet values = SetOf({}, Windows(20)), with = SetOf({"a", "b"}, Windows(10));
  EXPECT_TRUE(TakesNextToNothing(with, SetOf({"a"}, Windows(10.15)), values));
  EXPECT_TRUE(TakesNextToNothing(with, SetOf({"a"}, Windows(9)), values));
  EXPECT_FALSE(TakesNextToNothing(with, SetOf({"a"}, Windows(10.25)), values));
  EXPECT_FALSE(TakesNextToNothing(with, SetOf({"a"}, Untested()), values));
  EXPECT_FALSE(TakesNextToNothing(SetOf({"a", "b"}, Windows(1.3)), SetOf({"a"}, Windows(1.35)), values));
}

// Tests that the fall is the mean logarithm of the gaps' ratio, with its error.
TEST(GapFall, IsTheMeanLogarithm) {
  const GapFall fall = FallOf(Windows(5), Windows(4));
  EXPECT_NEAR(fall.logarithm, std::log(5.0 / 4.0), 1e-9);
  EXPECT_NEAR(fall.error, 0, 1e-9);
  EXPECT_EQ(fall.windows, kWindows);
  EXPECT_TRUE(fall.Exceeds(0.19));
  EXPECT_FALSE(fall.Exceeds(0.21));
  EXPECT_FALSE(FallOf(Windows(4), Windows(5)).Exceeds(0));
}

// Tests that a window that diverges counts as a factor of four, however far it is.
TEST(GapFall, OneWindowThatDivergesDoesNotRule) {
  std::vector<WindowGap> after = Windows(4);
  after[3] = Window(1e20, 1e20);
  EXPECT_NEAR(FallOf(Windows(5), after).logarithm, (19 * std::log(5.0 / 4.0) - std::log(4.0)) / 20, 1e-3);
}

// Tests that windows that one of both cannot be tested on are left out.
TEST(GapFall, LeavesOutWhatIsNotTested) {
  std::vector<WindowGap> after = Windows(4, 0);
  for (size_t w = 0; w < 5; ++w) after[w].tested = false;
  const GapFall fall = FallOf(Windows(5, 0), after);
  EXPECT_EQ(fall.windows, 15u);
  EXPECT_NEAR(fall.logarithm, std::log(5.0 / 4.0), 1e-9);
  EXPECT_TRUE(IsTested(after));
  EXPECT_FALSE(IsTested(Untested()));
  EXPECT_EQ(FallOf(Windows(5), Untested()).windows, 0u);
  EXPECT_TRUE(std::isnan(TypicalGap(Untested())));
}

// Tests that a channel that both predict to its noise does not dilute what the other shows.
TEST(GapFall, SilentChannelsHaveNoSay) {
  const std::vector<WindowGap> before(kWindows, Window(25, 1)), after(kWindows, Window(16, 1));
  EXPECT_NEAR(FallOf(before, after).logarithm, std::log(5.0 / 4.0), 1e-9);
  const std::vector<WindowGap> worse(kWindows, Window(16, 4));
  EXPECT_LT(FallOf(before, worse).logarithm, 0);
}

// Tests that an effect has to take its price beyond the scatter of the windows, and nothing of the far ones.
TEST(EffectIsKept, TakesItsPrice) {
  const ProvedSet without = SetOf({}, Windows(5));
  constexpr double kPrice = 0.1;
  EXPECT_TRUE(IsEffectKept(SetOf({"amp.lag"}, Windows(4.4)), without, kPrice));
  EXPECT_FALSE(IsEffectKept(SetOf({"amp.lag"}, Windows(4.6)), without, kPrice));
  EXPECT_TRUE(IsEffectKept(SetOf({"amp.lag"}, Windows(4.6)), without, 0));
  EXPECT_FALSE(IsEffectKept(SetOf({"amp.lag"}, Windows(6)), without, -0.1));
  EXPECT_FALSE(IsEffectKept(SetOf({"amp.lag"}, Windows(4), 15), without, kPrice));
  std::vector<WindowGap> scattered = Windows(5);
  scattered[0] = Window(0.01, 0.01);
  scattered[1] = Window(0.01, 0.01);
  scattered[2] = Window(1e4, 1e4);
  EXPECT_FALSE(IsEffectKept(SetOf({"amp.lag"}, scattered), without, kPrice));
}

// Tests what the price is worth: a twentieth of the gap at even odds, nothing at nine to one, and no more
// than the balances may be sure of.
TEST(EffectIsKept, OddsArePaidWithTheGap) {
  EXPECT_NEAR(diagnose::PriceOf(0.5), 0.05, 1e-12);
  EXPECT_NEAR(diagnose::PriceOf(0.9), 0, 1e-12);
  EXPECT_NEAR(diagnose::PriceOf(0.1), 0.1, 1e-12);
  EXPECT_EQ(diagnose::PriceOf(0), diagnose::PriceOf(1e-9));
  EXPECT_EQ(diagnose::PriceOf(1), diagnose::PriceOf(1 - 1e-9));
  EXPECT_GT(diagnose::PriceOf(1), -0.11);
  EXPECT_LT(diagnose::PriceOf(0), 0.21);
}

// Tests that what cannot be tested vetoes nothing and takes no place.
TEST(EffectIsKept, NoSimulationNoVeto) {
  const ProvedSet tested = SetOf({"amp.lag"}, Windows(5)), untested = SetOf({}, Untested());
  EXPECT_TRUE(IsEffectKept(tested, untested, 0.1));
  EXPECT_FALSE(PredictsBetter(untested, tested));
  EXPECT_TRUE(PredictsBetter(tested, untested));
}

// Tests that other values have to predict near windows better, and far ones not much worse, than the model as
// given.
TEST(ValuesAreKept, NearAndFar) {
  const ProvedSet given = SetOf({}, Windows(5), 10);
  EXPECT_TRUE(AreValuesKept(SetOf({}, Windows(4.5), 10), given));
  EXPECT_FALSE(AreValuesKept(SetOf({}, Windows(4.9), 10), given));
  EXPECT_TRUE(AreValuesKept(SetOf({}, Windows(4.5), 10.5), given));
  EXPECT_FALSE(AreValuesKept(SetOf({}, Windows(4.5), 15), given));
}

// Tests that other values take the place of a set's only where they predict better near and no worse far.
TEST(PredictsBetter, NearAndFar) {
  const ProvedSet set = SetOf({}, Windows(5), 10);
  EXPECT_TRUE(PredictsBetter(SetOf({}, Windows(4.99), 10), set));
  EXPECT_FALSE(PredictsBetter(SetOf({}, Windows(5.01), 5), set));
  EXPECT_FALSE(PredictsBetter(SetOf({}, Windows(4), 11), set));
}

// Tests that the set that leads is not the one with the smallest gap, where its further effect takes too
// little.
TEST(LeadingSet, EachEffectTakesItsPart) {
  std::vector<ProvedSet> sets = {SetOf({}, Windows(50)), SetOf({"amp.lag"}, Windows(5)),
                                 SetOf({"amp.lag", "amp.bias"}, Windows(4.8)),
                                 SetOf({"amp.delay"}, Untested())};
  for (ProvedSet& set : sets) set.price = 0.1 * static_cast<double>(set.Effects().size());
  EXPECT_EQ(LeadingSet(sets), 1u);
  sets[2].near = Windows(3);
  EXPECT_EQ(LeadingSet(sets), 2u);
  EXPECT_EQ(BestWithEffects(sets, {{"amp.bias", {}, ""}, {"amp.lag", {}, ""}}), 2u);
  EXPECT_EQ(BestWithEffects(sets, {{"amp.delay", {}, ""}}), sets.size());
  EXPECT_EQ(LeadingSet({sets[3]}), 1u);
}

// Tests that of sets that predict equally well the likelier proposal leads.
TEST(LeadingSet, TheLikelierOfEquals) {
  std::vector<ProvedSet> sets = {SetOf({"amp.lag"}, Windows(5)), SetOf({"amp.delay"}, Windows(5.01))};
  sets[0].weight = 0.2;
  sets[1].weight = 0.7;
  EXPECT_EQ(LeadingSet(sets), 1u);
}

// Tests that sets of values alone are always refined, and of the others those that lead.
TEST(WorthRefining, ValuesAndThoseThatLead) {
  std::vector<ProvedSet> sets = {SetOf({}, Windows(50)), SetOf({}, Windows(40)),
                                 SetOf({"amp.lag"}, Windows(5)), SetOf({"amp.delay"}, Windows(6))};
  for (size_t i = 1; i < sets.size(); ++i) sets[i].hypothesis.base = {0};
  EXPECT_EQ(WorthRefining(sets, 1), (std::vector<size_t>{1, 2}));
  EXPECT_EQ(WorthRefining(sets, 5), (std::vector<size_t>{1, 2, 3}));
}

}  // namespace
}  // namespace hydro::diagnose
