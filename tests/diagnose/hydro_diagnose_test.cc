#include "diagnose/hydro_diagnose.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "base/new_file.h"
#include "diagnose/report/progress_bar.h"
#include "diagnose/report/report.h"
#include "settings/model_file.h"
#include "tests/diagnose/example_diagnosis.h"
#include "tests/table1.h"
#include "tests/temporary_folder.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::UnorderedElementsAre;

namespace fs = std::filesystem;

class HydroDiagnoseTest : public ::testing::Test {
 protected:
  HydroDiagnoseTest() {
    Write("model.toml", settings::FormatModel({"Table 1", testing::Table1(), {}}));
    for (const char* stem : {"a", "b"}) {
      Write(stem + std::string(".csv"), Table(stem[0]));
      Write(stem + std::string(".toml"),
            "shaft = \"clamped\"\n[columns]\ntime = \"time_s\"\nvoltage = \"voltage_V\"\np1 = \"p1_psi\"\n");
    }
    request_.runs = {Path("a.csv")};
    request_.model = Path("model.toml");
    request_.folder = Path("out");
  }

  // A run whose pressures begin there.
  static std::string Table(int first) {
    std::string table = "time_s,voltage_V,p1_psi\n";
    for (int i = 0; i < 120; ++i) {
      table += std::to_string(0.001 * i) + ",2," + std::to_string(first + i % 7) + "\n";
    }
    return table;
  }
  std::string Path(const std::string& name) const { return folder_ / name; }
  void Write(const std::string& name, const std::string& text) const { std::ofstream(Path(name)) << text; }
  std::string Read(const std::string& name) const {
    std::ifstream in(Path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  std::vector<std::string> Files() const {
    std::vector<std::string> names;
    if (!fs::exists(Path("out"))) return names;
    for (const auto& entry : fs::directory_iterator(Path("out"))) names.push_back(entry.path().filename());
    return names;
  }

  // What is printed on standard output for `diagnosis`.
  std::string Run(const Diagnosis& diagnosis) {
    return Run([&](const model::ModelDescription& model, std::vector<runs::MeasuredRun> runs,
                   std::vector<runs::MeasuredRun> held_out, const DiagnoseOptions& options,
                   const ProgressCallback& report_progress) {
      model_ = model;
      runs_ = std::move(runs);
      held_out_ = std::move(held_out);
      options_ = options;
      report_progress({"trying each effect", 0.5});
      return diagnosis;
    });
  }
  std::string Run(const Diagnoser& diagnoser) {
    std::FILE* out = std::tmpfile();
    std::FILE* err = std::tmpfile();
    try {
      RunDiagnosis(request_, diagnoser, out, err);
    } catch (...) {
      EXPECT_EQ(std::ftell(err), 0);
      std::fclose(out);
      std::fclose(err);
      throw;
    }
    EXPECT_GT(std::ftell(err), 0);  // progress
    std::string text(static_cast<size_t>(std::ftell(out)), '\0');
    std::rewind(out);
    EXPECT_EQ(std::fread(text.data(), 1, text.size(), out), text.size());
    std::fclose(out);
    std::fclose(err);
    return text;
  }
  // The one-line error for a request that cannot be met; nothing may be left behind.
  std::string ErrorOf(const DiagnoseRequest& request) {
    request_ = request;
    try {
      Run(testing::EmptyDiagnosis());
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_FALSE(fs::exists(Path("out")));
      return text;
    }
    return "no error";
  }

  const TemporaryFolder folder_;
  DiagnoseRequest request_;
  model::ModelDescription model_;
  std::vector<runs::MeasuredRun> runs_, held_out_;
  DiagnoseOptions options_;
};

// Tests that the files named in the request reach the diagnosis, and that its results reach the report.
TEST_F(HydroDiagnoseTest, ReadsAndWrites) {
  Write("effects.toml", "effects = [\"pump.stribeck\", \"amp.lag\", \"amp.lag\"]\n");
  request_.held_out = {Path("b.csv")};
  request_.effects = Path("effects.toml");
  request_.free = "b,T_s";
  request_.jobs = 3;
  request_.seed = 7;
  const std::string told = Run(testing::ExampleDiagnosis());
  EXPECT_EQ(model_.parameters.k_1, 4.0);
  ASSERT_EQ(runs_.size(), 1u);
  EXPECT_EQ(runs_[0].name, "a");
  ASSERT_EQ(held_out_.size(), 1u);
  EXPECT_EQ(held_out_[0].name, "b");
  EXPECT_THAT(options_.effects, ElementsAre("pump.stribeck", "amp.lag"));
  EXPECT_THAT(options_.free, ElementsAre("b", "T_s"));
  EXPECT_EQ(options_.jobs, 3);
  EXPECT_EQ(options_.seed, 7u);

  EXPECT_THAT(Files(), UnorderedElementsAre("report.html", "report.json", "model.toml", "next.toml"));
  EXPECT_THAT(Read("out/report.json"), HasSubstr("\"config\": \"next.toml\""));
  EXPECT_EQ(Read("out/next.toml"), "[model]\nfile = \"model.toml\"\n");
  EXPECT_THAT(told, Not(HasSubstr("trying each effect")));  // progress, which goes to the other stream
  EXPECT_THAT(told, HasSubstr("tied: The pump's static friction"));
}

// Tests that the model written is the one found: numbers bit by bit, and names of signals too.
TEST_F(HydroDiagnoseTest, ModelRoundTrips) {
  const Diagnosis diagnosis = testing::ExampleDiagnosis();
  Run(diagnosis);
  const model::ModelDescription read = settings::LoadModelFile(Path("out/model.toml"));
  EXPECT_EQ(read.name, diagnosis.model.name);
  EXPECT_EQ(read.parameters.c, diagnosis.model.parameters.c);
  ASSERT_EQ(read.effects.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(read.effects[i].id, diagnosis.model.effects[i].id);
    EXPECT_EQ(read.effects[i].parameters, diagnosis.model.effects[i].parameters);
    EXPECT_EQ(read.effects[i].names, diagnosis.model.effects[i].names);
  }
}

// Tests that each changed value has a comment with its interval, its source and what it was, in the file and
// on the page, and that a value as given has none.
TEST_F(HydroDiagnoseTest, ModelHasComments) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  diagnosis.model.parameters.b = 0.0203;
  diagnosis.model.parameters.D *= 1.01;
  diagnosis.per_run = {{"T_s", "in-lbf", {{"a", 3, 2.9, 3.1, ""}, {"b", 5, 4.9, 5.1, ""}}, 4, 2}};
  diagnosis.effects[0].summary = "more\nthan a line";
  Run(diagnosis);
  const std::string model = Read("out/model.toml");
  EXPECT_TRUE(model.starts_with("# Written by hydro-diagnose "));
  EXPECT_THAT(
      model, HasSubstr("\nb = 0.0203  # 95 %: 0.0199 to 0.0207 in-lbf-s, fitted to the runs; was 0.01455\n"));
  EXPECT_THAT(model,
              HasSubstr("# 95 %: 0.09 to 0.15 lbf-in-s^2, fitted to the runs; was 0.03; implausible\n"));
  EXPECT_THAT(model, HasSubstr("# no interval, fitted to the runs; was 100\n"));
  EXPECT_THAT(model,
              HasSubstr("  # refitted with the others; was 0.00796, which these runs do not exclude\n"));
  EXPECT_THAT(model, HasSubstr("  # differs from run to run by "));
  EXPECT_THAT(model, HasSubstr("\n[effects.\"pump.stribeck\"]  # found in the runs: more\\x0athan a line\n"));
  EXPECT_THAT(model, HasSubstr("\nstatic_excess = 0.52  # 95 %: 0.47 to 0.57, found in the runs\n"));
  EXPECT_THAT(model, HasSubstr("these runs cannot tell it from sensor.skew"));
  EXPECT_THAT(model, HasSubstr("\nk_1 = 4.0\n"));
  EXPECT_EQ(settings::FormatModel(settings::LoadModelFile(Path("out/model.toml"))),
            settings::FormatModel(diagnosis.model));
  EXPECT_THAT(Read("out/report.html"), HasSubstr("was 0.01455\n"));
}

// Tests that the report of a motor alone speaks of the motor, and that ids and balances keep their names for
// programs.
TEST_F(HydroDiagnoseTest, MotorAlone) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  diagnosis.sentence =
      "Missing: friction of the pump differs between the directions [pump.friction_asymmetry].";
  diagnosis.effects[0].summary = "drag of the pump grows with the square of its speed";
  diagnosis.remarks = {"leakage and valves cannot be judged: no pressure was recorded"};
  diagnosis.candidates.push_back({"valve.relief", std::nan(""), std::nan(""), 1, diagnose::kNotProposed});
  EXPECT_THAT(Run(diagnosis), HasSubstr("friction of the pump"));
  EXPECT_THAT(Read("out/report.html"), HasSubstr("valve.relief"));
  fs::remove_all(Path("out"));
  for (const char* stem : {"a", "b"}) {
    Write(stem + std::string(".csv"), [] {
      std::string table = "time_s,voltage_V,speed\n";
      for (int i = 0; i < 120; ++i) table += std::to_string(0.001 * i) + ",2," + std::to_string(i % 7) + "\n";
      return table;
    }());
    Write(stem + std::string(".toml"),
          "shaft = \"clamped\"\nbypass = true\n[columns]\ntime = \"time_s\"\nvoltage = \"voltage_V\"\n"
          "motor_speed = \"speed\"\n");
  }
  const std::string told = Run(diagnosis);
  EXPECT_THAT(told, HasSubstr("Missing: friction of the motor or its gear differs between the directions "
                              "[pump.friction_asymmetry]."));
  EXPECT_THAT(told, HasSubstr("where:      motor torque"));
  EXPECT_THAT(told, Not(HasSubstr("leakage and valves")));
  const std::string page = Read("out/report.html"), json = Read("out/report.json");
  EXPECT_THAT(page, HasSubstr("drag of the motor or its gear grows"));
  EXPECT_THAT(page, Not(HasSubstr("valve.relief")));
  EXPECT_THAT(page, HasSubstr("missing in motor torque"));
  EXPECT_THAT(json, HasSubstr("\"balance\": \"pump_torque\""));
  EXPECT_THAT(json, HasSubstr("\"says\": \"drag of the motor or its gear grows"));
}

