// What the other runs choose without a run.
#include "diagnose/verdict/choice_without.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// Two blocks of each of the runs a, b and c, with the same squared gap in both.
Evidence Leaving(const std::string& id, std::vector<std::string> parts, const std::vector<double>& by_run) {
  Evidence one;
  one.id = id;
  one.parts = std::move(parts);
  one.numbers = 1 + 0.01 * static_cast<double>(one.parts.size());
  for (const double gap : by_run) one.squared_gaps.insert(one.squared_gaps.end(), 2, gap);
  return one;
}

Contest Of(std::vector<Evidence> evidence, bool geometric = false) {
  return {std::move(evidence), {"a", "a", "b", "b", "c", "c"}, geometric};
}

std::vector<std::string> Chosen(const std::vector<ChoiceWithout>& choices) {
  std::vector<std::string> chosen;
  for (const ChoiceWithout& choice : choices) chosen.push_back(choice.run + ": " + choice.chosen);
  return chosen;
}

const Evidence kGiven = Leaving("as given", {}, {9, 9, 9});
const Evidence kLagEverywhere = Leaving("amp.lag", {"amp.lag"}, {1, 1, 1});

// Tests that what every run shows is chosen without any of them, on whole runs and on windows.
TEST(ChoicesWithoutEach, TheSameWhereEveryRunShowsIt) {
  for (const bool geometric : {false, true}) {
    const std::vector<ChoiceWithout> choices =
        ChoicesWithoutEach(Of({kGiven, kLagEverywhere}, geometric), "amp.lag");
    EXPECT_THAT(Chosen(choices), ElementsAre("a: amp.lag", "b: amp.lag", "c: amp.lag"));
    for (const ChoiceWithout& choice : choices) EXPECT_TRUE(choice.same);
  }
}

// Tests that a run which alone calls for an effect is found out: without it the others need nothing.
TEST(ChoicesWithoutEach, WhatOneRunAloneChose) {
  const Evidence given = Leaving("as given", {}, {9, 1, 1}),
                 relief = Leaving("valve.relief", {"valve.relief"}, {1, 1, 1});
  const std::vector<ChoiceWithout> choices = ChoicesWithoutEach(Of({given, relief}), "valve.relief");
  EXPECT_THAT(Chosen(choices), ElementsAre("a: as given", "b: valve.relief", "c: valve.relief"));
  EXPECT_FALSE(choices[0].same);
}

// Tests that another effect wins where the others see it materially better, and that what is no better, or is only
// another way to fit the same, does not.
TEST(ChoicesWithoutEach, AnotherThatIsMateriallyBetter) {
  const Evidence lag = Leaving("amp.lag", {"amp.lag"}, {1, 3, 3}),
                 delay = Leaving("amp.delay", {"amp.delay"}, {9, 1, 1});
  EXPECT_THAT(Chosen(ChoicesWithoutEach(Of({kGiven, lag, delay}), "amp.lag")),
              ElementsAre("a: amp.delay", "b: amp.lag", "c: amp.lag"));
  const Evidence as_good = Leaving("amp.delay", {"amp.delay"}, {1, 0.98, 0.98});
  const Evidence refitted = Leaving("amp.lag", {"amp.lag", "b"}, {1, 0.99, 0.99});
  EXPECT_THAT(Chosen(ChoicesWithoutEach(Of({kGiven, kLagEverywhere, as_good, refitted}), "amp.lag")),
              ElementsAre("a: amp.lag", "b: amp.lag", "c: amp.lag"));
}

// Tests that nothing is said of two runs, nor of what was not compared.
TEST(ChoicesWithoutEach, OnlyWhereTheOthersCanChoose) {
  Contest two = Of({kGiven, kLagEverywhere});
  two.runs = {"a", "a", "a", "b", "b", "b"};
  EXPECT_THAT(ChoicesWithoutEach(two, "amp.lag"), IsEmpty());
  EXPECT_THAT(ChoicesWithoutEach(Of({kGiven, kLagEverywhere}), "amp.bias"), IsEmpty());
}

// Tests that the remark names the runs that chose what then predicts them, and claims no proof of these.
TEST(ChoiceRemark, SaysWhatChoseWhat) {
  EXPECT_THAT(ChoiceRemark({{"a", "amp.lag", true}, {"b", "amp.lag", true}}),
              AllOf(HasSubstr("the others choose the same without it"), Not(HasSubstr("no proof"))));
  EXPECT_THAT(ChoiceRemark({{"a", "as given", false}, {"b", "amp.lag", true}, {"c", "parameter b", false}}),
              AllOf(HasSubstr("without run a the others choose the model as given"),
                    HasSubstr("without run c the others choose another value of b"),
                    HasSubstr("how well runs a and c are predicted is no proof"), HasSubstr("--hold-out")));
}

}  // namespace
}  // namespace hydro::diagnose
