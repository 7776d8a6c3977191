#include "experiments/run_experiments.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/input_error.h"
#include "experiments/report/experiment_files.h"
#include "experiments/report/report.h"
#include "experiments/studies/experiment.h"
#include "tests/temporary_folder.h"

namespace hydro::experiments {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;
namespace fs = std::filesystem;

ExperimentResult Invented(const ExperimentOptions& options) {
  ExperimentResult result;
  result.conditions = "invented, T_s < 4";
  result.paper_says = "something";
  result.explanation = "because";
  result.comparisons = {{"peak of p_2", "psi", "1500", 1512.6, 1512.5, "a remark"},
                        {"nothing", "", "", NAN, NAN, ""}};
  result.numbers = R"({"peak_p2_psi": 1512.5, "seed_used": )" + std::to_string(options.seed) + "}";
  result.table.columns = {{"time_s", {0, 1}}, {"p2_psi", {100, NAN}}};
  page::Figure figure;
  figure.caption = "invented";
  figure.drawing = "<svg viewBox=\"0 0 10 10\"><circle r=\"3\"/></svg>";
  result.pictures = {{"", figure}, {"-more", figure}};
  for (int number = 1; number <= kFindings; ++number) {
    result.findings.push_back({number, "says", "evidence " + std::to_string(number), "treated"});
  }
  options.progress(1);
  return result;
}

ExperimentResult WithoutFindings(const ExperimentOptions& options) {
  ExperimentResult result = Invented(options);
  result.findings.resize(3);
  return result;
}

ExperimentResult Failing(const ExperimentOptions&) { throw std::runtime_error("the <pump> broke"); }

ExperimentResult Measured(const ExperimentOptions& options) {
  if (!options.measured_run.empty()) throw InputError(options.measured_run + ": no steady state");
  return Invented(options);
}

std::vector<Experiment> Two() {
  return {{"fig3", "Figure 3: a step", Invented, 0.1}, {"friction", "Friction", Measured, 2, true}};
}

class RunExperimentsTest : public ::testing::Test {
 protected:
  int Run(const std::vector<Experiment>& experiments, ExperimentRequest request) {
    if (request.folder == ExperimentRequest().folder) request.folder = folder_ / "out";
    char* out = nullptr;
    char* errors = nullptr;
    size_t out_size = 0;
    size_t errors_size = 0;
    std::FILE* out_file = open_memstream(&out, &out_size);
    std::FILE* errors_file = open_memstream(&errors, &errors_size);
    int exit_code = -1;
    std::exception_ptr failure;
    try {
      exit_code = RunExperiments(experiments, request, out_file, errors_file);
    } catch (...) {
      failure = std::current_exception();
    }
    std::fclose(out_file);
    std::fclose(errors_file);
    out_ = out;
    errors_ = errors;
    std::free(out);
    std::free(errors);
    if (failure) std::rethrow_exception(failure);
    return exit_code;
  }

  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / "out"))
      names.push_back(entry.path().filename());
    return names;
  }
  std::string Read(const std::string& name) const {
    std::ifstream in(folder_ / ("out/" + name));
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
  }

  const TemporaryFolder folder_;
  std::string out_;
  std::string errors_;
};

// Tests that one experiment writes its own files and no others, and prints its comparisons.
TEST_F(RunExperimentsTest, OneExperiment) {
  EXPECT_EQ(Run(Two(), {.name = "fig3"}), 0);
  EXPECT_THAT(Files(), UnorderedElementsAre("fig3.json", "fig3.csv", "fig3.svg", "fig3-more.svg"));
  EXPECT_THAT(out_, HasSubstr("peak of p_2"));
  EXPECT_THAT(out_, HasSubstr("finding 10: says"));
  const auto json = ParseJson(Read("fig3.json"));
  EXPECT_EQ(json["peak_p2_psi"], 1512.5);
  EXPECT_EQ(json["seed_used"], 1);
  EXPECT_EQ(json["name"], "fig3");
  EXPECT_EQ(json["comparisons"][0]["independent"], 1512.6);
  EXPECT_TRUE(json["comparisons"][1]["here"].is_null());
  EXPECT_EQ(json["findings"].size(), 10u);
  EXPECT_EQ(Read("fig3.csv"), "time_s,p2_psi\n0,100\n1,\n");
}