// Tests that an earlier report stays to the bit unless --force is given, whichever of its files is left of
// it; that other files in its folder are no hindrance; and that nothing is read or tried before.
TEST_F(HydroDiagnoseTest, AnEarlierReportStays) {
  for (const char* name : {"report.html", "report.json", "model.toml", "next.toml"}) {
    fs::remove_all(Path("out"));
    fs::create_directory(Path("out"));
    Write("out/notes.txt", "mine");
    Write("out/" + std::string(name), "yesterday");
    request_.runs = {Path("none.csv")};
    try {
      Run(testing::EmptyDiagnosis());
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(Path("out/") + name + ": found a file of this name"));
      EXPECT_THAT(error.what(), HasSubstr("--force"));
    }
    EXPECT_THAT(Files(), UnorderedElementsAre("notes.txt", name));
    EXPECT_EQ(Read("out/" + std::string(name)), "yesterday");
    request_.runs = {Path("a.csv")};
    Write("out/" + std::string(name), "");  // an empty file, as mktemp leaves, is no result
    Run(testing::EmptyDiagnosis());
    EXPECT_THAT(Files(), ::testing::IsSupersetOf({"notes.txt", "report.html", "report.json", "model.toml"}));
  }
}

// Tests that a report which appears while the runs are diagnosed stays too.
TEST_F(HydroDiagnoseTest, AReportThatAppearedMeanwhileStays) {
  std::FILE* told = std::tmpfile();
  const Diagnoser slow = [&](const model::ModelDescription&, std::vector<runs::MeasuredRun>,
                             std::vector<runs::MeasuredRun>, const DiagnoseOptions&,
                             const ProgressCallback&) {
    Write("out/report.json", "somebody else's");
    return testing::ExampleDiagnosis();
  };
  EXPECT_THROW(RunDiagnosis(request_, slow, told, told), InputError);
  std::fclose(told);
  EXPECT_EQ(Read("out/report.json"), "somebody else's");
  EXPECT_THAT(Files(), ElementsAre("report.json"));
}

