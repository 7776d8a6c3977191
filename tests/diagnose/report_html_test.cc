#include <gmock/gmock.h>

#include <limits>
#include <regex>

#include "diagnose/report/report.h"
#include "tests/diagnose/example_diagnosis.h"

namespace hydro::diagnose {
namespace {

// Does not print half a megabyte when it fails.
bool Has(const std::string& page, const std::string& part) { return page.find(part) != std::string::npos; }

// The first tag left open, or closed without being open; "" when there is none.
std::string UnbalancedTag(const std::string& html) {
  std::vector<std::string> open;
  const std::regex tag(R"(<(/?)([a-zA-Z0-9]+)((?:[^<>"]|"[^"]*")*?)(/?)>)");
  for (std::sregex_iterator it(html.begin(), html.end(), tag), end; it != end; ++it) {
    const std::string name = (*it)[2];
    if ((*it)[4].length() > 0 || name == "meta") continue;
    if ((*it)[1].length() == 0) {
      open.push_back(name);
    } else if (open.empty() || open.back() != name) {
      return "</" + name + ">";
    } else {
      open.pop_back();
    }
  }
  return open.empty() ? "" : "<" + open.back() + ">";
}

// Tests that the page needs no other file and no script.
TEST(ReportHtml, SelfContained) {
  const std::string page = ReportHtml(testing::ExampleDiagnosis(), false);
  EXPECT_TRUE(page.starts_with("<!DOCTYPE html>"));
  for (const char* outside :
       {"http:", "https:", "src=", "href=", "<script", "<link", "@import", "url(", "onload"}) {
    EXPECT_FALSE(Has(page, outside)) << outside;
  }
}

// Tests that every tag is closed where it should be, in full reports and in nearly empty ones.
TEST(ReportHtml, TagsAreBalanced) {
  EXPECT_EQ(UnbalancedTag(ReportHtml(testing::ExampleDiagnosis(60), false)), "");
  EXPECT_EQ(UnbalancedTag(ReportHtml(testing::EmptyDiagnosis(), true)), "");
}

// Tests that names and texts from files are shown as text.
TEST(ReportHtml, Escapes) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  const std::string evil = "<script>alert(\"1\")</script>&";
  diagnosis.model.name = diagnosis.sentence = diagnosis.next.config = diagnosis.next.why = evil;
  diagnosis.remarks = diagnosis.runs = diagnosis.held_out_runs = {evil};
  diagnosis.curves[0].run = diagnosis.location[0].where = diagnosis.location[0].windows[0].run = evil;
  diagnosis.candidates[0].id = diagnosis.candidates[1].rejected_because = evil;
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_FALSE(Has(page, "<script"));
  EXPECT_TRUE(Has(page, "&lt;script&gt;"));
  EXPECT_EQ(UnbalancedTag(page), "");
}

// Tests that a value with an interval that shows nothing is said to be so, and which mean the verdict's gap
// is and which the table's.
TEST(ReportHtml, WhatIsNotShown) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  EXPECT_FALSE(Has(ReportHtml(diagnosis, false), "not shown by these runs"));
  EXPECT_FALSE(TerminalSummary(diagnosis, "out", false).find("not shown by these runs") != std::string::npos);
  diagnosis.effects[0].parameters[0].shown = false;
  diagnosis.parameters[0].fitted.shown = false;
  diagnosis.compared = {{15.7, 12, 9.3}, 0.4};
  ASSERT_FALSE(diagnosis.horizons.empty());
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_TRUE(Has(page, "0.47 to 0.57: not shown by these runs"));
  EXPECT_TRUE(Has(page, "0.0199 to 0.0207: not shown by these runs"));
  EXPECT_TRUE(Has(page, "The held-out gap in the verdict, 15.7 to 9.3 over 0.4 s, is the typical one"));
  const std::string text = TerminalSummary(diagnosis, "out", false);
  EXPECT_NE(text.find("b 0.0203 [0.0199, 0.0207] in-lbf-s (not shown by these runs), was 0.01455"),
            std::string::npos)
      << text;
}

// Tests the title of a model that has no name.
TEST(ReportHtml, ModelWithoutAName) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  diagnosis.model.name.clear();
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_TRUE(Has(page, "Gap report. "));
  EXPECT_FALSE(Has(page, "Gap report: "));
}