// Tests that all of them write the same bytes in any number of threads, with a report that lists each.
TEST_F(RunExperimentsTest, AllTwice) {
  EXPECT_EQ(Run(Two(), {.name = "all", .jobs = 1}), 0);
  std::map<std::string, std::string> first;
  for (const std::string& name : Files()) first[name] = Read(name);
  EXPECT_EQ(first.size(), 9u);
  EXPECT_EQ(Run(Two(), {.name = "all", .folder = folder_ / "other", .jobs = 8}), 0);
  fs::remove_all(folder_ / "out");
  fs::rename(folder_ / "other", folder_ / "out");
  for (const auto& [name, text] : first) EXPECT_EQ(Read(name), text) << name;
  const std::string& html = first["index.html"];
  EXPECT_THAT(html, HasSubstr("<section id=\"fig3\">"));
  EXPECT_THAT(html, HasSubstr("href=\"#friction\""));
  EXPECT_THAT(html, HasSubstr("T<sub>s</sub> &lt; 4"));
  for (int number = 1; number <= kFindings; ++number) {
    EXPECT_THAT(html, HasSubstr("evidence " + std::to_string(number) + "<"));
  }
  // Self-contained: it loads nothing and runs nothing.
  for (const char* outside : {"src=", "<script", "<link", "@import", "url("}) {
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  }
  EXPECT_THAT(errors_, HasSubstr("(2 of 2)\n"));
  EXPECT_THAT(errors_, Not(HasSubstr("\r")));
}

// Tests that a failing experiment stops no other, is named in the report, leaves no file, and gives exit code
// 1.
TEST_F(RunExperimentsTest, FailureStopsNoOther) {
  std::vector<Experiment> experiments = Two();
  experiments.insert(experiments.begin(), {"fig2", "Figure 2", Failing, 5});
  EXPECT_EQ(Run(experiments, {.name = "all"}), 1);
  EXPECT_THAT(errors_, HasSubstr("hydro-experiment: fig2 failed: the <pump> broke\n"));
  EXPECT_THAT(Read("index.html"), HasSubstr("the &lt;pump&gt; broke"));
  EXPECT_THAT(Read("index.html"), HasSubstr("<section id=\"friction\">"));
  EXPECT_FALSE(fs::exists(folder_ / "out/fig2.json"));
  EXPECT_TRUE(fs::exists(folder_ / "out/fig3.json"));
}

// Tests that a finding without evidence makes the whole report an error, and that the report names it.
TEST_F(RunExperimentsTest, MissingFindingIsAnError) {
  EXPECT_EQ(Run({{"fig3", "Figure 3", WithoutFindings}}, {.name = "all"}), 1);
  EXPECT_THAT(errors_, HasSubstr("no experiment gave evidence for finding 4, 5, 6, 7, 8, 9, 10\n"));
  EXPECT_THAT(Read("index.html"), HasSubstr("no experiment gave evidence for it"));
}