// Tests that a folder which was there before stays when nothing is written into it.
TEST_F(HydroDiagnoseTest, AnEmptyFolderStays) {
  fs::create_directory(Path("out"));
  request_.model = Path("none.toml");
  EXPECT_THROW(Run(testing::EmptyDiagnosis()), InputError);
  EXPECT_TRUE(fs::exists(Path("out")));
}

// Tests that --force replaces an earlier report, and removes its next experiment when there is none now.
TEST_F(HydroDiagnoseTest, NoStaleNextExperiment) {
  Run(testing::ExampleDiagnosis());
  AllowReplacing();
  Run(testing::EmptyDiagnosis());
  AllowReplacing(false);
  EXPECT_THAT(Files(), UnorderedElementsAre("report.html", "report.json", "model.toml"));
}

// Tests that the same diagnosis gives the same report, page and model to the bit.
TEST_F(HydroDiagnoseTest, Deterministic) {
  Run(testing::ExampleDiagnosis());
  const std::string page = Read("out/report.html"), model = Read("out/model.toml");
  fs::remove_all(Path("out"));
  Run(testing::ExampleDiagnosis());
  EXPECT_EQ(Read("out/report.html"), page);
  EXPECT_EQ(Read("out/model.toml"), model);
}

// Tests that each fault of a request gives one line that names it, and leaves nothing behind.
TEST_F(HydroDiagnoseTest, Errors) {
  const DiagnoseRequest good = request_;
  const auto error = [&](const std::function<void(DiagnoseRequest&)>& change) {
    DiagnoseRequest request = good;
    change(request);
    return ErrorOf(request);
  };
  EXPECT_THAT(error([](DiagnoseRequest& r) { r.jobs = 0; }), HasSubstr("--jobs: found 0, allowed 1 to 256"));
  EXPECT_THAT(error([](DiagnoseRequest& r) { r.time_limit = 0; }), HasSubstr("--time-limit: found 0"));
  EXPECT_THAT(error([](DiagnoseRequest& r) { r.time_limit = std::nan(""); }),
              HasSubstr("--time-limit: found"));
  EXPECT_THAT(error([](DiagnoseRequest& r) { r.seed = -1; }), HasSubstr("--seed: found -1"));
  EXPECT_THAT(error([](DiagnoseRequest& r) { r.free = "b,q"; }), HasSubstr("--free: found \"q\", allowed"));
  EXPECT_THAT(error([](DiagnoseRequest& r) { r.free = "b,"; }), HasSubstr("--free: found \"\""));
  EXPECT_THAT(error([](DiagnoseRequest& r) { r.free = "p3"; }), HasSubstr("did you mean \"p_3\"?"));
  for (const char* name : {"k_1", "k_2"}) {
    EXPECT_THAT(
        error([&](DiagnoseRequest& r) { r.per_run = std::string("T_s,") + name; }),
        HasSubstr("--per-run: found \"" + std::string(name) +
                  "\", by which torques are measured, allowed names separated by commas, of \"T_pmax\""));
  }
  EXPECT_THAT(error([&](DiagnoseRequest& r) { r.runs = {Path("none.csv")}; }), HasSubstr("none.csv: "));
  EXPECT_THAT(error([&](DiagnoseRequest& r) { r.model = Path("a.toml"); }), HasSubstr("a.toml"));
  EXPECT_THAT(error([&](DiagnoseRequest& r) { r.held_out = {Path("./a.csv")}; }),
              HasSubstr("already given as RUN, allowed each run once"));
  EXPECT_THAT(error([&](DiagnoseRequest& r) { r.folder = Path("a.csv"); }),
              HasSubstr("a folder that cannot be written"));
  EXPECT_THAT(error([&](DiagnoseRequest& r) { r.effects = Path("none"); }), HasSubstr("none: "));

  const auto effects = [&](const std::string& text) {
    Write("effects.toml", text);
    return error([&](DiagnoseRequest& r) { r.effects = Path("effects.toml"); });
  };
  EXPECT_THAT(effects("effects = [\"pump.stribek\"]\n"),
              HasSubstr("effects: found the unknown effect \"pump.stribek\""));
  EXPECT_THAT(effects("effects = [\"pump.stribek\"]\n"), HasSubstr("did you mean \"pump.stribeck\"?"));
  EXPECT_THAT(effects("effects = []\n"), HasSubstr("effects: found none, allowed a list"));
  EXPECT_THAT(effects("effects = [3]\n"), HasSubstr("effects: found 3"));
  EXPECT_THAT(effects("effects = \"pump.stribeck\"\n"), HasSubstr("effects: found \"pump.stribeck\""));
  EXPECT_THAT(effects("effect = []\n"), HasSubstr("effect"));
  EXPECT_THAT(effects(""), HasSubstr("effects: found nothing"));
}

