#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "base/utf8.h"
#include "diagnose/report/report.h"
#include "tests/diagnose/example_diagnosis.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;
using Json = nlohmann::json;

std::vector<std::string> Keys(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

// Tests that every key that programs rely on is there, by name and with its value.
TEST(ReportJson, Keys) {
  const Json report = Json::parse(ReportJson(testing::ExampleDiagnosis(), "next.toml", 12.5));
  EXPECT_THAT(Keys(report), IsSupersetOf({"verdict", "location", "effects", "parameters", "gap",
                                          "next_experiment", "candidates", "elapsed_s"}));
  EXPECT_EQ(report["verdict"], "tied");
  EXPECT_EQ(report["elapsed_s"], 12.5);

  const Json place = report["location"][0];
  EXPECT_EQ(place["balance"], "pump_torque");
  EXPECT_EQ(place["share"], 0.93);
  EXPECT_EQ(place["where"], "|motor_speed| < 5 rad/s, at reversals");
  EXPECT_EQ(place["windows"][0], Json({{"run", "square <wave>"}, {"from_s", 1.4}, {"to_s", 1.75}}));

  const Json effect = report["effects"][0];
  EXPECT_THAT(Keys(effect), IsSupersetOf({"id", "says", "equation", "parameters", "tied_with"}));
  EXPECT_EQ(effect["parameters"]["static_excess"],
            Json({{"value", 0.52}, {"ci95", {0.47, 0.57}}, {"unit", "1"}}));
  EXPECT_EQ(effect["tied_with"], Json::array());
  EXPECT_EQ(effect["share"], 0.86);
  EXPECT_EQ(effect["weight"], 0.95);
  EXPECT_TRUE(report["effects"][1]["share"].is_null()) << "not known";
  EXPECT_EQ(report["effects"][1]["tied_with"], Json({"sensor.skew"}));

  EXPECT_EQ(report["parameters"][0], Json({{"name", "b"},
                                           {"model", 0.01455},
                                           {"fitted", 0.0203},
                                           {"ci95", {0.0199, 0.0207}},
                                           {"unit", "in-lbf-s"},
                                           {"implausible", false}}));
  EXPECT_EQ(report["parameters"][1]["implausible"], true);

  const Json gap = report["gap"];
  EXPECT_EQ(gap["signals"]["p1"]["unit"], "psi");
  EXPECT_EQ(gap["signals"]["p1"]["noise"], 1.5);
  EXPECT_EQ(gap["signals"]["p1"]["fit"]["before"], 41.0);
  EXPECT_EQ(gap["signals"]["p1"]["held_out"]["after"], 1.6);
  EXPECT_EQ(gap["fit"], Json({{"before", 22.1}, {"refit_only", 18.0}, {"after", 1.04}}));
  EXPECT_EQ(gap["held_out"], Json({{"before", 23.9}, {"refit_only", 19.5}, {"after", 1.06}}));

  EXPECT_EQ(report["next_experiment"]["config"], "next.toml");
  EXPECT_THAT(Keys(report["next_experiment"]), IsSupersetOf({"why", "config"}));
  const Json candidate = report["candidates"][1];
  EXPECT_EQ(candidate["weight"], 0.125);
  EXPECT_EQ(candidate["id"], "pump.friction_asymmetry");
  EXPECT_EQ(candidate["held_out"], 15.1);
  EXPECT_EQ(candidate["p_value"], 0.002);
  EXPECT_EQ(candidate["rejected_because"], "the held-out gap stays 13 times as large");
}

// Tests that each horizon is reported with its seconds, gaps and signals.
TEST(ReportJson, Horizons) {
  Diagnosis diagnosis = testing::EmptyDiagnosis();
  SignalGap p1;
  p1.noise = 1.5;
  p1.held_out = {30, 12, 3};
  diagnosis.horizons = {{0.1, {8, 7, 1.1}, {9, 7.5, 1.2}, {p1}}};
  const Json horizon = Json::parse(ReportJson(diagnosis, "", 1))["gap"]["horizons"][0];
  EXPECT_EQ(horizon["seconds"], 0.1);
  EXPECT_EQ(horizon["fit"]["refit_only"], 7);
  EXPECT_EQ(horizon["held_out"]["after"], 1.2);
  EXPECT_EQ(horizon["signals"]["p1"]["held_out"]["before"], 30);
  EXPECT_EQ(horizon["signals"]["p1"]["unit"], "psi");
}

// Tests that numbers that are not finite become null, and that there is no next experiment where none is
// needed.
TEST(ReportJson, Nothing) {
  const Json example = Json::parse(ReportJson(testing::ExampleDiagnosis(), "next.toml", 1));
  EXPECT_TRUE(example["candidates"][2]["held_out"].is_null());
  EXPECT_TRUE(example["parameters"][2]["ci95"][0].is_null());
  const Json empty = Json::parse(ReportJson(testing::EmptyDiagnosis(), "", 1));
  EXPECT_EQ(empty["verdict"], "nothing_missing");
  EXPECT_EQ(empty["location"], Json::array());
  EXPECT_EQ(empty["effects"], Json::array());
  EXPECT_EQ(empty["gap"]["signals"], Json::object());
  EXPECT_TRUE(empty["next_experiment"].is_null());
}

// Tests that names that are not UTF-8 stop no part of a report, and that every part is UTF-8 all the same.
TEST(ReportJson, ForeignBytes) {
  const std::string foreign = "caf\xe9\xed\xa0\x80\x1b[31m";  // Latin-1, a surrogate, a terminal's red
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  diagnosis.runs = diagnosis.held_out_runs = {foreign};
  diagnosis.sentence += " " + foreign;
  diagnosis.remarks = {foreign};
  diagnosis.location.front().where = diagnosis.effects.front().summary = foreign;
  diagnosis.effects.front().names = {"signal = " + foreign};
  diagnosis.candidates.front().id = foreign;
  const std::string json = ReportJson(diagnosis, foreign, 1);
  EXPECT_TRUE(Json::accept(json));
  EXPECT_THAT(Json::parse(json)["runs"][0].get<std::string>(), HasSubstr("caf\uFFFD"));
  const std::string summary = TerminalSummary(diagnosis, foreign, false);
  for (const std::string& part :
       {json, ReportHtml(diagnosis, false), CommentedModel(diagnosis, diagnosis.model), summary})
    EXPECT_TRUE(IsUtf8(part)) << part.substr(0, 200);
  EXPECT_THAT(summary, HasSubstr("caf\\xe9"));
  EXPECT_THAT(summary, Not(HasSubstr("\x1b")));
}

// Tests that what the runs say nothing of is listed with the reason.
TEST(ReportJson, CannotJudge) {
  Diagnosis diagnosis = testing::EmptyDiagnosis();
  EXPECT_EQ(Json::parse(ReportJson(diagnosis, "", 1))["cannot_judge"], Json::array());
  diagnosis.unjudged = {{{"valve.check", "valve.relief"}, "p1 and p2 were not recorded"}};
  EXPECT_EQ(Json::parse(ReportJson(diagnosis, "", 1))["cannot_judge"],
            Json::array({{{"effects", {"valve.check", "valve.relief"}},
                          {"because", "p1 and p2 were not recorded"}}}));
}

// Tests that explanations are lists of changes with their weights, "nothing" the empty one, and how many hold
// the truth.
TEST(ReportJson, Explanations) {
  const Json report = Json::parse(ReportJson(testing::ExampleDiagnosis(60), "", 1));
  EXPECT_EQ(report["explanations"][0], Json({{"changes", {"pump.stribeck"}}, {"weight", 0.8125}}));
  EXPECT_EQ(report["explanations"][2]["changes"], Json({"pump.stribeck", "run.T_s"}));
  EXPECT_EQ(report["explanations"][3]["changes"], Json::array());
  EXPECT_EQ(report["set_90"], 2);
  const Json empty = Json::parse(ReportJson(testing::EmptyDiagnosis(), "", 1));
  EXPECT_EQ(empty["explanations"], Json::array());
  EXPECT_EQ(empty["set_90"], 0);
}

// Tests the names of verdicts.
TEST(ReportJson, Verdicts) {
  EXPECT_EQ(VerdictName(Verdict::kNamed), "named");
  EXPECT_EQ(VerdictName(Verdict::kTied), "tied");
  EXPECT_EQ(VerdictName(Verdict::kPartly), "partly");
  EXPECT_EQ(VerdictName(Verdict::kParameters), "parameters");
  EXPECT_EQ(VerdictName(Verdict::kUnexplained), "unexplained");
  EXPECT_EQ(VerdictName(Verdict::kNothingMissing), "nothing_missing");
}

// Tests that what the other runs choose without each run is there, and an empty list where runs were held out
// by name.
TEST(ReportJson, WhatIsChosenWithoutEachRun) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  EXPECT_EQ(Json::parse(ReportJson(diagnosis, "", 1))["chosen_without"], Json::array());
  diagnosis.choices = {{"a", "amp.lag", true}, {"b", "as given", false}};
  EXPECT_EQ(Json::parse(ReportJson(diagnosis, "", 1))["chosen_without"][1],
            Json({{"run", "b"}, {"chosen", "as given"}, {"same", false}}));
}

}  // namespace
}  // namespace hydro::diagnose
