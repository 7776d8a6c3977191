// Verdicts in words.
#include "diagnose/say/sentence.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

namespace hydro::testing {
namespace {

using diagnose::Verdict;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

diagnose::Diagnosis With(Verdict verdict, std::vector<std::string> tied_with = {}) {
  diagnose::Diagnosis d;
  d.verdict = verdict;
  d.held_out = {20, 12, 1.05};
  diagnose::FoundEffect lag;
  lag.id = "amp.lag";
  lag.summary = "the amplifier lags";
  lag.tied_with = std::move(tied_with);
  d.effects = {lag};
  return d;
}

// The sentence on whole runs.
std::string Said(const diagnose::Diagnosis& d) { return diagnose::Sentence(d, {d.held_out, 0}); }

// Tests that rivals are named in words, other values among them.
TEST(Sentence, RivalsInWords) {
  EXPECT_EQ(Said(With(Verdict::kNamed)),
            "Missing: the amplifier lags [amp.lag] (held-out gap 20 to 1.05 noise units).");
  const diagnose::Diagnosis tied =
      With(Verdict::kTied, {"amp.delay", "parameter J + parameter b", "parameters"});
  EXPECT_THAT(Said(tied), HasSubstr("[amp.lag] (or amp.delay, or other values of J and "
                                    "b, or other values of the model's parameters)"));
  EXPECT_EQ(diagnose::WhyNext(tied.effects),
            "distinguishes amp.lag from amp.delay, other values of J and b and other values of the model's "
            "parameters");
  EXPECT_EQ(diagnose::WhyNext(With(Verdict::kNamed).effects), "");
}

// Tests that values alone can explain a part.
TEST(Sentence, ValuesThatExplainAPart) {
  diagnose::Diagnosis d = With(Verdict::kPartly);
  d.effects.clear();
  diagnose::ChangedParameter b;
  b.fitted.name = "b";
  b.fitted.value = 0.03;
  b.model = 0.02;
  d.parameters = {b};
  EXPECT_THAT(Said(d), StartsWith("Other values explain part of the gap: b = 0.03 instead of 0.02;"));
}

// Tests that a value whose interval holds the given one is not said to be another beside one that clearly is.
TEST(Sentence, ValuesThatMayBeAsGivenAreNoFinding) {
  diagnose::Diagnosis d = With(Verdict::kParameters);
  d.effects.clear();
  diagnose::ChangedParameter b, range;
  b.fitted = {"b", 0.03, 0.028, 0.032, "", true};
  b.model = 0.02;
  range.fitted = {"range", 300028, 250000, 350000, "", true};
  range.model = 300000;
  d.parameters = {range, b};
  EXPECT_THAT(Said(d), HasSubstr("b = 0.03 instead of 0.02"));
  EXPECT_THAT(Said(d), Not(HasSubstr("range")));
  d.parameters = {range};
  EXPECT_THAT(Said(d), HasSubstr("range = 300028 instead of 300000"));
  d.effects = With(Verdict::kNamed).effects;
  EXPECT_THAT(Said(d), Not(HasSubstr("range")));
}

// Tests that of values that the runs do not show, the names are said; and that a value with an interval that
// shows nothing is not said to be another.
TEST(Sentence, ValuesThatTheRunsDoNotShow) {
  diagnose::Diagnosis d = With(Verdict::kPartly);
  d.effects.clear();
  diagnose::ChangedParameter b;
  b.fitted = {"b", 0.03, 0, 5, "in-lbf-s", false};
  b.model = 0.02;
  d.parameters = {b};
  EXPECT_THAT(Said(d), StartsWith("Other values explain part of the gap: b, which these runs do not show by "
                                  "itself (see the remarks);"));
  d.unsure = {"T_s"};
  EXPECT_THAT(Said(d),
              HasSubstr("T_s and b together, none of which these runs show alone (see the remarks)"));
  d.parameters.clear();
  EXPECT_THAT(Said(d), HasSubstr("gap: T_s, which these runs do not show by itself"));
  d.parameters = {b};
  d.effects = With(Verdict::kPartly).effects;
  EXPECT_THAT(Said(d), Not(HasSubstr("0.03")));
}

// Tests that a delay that the recorder may cause is said as such, and not as something that nothing explains.
TEST(Sentence, WhatTheRecorderMayCause) {
  diagnose::Diagnosis d = With(Verdict::kUnexplained);
  d.recorder_may_be = true;
  const diagnose::ComparedGap closed{{12, 6, 1.01}, 0.4, true};
  EXPECT_THAT(diagnose::Sentence(d, closed),
              AllOf(HasSubstr("and so may the recorder"), Not(HasSubstr("no known effect"))));
  EXPECT_THAT(diagnose::Sentence(d, {{12, 6, 4}, 0.4}),
              HasSubstr("no known effect explains; the nearest is"));
}

// Tests that a change that rounds to nothing is not claimed.
TEST(Sentence, NoImprovementIsClaimed) {
  diagnose::Diagnosis d = With(Verdict::kUnexplained);
  d.held_out = {0.9981, 0.998, 0.9979};
  EXPECT_THAT(Said(d), AllOf(HasSubstr("takes nothing of the held-out gap"),
                             HasSubstr("the held-out gap stays at 0.998 noise units)")));
  d.noise_shown = 2.9;
  EXPECT_THAT(Said(d), HasSubstr("at 0.998 noise units; the noise that the samples show makes 2.9)"));
}

// Tests that a value which the runs do not show apart from others is left to its remark, and that its name is
// said where nothing but values was found.
TEST(Sentence, ValuesThatRestOnWhatIsKnown) {
  diagnose::Diagnosis d = With(Verdict::kPartly);
  diagnose::ChangedParameter b, J, beta;
  b.fitted = {"b", 1, 0.9, 1.1, "", true};
  J.fitted.name = "J";
  beta.fitted.name = "beta";
  J.fitted.value = 1;
  J.resting = true;
  // Nor is a value of which a reader sees no change.
  beta.model = 100000;
  beta.fitted.value = 100000.01;
  d.parameters = {b, J, beta};
  EXPECT_THAT(Said(d), AllOf(HasSubstr("b = "), Not(HasSubstr("J = ")), Not(HasSubstr("beta = "))));
  d.effects.clear();
  EXPECT_THAT(Said(d), HasSubstr("b = 1 instead of 0 and J, which these runs do not show by itself"));
  // Beside a value that has moved, those that stay within their intervals are left to their remark.
  J.model = 2;
  J.fitted.low = 0.9;
  J.fitted.high = 1.1;
  d.parameters = {J};
  d.unsure = {"D", "T_s"};
  EXPECT_THAT(Said(d), HasSubstr("gap: J, which these runs do not show by itself"));
  d.parameters[0].fitted.high = 3;
  EXPECT_THAT(Said(d), HasSubstr("gap: D, T_s and J together"));
}

// Tests that a model that explains windows but not whole runs is said to leave more of these.
TEST(Sentence, NothingMissingOverWindows) {
  diagnose::Diagnosis d = With(Verdict::kNothingMissing);
  d.held_out = d.fit = {2.81, 2.81, 2.81};
  const diagnose::ComparedGap windows{{0.97, 0.97, 0.97}, 0.4};
  EXPECT_EQ(
      diagnose::Sentence(d, windows),
      "Nothing is missing: the model as given explains the data to 0.97 noise units over 0.4 s, and whole "
      "runs, over which every small error adds up, to 2.81.");
  d.held_out = d.fit = {1.1, 1.1, 1.1};
  EXPECT_EQ(diagnose::Sentence(d, windows),
            "Nothing is missing: the model as given explains the data to 0.97 noise units over 0.4 s.");
}

// Tests that a model that cannot follow the runs is said to be that, and no number stands for it.
TEST(Sentence, WhatCannotBeFollowed) {
  diagnose::Diagnosis d = With(Verdict::kNamed);
  d.held_out.before = std::numeric_limits<double>::infinity();
  EXPECT_THAT(Said(d), AllOf(StartsWith("Missing: the amplifier lags"),
                             HasSubstr("the model as given cannot follow the held-out runs; 1.05 noise "
                                       "units are left")));
  d.verdict = Verdict::kUnexplained;
  EXPECT_THAT(Said(d),
              AllOf(HasSubstr("the nearest is the amplifier lags [amp.lag] ("), Not(HasSubstr("%"))));
  d.held_out.after = std::nan("");
  EXPECT_THAT(Said(d), HasSubstr("the model cannot follow the held-out runs"));
}

// Tests that a gap of windows is said with the time that they reach.
TEST(Sentence, AGapOverWindows) {
  EXPECT_THAT(diagnose::Sentence(With(Verdict::kNamed), {{11, 6, 1.2}, 0.4}),
              HasSubstr("(held-out gap over 0.4 s 11 to 1.2 noise units)"));
}

// Tests that the words agree with the figure beside them, for every verdict, what was found and gap: no share
// of noise, nothing taken that does not fall, no gap left beside one that a curve has closed, and no number
// that is none.
TEST(Sentence, WordsAgreeWithTheFigures) {
  const double gaps[] = {0.6, 0.95, 1.0, 1.2, 3, 400, std::numeric_limits<double>::infinity(), std::nan("")};
  size_t said = 0;
  for (const Verdict verdict : {Verdict::kNamed, Verdict::kTied, Verdict::kPartly, Verdict::kParameters,
                                Verdict::kUnexplained, Verdict::kNothingMissing}) {
    for (const double before : gaps) {
      for (const double after : gaps) {
        for (const int what : {0, 1, 2, 3, 4, 5, 6, 7}) {
          diagnose::Diagnosis d = With(verdict);
          const bool effect = (what & 1) != 0, curve = (what & 2) != 0, closed = (what & 4) != 0;
          if (!effect) d.effects.clear();
          if (curve) d.closures.emplace_back().id = "closure.pump_torque";
          const std::string text = diagnose::Sentence(d, {{before, before, after}, 0.4, closed});
          SCOPED_TRACE(text);
          ++said;
          EXPECT_THAT(text, Not(::testing::ContainsRegex("nan|inf |-[0-9]")));
          if (verdict == Verdict::kNothingMissing) continue;
          const bool known = std::isfinite(before) && std::isfinite(after);
          EXPECT_EQ(text.find("rises") != std::string::npos, known && after > before);
          EXPECT_EQ(text.find("stays at") != std::string::npos, known && after == before);
          const auto says = [&](const char* words) { return text.find(words) != std::string::npos; };
          EXPECT_FALSE(says("takes nothing") && known && after < before);
          EXPECT_FALSE(says("%") && !(after > 1 && before > after));
          EXPECT_FALSE(says("significant gap") && closed);
          EXPECT_FALSE(says("closes the") && !(closed && curve));
          EXPECT_FALSE(says("explain part of the gap") && known && after >= before);
          EXPECT_FALSE(says("suffice with other values") && known && after >= before);
          EXPECT_FALSE(says("no better") && known && after < before);
        }
      }
    }
  }
  EXPECT_EQ(said, 6u * 8 * 8 * 8);
}

// Tests that a gap over whole runs or of the fitted ones is said to be that where windows are what is
// compared.
TEST(Sentence, AGapElsewhere) {
  diagnose::Diagnosis d = With(Verdict::kUnexplained);
  d.effects.clear();
  d.horizons.emplace_back();
  EXPECT_THAT(diagnose::Sentence(d, {{9, 9, 9}, 0}),
              HasSubstr("(the held-out gap over whole runs stays at 9 noise units)"));
  EXPECT_THAT(diagnose::Sentence(d, {{9, 9, 8}, 0, false, true}),
              HasSubstr("(fitted gap over whole runs 9 to 8 noise units)"));
}

// Tests that a value that each run has for itself is named, and not with one number or among those that no
// run shows alone.
TEST(Sentence, AValueThatDiffersByRun) {
  diagnose::Diagnosis d = With(Verdict::kParameters);
  d.effects.clear();
  d.parameters.clear();
  d.unsure = {"b", "T_s"};
  EXPECT_THAT(Said(d), HasSubstr("b and T_s together, none of which"));
  d.by_run = {"T_s"};
  EXPECT_THAT(Said(d), StartsWith("The equations suffice with other values: T_s, which differs from run to "
                                  "run (held-out gap"));
}

// Tests that a curve alone is no cause.
TEST(Sentence, ACurveAlone) {
  diagnose::Diagnosis d = With(Verdict::kPartly);
  d.effects.clear();
  d.closures.emplace_back().id = "closure.pump_torque";
  EXPECT_THAT(Said(d),
              StartsWith("Something is missing that no known effect explains; a curve closes a part"));
}

}  // namespace
}  // namespace hydro::testing