// Tests that --check refuses the options that a diagnosis refuses, and prints nothing then.
TEST_F(HydroDiagnoseTest, CheckRefusesWhatADiagnosisDoes) {
  Write("no_list.toml", "effects = 3\n");
  const std::vector<std::pair<std::string, std::function<void(DiagnoseRequest&)>>> wrong = {
      {"--jobs: found 0", [](DiagnoseRequest& r) { r.jobs = 0; }},
      {"--time-limit: found 0", [](DiagnoseRequest& r) { r.time_limit = 0; }},
      {"--seed: found -1", [](DiagnoseRequest& r) { r.seed = -1; }},
      {"--free: found \"pump.stribeck\"", [](DiagnoseRequest& r) { r.free = "pump.stribeck"; }},
      {"--free: found \"\"", [](DiagnoseRequest& r) { r.free = "b,,T_s"; }},
      {"--per-run: found \"zzz\"", [](DiagnoseRequest& r) { r.per_run = "zzz"; }},
      {"none: ", [&](DiagnoseRequest& r) { r.effects = Path("none"); }},
      {"no_list.toml:1: effects: found 3", [&](DiagnoseRequest& r) { r.effects = Path("no_list.toml"); }}};
  const DiagnoseRequest good = request_;
  for (const auto& [said, change] : wrong) {
    DiagnoseRequest request = good;
    request.check = true;
    change(request);
    std::FILE* out = std::tmpfile();
    try {
      CheckRuns(request, out);
      ADD_FAILURE() << said << " is not refused";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr(said));
      EXPECT_EQ(error.what(), ErrorOf(request));
    }
    EXPECT_EQ(std::ftell(out), 0);
    std::fclose(out);
  }
}