// Tests that the whole diagnosis is there: verdict, gaps, effects, parameters, places, ties, pictures,
// ranking, the next experiment.
TEST(ReportHtml, Complete) {
  const std::string page = ReportHtml(testing::ExampleDiagnosis(), false);
  for (const char* part : {"Gap report: bench &amp; rig",
                           ">tied</span>",
                           "static friction exceeds",
                           "23.9",
                           "19.5",
                           "1.06",
                           "static_excess",
                           "0.47 to 0.57",
                           "These data cannot distinguish it from sensor.skew.",
                           "signal = p1",
                           "implausible: four times",
                           "|motor_speed| &lt; 5 rad/s, at reversals",
                           "square &lt;wave&gt;: 1.4 to 1.75 s",
                           "p2 is noisier than stated",
                           "A slow triangle",
                           "file = &quot;model.toml&quot;",
                           ">taken<",
                           "the held-out gap stays 13 times",
                           "noise floor",
                           "class=\"span\"",
                           "class=\"band\"",
                           "class=\"line pale\"",
                           "class=\"line c1\"",
                           "class=\"line c0\"",
                           "class=\"line c0\"",
                           "motor speed (rad/s)",
                           "@media print"}) {
    EXPECT_TRUE(Has(page, part)) << part;
  }
}

// Tests the order: what was found, how sure, how much of the gap, what remains, what to measure next, then
// the details.
TEST(ReportHtml, AnswersFirst) {
  const std::string page = ReportHtml(testing::ExampleDiagnosis(60), false);
  size_t before = 0;
  for (const char* heading : {"What was found", "How sure that is", "What may explain the runs",
                              "How much of the gap it takes", "What remains, and where",
                              "What to measure next", "Remarks", "The gap by signal", "Every candidate"}) {
    const size_t at = page.find("<h2>" + std::string(heading));
    ASSERT_NE(at, std::string::npos) << heading;
    EXPECT_GT(at, before) << heading;
    before = at;
  }
  for (const char* part : {"<td class=\"number\">95 %</td><td class=\"number\">86 %</td>",  // weight, share
                           "the term of pump.stribeck", "where sensor.skew shows most",
                           "the gap at each horizon", "whole runs"}) {
    EXPECT_TRUE(Has(page, part)) << part;
  }
}

// Tests what paper needs: each heading begins a section that stays whole, the details begin on a page of
// their own behind the answer, and nothing on the page has to be opened or clicked.
TEST(ReportHtml, PrintsInSections) {
  const std::string page = ReportHtml(testing::ExampleDiagnosis(60), false);
  const auto count = [&](const std::string& text) {
    size_t number = 0;
    for (size_t at = page.find(text); at != std::string::npos; at = page.find(text, at + 1)) ++number;
    return number;
  };
  EXPECT_EQ(count("<h2>"), count("<section class=\"part"));
  EXPECT_EQ(count("<section"), count("<section class=\"part\">\n<h2>") + 1);
  EXPECT_EQ(count("<section class=\"part details\">\n<h2>The gap by signal"), 1U);
  for (const char* rule : {".part { break-inside: avoid; }", ".details { break-before: page; }"}) {
    const size_t at = page.find(rule);
    ASSERT_NE(at, std::string::npos) << rule;
    EXPECT_GT(at, page.find("@media print")) << "on screens there are no pages";
  }
  for (const char* leftover : {"<details", "<button", "<input", "<select", "<a "})
    EXPECT_EQ(count(leftover), 0U) << leftover;
}

// Tests that the verdict's first sentence is the page's heading, that what follows it stands below, and that
// the gap in brackets is said in words over 0.4 s.
TEST(ReportHtml, LeadsWithTheVerdict) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  diagnosis.sentence = "Missing: a 0.5 in. bore (held-out gap 12 to 1.04 noise units). T_s differs by run.";
  diagnosis.compared = {{12, 11, 1.04}, 0.4};
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_TRUE(Has(page, "<body>\n<h1>Missing: a 0.5 in. bore.</h1>"));
  EXPECT_TRUE(Has(page,
                  "differs by run. On runs that it was not fitted to, predicted over 0.4 s, the model as "
                  "given is off by 12 times the noise of the sensors, with what was found by 1.04 times"));
  EXPECT_FALSE(Has(page, "held-out gap 12"));
  EXPECT_TRUE(Has(ReportHtml(testing::EmptyDiagnosis(), false),
                  "is off by 1.01 times the noise of the sensors; at 1 nothing but noise is left."));
}