// Tests that wrong usage is an input error that says what is allowed.
TEST_F(RunExperimentsTest, WrongUsage) {
  const auto refusal = [&](const ExperimentRequest& request) -> std::string {
    try {
      Run(Two(), request);
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal({.name = "fig4"}),
            "NAME: found 'fig4', allowed fig3, friction, all, did you mean \"fig3\"?");
  ExperimentRequest run{.name = "fig3"};
  run.options.measured_run = "x.csv";
  EXPECT_EQ(refusal(run), "--run: found for 'fig3', allowed for friction");
  run.name = "all";
  EXPECT_THAT(refusal(run), HasSubstr("--run: found for 'all'"));
  ExperimentRequest noise{.name = "fig3"};
  noise.options.noise = true;
  EXPECT_EQ(refusal(noise), "--noise: found for 'fig3', allowed for all");
  EXPECT_EQ(refusal({.name = "fig3", .real_time = true}), "--real-time: found for 'fig3', allowed for all");
  run.name = "friction";
  EXPECT_EQ(refusal(run), "x.csv: no steady state");
  run.folder = folder_ / "out";
  run.options.measured_run = run.folder + "/friction.csv";
  EXPECT_FALSE(std::filesystem::exists(run.folder)) << "left by a refusal";
  std::filesystem::create_directory(run.folder);
  std::ofstream(run.options.measured_run) << "time_s\n0\n";
  EXPECT_THAT(refusal(run), HasSubstr("out/friction.csv: found the name of a file that is read"));
  EXPECT_EQ(errors_, "");  // so that the caller's line is the only one
  EXPECT_THAT(refusal({.name = "fig3", .folder = "/proc/none"}),
              HasSubstr("--out: found \"/proc/none\", a folder that cannot be written"));
}

// Tests that an experiment whose numbers are no object, or hide a key common to all files, is a programming
// error.
TEST(ExperimentFiles, NumbersAreAnObject) {
  ExperimentResult result;
  const Experiment experiment{"x", "X", Invented};
  result.numbers = "[1]";
  EXPECT_THROW(ExperimentJson(experiment, result, {}, false), std::logic_error);
  result.numbers = R"({"title": 1})";
  EXPECT_THROW(ExperimentJson(experiment, result, {}, false), std::logic_error);
}

// Tests the conversion to SI against handbook values: 1 psi = 6.894757 kPa, 1 in-lbf = 0.1129848 N m, 1 in^3
// = 16.387064 cm^3.
TEST(ComparisonText, Si) {
  const std::vector<Comparison> si = InSi({{"a", "psi", "100", 100, 10, ""},
                                           {"b", "psi", "", 2000, NAN, ""},
                                           {"c", "in-lbf", "about 7300", NAN, 1, ""},
                                           {"d", "in^3", "3.16 or so", NAN, 1, ""},
                                           {"e", "rpm", "12.4", NAN, 12.4, ""},
                                           {"f", "in^3/(s psi)", "", NAN, 1, ""}});
  EXPECT_EQ(si[0].unit, "kPa");
  EXPECT_NEAR(si[0].expected, 689.4757, 1e-4);
  EXPECT_EQ(si[0].paper, "689.5");
  EXPECT_EQ(si[1].unit, "MPa");
  EXPECT_NEAR(si[1].expected, 13.789514, 1e-6);
  EXPECT_EQ(si[2].unit, "N m");
  EXPECT_NEAR(si[2].here, 0.1129848, 1e-7);
  EXPECT_EQ(si[2].paper, "about 824.8");
  EXPECT_EQ(si[3].unit, "cm^3");
  EXPECT_NEAR(si[3].here, 16.387064, 1e-6);
  EXPECT_EQ(si[3].paper, "3.16 or so in^3");
  EXPECT_EQ(si[4].unit, "rpm");
  EXPECT_EQ(si[4].here, 12.4);
  EXPECT_NEAR(si[5].here, 16.387064 / 6.894757e-3, 1e-3);
}

// Tests that the columns are aligned, even with letters of more than one byte, and that a dash stands for
// missing values.
TEST(ComparisonText, AlignedTable) {
  EXPECT_EQ(ComparisonsText({{"Δp", "psi", "", NAN, 1412.6, ""}, {"x", "", "12", 3, 4.00001, "why"}}, false),
            "  quantity  paper  independent    here  unit\n"
            "  Δp            -            -  1412.6  psi\n"
            "  x            12            3       4\n"
            "      why\n");
  EXPECT_EQ(ComparisonsText({}, false), "");
}

}  // namespace
}  // namespace hydro::experiments