// Tests that no report replaces what it was made from.
TEST_F(HydroDiagnoseTest, KeepsItsInputs) {
  request_.folder = folder_.path();
  const std::string before = Read("model.toml");
  EXPECT_THAT(ErrorOf(request_), HasSubstr("model.toml"));
  EXPECT_EQ(Read("model.toml"), before);
  fs::rename(Path("a.csv"), Path("report.json"));
  request_.model = Path("other.toml");
  request_.runs = {Path("b.csv"), Path("report.json")};
  Write("other.toml", before);
  EXPECT_THAT(ErrorOf(request_), HasSubstr("report.json"));
}

// Tests that a copy of a fitted run is no proof, also where its name and sidecar differ.
TEST_F(HydroDiagnoseTest, ACopyIsRefused) {
  Write("copy.csv", Table('a'));
  Write("copy.toml", "name = \"another day\"\n" + Read("a.toml"));
  request_.held_out = {Path("copy.csv")};
  EXPECT_THAT(ErrorOf(request_), HasSubstr("copy.csv: found the same samples as in " + Path("a.csv")));
  request_.runs.push_back(Path("copy.csv"));
  request_.held_out.clear();
  EXPECT_THAT(ErrorOf(request_), HasSubstr("allowed each run once"));
}

// Tests that runs of one name are told apart by their files, and others keep their names.
TEST_F(HydroDiagnoseTest, RunsOfOneName) {
  const std::string sidecar = Read("a.toml");
  fs::create_directory(Path("old"));
  for (const char* stem : {"c", "old/b", "old/c"}) {
    Write(stem + std::string(".csv"), Table(110 + stem[0] + static_cast<int>(std::string(stem).size())));
    Write(stem + std::string(".toml"), "name = \"square\"\n" + sidecar);
  }
  Write("b.toml", "name = \"square\"\n" + sidecar);
  request_.runs = {Path("a.csv"), Path("b.csv"), Path("c.csv")};
  request_.held_out = {Path("old/c.csv")};
  Run(testing::EmptyDiagnosis());
  EXPECT_EQ(runs_[0].name, "a");
  EXPECT_EQ(runs_[1].name, "square (b)");
  EXPECT_EQ(runs_[2].name, "square (" + Path("c.csv") + ")");
  EXPECT_EQ(held_out_[0].name, "square (" + Path("old/c.csv") + ")");
}