// Tests that a value that each run has for itself is what was found, and what the weights say is likeliest.
TEST(ReportHtml, AValueThatDiffersByRun) {
  Diagnosis diagnosis = testing::EmptyDiagnosis();
  diagnosis.explanations = {{{"run.T_s"}, 0.98}, {{}, 0.02}};
  EXPECT_TRUE(Has(ReportHtml(diagnosis, false), "none of its values was changed"));
  EXPECT_TRUE(Has(ReportHtml(diagnosis, false), "The likeliest of them is not"));
  diagnosis.by_run = {"T_s"};
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_TRUE(Has(page, ", with a value of its own for each run"));
  EXPECT_FALSE(Has(page, "none of its values was changed"));
  EXPECT_FALSE(Has(page, "The likeliest of them is not"));
}

// Tests that explanations are in plain words, that the page says which hold the truth nine times in ten, and
// which of them is what was found.
TEST(ReportHtml, SaysWhatMayExplainTheRuns) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  diagnosis.effects.resize(1);
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_TRUE(
      Has(page, "the truth is among the first two of these nine times in ten: these runs tell no more"));
  EXPECT_TRUE(Has(page,
                  "<tr class=\"taken\"><td>pump.stribeck</td><td class=\"number\">81 %</td>"
                  "<td>yes</td><td>what was found</td></tr>"));
  EXPECT_TRUE(Has(page, "an unknown curve over motor speed in pump torque"));
  EXPECT_TRUE(Has(
      page,
      "<tr><td>no effect (other values at most)</td><td class=\"number\">1 %</td><td></td><td></td></tr>"));
  EXPECT_FALSE(Has(page, "The likeliest of them is not"));
  diagnosis.set_90 = 1;
  EXPECT_TRUE(Has(ReportHtml(diagnosis, false), "these runs tell it from all others"));
  diagnosis.effects.clear();
  EXPECT_TRUE(
      Has(ReportHtml(diagnosis, false), "The likeliest of them is not what predicts held-out runs best"));
  EXPECT_FALSE(Has(ReportHtml(testing::EmptyDiagnosis(), false), "What may explain the runs"));
}

// Tests that what the balances did not propose is named below the ranking, without a row.
TEST(ReportHtml, NamesWhatWasNotSimulated) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  diagnosis.candidates.push_back({"amp.lag", nan, nan, 1, diagnose::kNotProposed});
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_TRUE(Has(page, "gave no reason to simulate these alone: amp.lag.</p>"));
  EXPECT_FALSE(Has(page, "<td>amp.lag</td>"));
}

// Tests that SI replaces the paper's units in tables and pictures.
TEST(ReportHtml, Si) {
  const std::string page = ReportHtml(testing::ExampleDiagnosis(), true);
  EXPECT_TRUE(Has(page, "p1 (kPa)"));
  EXPECT_TRUE(Has(page, "303.4"));
  EXPECT_TRUE(Has(page, "N m s"));
  EXPECT_FALSE(Has(page, "p1 (psi)"));
}

// Tests that curves without values, or with a simulation that ran away or failed, are drawn as far as they
// go.
TEST(ReportHtml, OddCurves) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  diagnosis.curves[0].curves[0].before.assign(60, 1e30);
  diagnosis.curves[0].curves[1].before.clear();
  diagnosis.curves[0].curves[2].measured.assign(60, std::numeric_limits<double>::quiet_NaN());
  diagnosis.curves.push_back({"nothing", false, {}, {}});
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_EQ(UnbalancedTag(page), "");
  EXPECT_FALSE(Has(page, "nan"));
  EXPECT_FALSE(Has(page, "inf\""));
  EXPECT_FALSE(Has(page, "e+"));
}

// Tests that the held-out gaps say what chose the model that predicts each run, where runs were held out in
// turn.
TEST(ReportHtml, SaysWhatChoseWhat) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  EXPECT_FALSE(Has(ReportHtml(diagnosis, false), "the others choose"));
  diagnosis.choices = {{"a", "amp.lag", true}, {"b", "as given", false}};
  EXPECT_TRUE(Has(ReportHtml(diagnosis, false), "without run b the others choose the model as given"));
}

}  // namespace
}  // namespace hydro::diagnose