// Tests that a model that cannot follow the runs is bad input, and that the error names the model.
TEST_F(HydroDiagnoseTest, ModelThatCannotFollow) {
  const Diagnoser diagnoser = [](const model::ModelDescription&, std::vector<runs::MeasuredRun>,
                                 std::vector<runs::MeasuredRun>, const DiagnoseOptions&,
                                 const ProgressCallback&) -> Diagnosis {
    throw model::ModelError("arm angle 1.5708 rad leaves V_1 = -2.63 in^3");
  };
  try {
    Run(diagnoser);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("model.toml: found a model that cannot follow the runs: arm angle"));
  }
  EXPECT_FALSE(fs::exists(Path("out")));
}

// Tests that the summary has about ten lines, and gives in SI what it gives in the paper's units.
TEST(TerminalSummary, TenLines) {
  const std::string text = TerminalSummary(testing::ExampleDiagnosis(), "out", false);
  const auto lines = std::count(text.begin(), text.end(), '\n');
  EXPECT_EQ(lines, 12);
  EXPECT_THAT(text, HasSubstr("23.9 before, 19.5 refitted only, 1.06 after"));
  EXPECT_THAT(text, HasSubstr("p1 44 -> 1.6 psi (noise 1.5)"));
  EXPECT_THAT(text, HasSubstr("static_excess 0.52 [0.47, 0.57]"));
  EXPECT_THAT(text, HasSubstr("delay 0.0021 [0.0019, 0.0023] s, signal = p1; tied with fluid.warming"));
  EXPECT_THAT(text, HasSubstr("b 0.0203 [0.0199, 0.0207] in-lbf-s, was 0.01455"));
  const std::string si = TerminalSummary(testing::ExampleDiagnosis(), "out", true);
  EXPECT_THAT(si, HasSubstr("p1 303.4 -> 11.03 kPa (noise 10.34)"));
  EXPECT_THAT(si, HasSubstr("b 0.002294 [0.002248, 0.002339] N m s, was 0.001644"));
  EXPECT_THAT(text, HasSubstr("held out, root mean squares: 6 -> 1.02 over 0.1 s; 12 -> 1.04 over 0.4 s"));
  EXPECT_THAT(text, HasSubstr("weight 95 %, without it 86 % of the gap comes back"));
  EXPECT_THAT(
      text,
      HasSubstr("\nlikely:     pump.stribeck 81 %, an unknown curve over motor speed in pump torque 13 %\n"));
  EXPECT_LT(text.find("effects:"), text.find("held out:")) << "what was found comes first";
}

// Tests that effects of which the runs say nothing have a line that says why.
TEST(TerminalSummary, CannotBeJudged) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  EXPECT_THAT(TerminalSummary(diagnosis, "out", false), Not(HasSubstr("Cannot be judged")));
  diagnosis.unjudged = {{{"line.wave", "valve.relief"}, "p1 and p2 were not recorded"}};
  EXPECT_THAT(
      TerminalSummary(diagnosis, "out", false),
      HasSubstr("\nCannot be judged from these runs: line.wave and valve.relief, because p1 and p2 were "
                "not recorded\n"));
}

// Tests that the likely explanations are as many as hold the truth nine times in ten, four at most, and that
// a single one has its rival beside it where that has a hundredth.
TEST(TerminalSummary, Likely) {
  Diagnosis diagnosis = testing::ExampleDiagnosis(60);
  diagnosis.set_90 = 1;
  diagnosis.explanations = {{{"amp.lag", "value.b"}, 0.93}, {{}, 0.07}, {{"amp.delay"}, 0}};
  EXPECT_THAT(
      TerminalSummary(diagnosis, "out", false),
      HasSubstr("likely:     amp.lag + another value of b 93 %, no effect (other values at most) 7 %\n"));
  diagnosis.explanations[1].weight = 0.001;
  EXPECT_THAT(TerminalSummary(diagnosis, "out", false), HasSubstr("another value of b 93 %\n"));
  diagnosis.explanations.assign(6, {{"run.T_s"}, 0.15});
  diagnosis.set_90 = 6;
  EXPECT_THAT(TerminalSummary(diagnosis, "out", false),
              HasSubstr("T_s that differs by run 15 %, and 2 more in the report\n"));
}

// Tests that the summary of an empty diagnosis leaves out what does not exist.
TEST(TerminalSummary, NothingMissing) {
  const std::string text = TerminalSummary(testing::EmptyDiagnosis(), "out", false);
  EXPECT_THAT(text, HasSubstr("nothing_missing: The model as given"));
  EXPECT_THAT(text, Not(HasSubstr("effects:")));
  EXPECT_THAT(text, Not(HasSubstr("likely:")));
  EXPECT_THAT(text, Not(HasSubstr("next.toml")));
}

// Tests that the progress bar shows stage and time left, never goes back and is wiped away, and that without
// a terminal each stage is a line.
TEST(ProgressBar, BarAndLines) {
  const auto told = [](bool terminal) {
    std::FILE* file = std::tmpfile();
    {
      ProgressBar bar(file, terminal);
      bar.Show({"reading", 0}, 0.1);
      bar.Show({"trying each effect", 0.25}, 10);
      bar.Show({"trying each effect", 0.2}, 11);
    }
    std::string text(static_cast<size_t>(std::ftell(file)), '\0');
    std::rewind(file);
    EXPECT_EQ(std::fread(text.data(), 1, text.size(), file), text.size());
    std::fclose(file);
    return text;
  };
  const std::string bar = told(true);
  EXPECT_THAT(bar, HasSubstr("[#######.......................] 25 % trying each effect, 30 s left"));
  EXPECT_THAT(bar, HasSubstr("25 % trying each effect, 33 s left"));
  EXPECT_TRUE(bar.ends_with("\r\033[K"));
  EXPECT_EQ(told(false), "reading\ntrying each effect\n");

  std::FILE* file = std::tmpfile();
  ProgressBar(file, false).Show({"reading", 0}, 0);  // what follows is an error
  EXPECT_EQ(std::ftell(file), 0);
  std::fclose(file);
}

}  // namespace
}  // namespace hydro::diagnose
