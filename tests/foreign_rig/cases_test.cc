// The rigs as files: drawn from the seed, readable, silent about what is in them.
#include "tests/foreign_rig/cases.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "model/effects/catalogue.h"
#include "model/terms/parameter_info.h"
#include "runs/measured/measured_run.h"
#include "settings/model_file.h"
#include "tests/foreign_rig/rig_folder.h"

namespace foreign_rig {
namespace {

namespace fs = std::filesystem;

class ForeignCases : public RigFolder {};

// Tests that the five runs and the three held out are read as measured runs of several kinds.
TEST_F(ForeignCases, RunsAreReadable) {
  Write(CaseNamed("values-1"), "a");
  int free_runs = 0, bypassed = 0, runs = 0;
  for (const char* name : {"run1", "run2", "run3", "run4", "run5", "held1", "held2", "held3"}) {
    const hydro::runs::MeasuredRun run = hydro::runs::ReadMeasuredRun(Folder("a") + "/" + name + ".csv");
    EXPECT_EQ(run.samples(), 251u);
    free_runs += run.shaft == hydro::model::Shaft::kFree ? 1 : 0;
    bypassed += run.bypass ? 1 : 0;
    ++runs;
  }
  EXPECT_EQ(runs, 8);
  EXPECT_GE(free_runs, 2);
  EXPECT_GE(bypassed, 1);
}

// Tests that the model file has every value as given, and how well each is known, as it was drawn.
TEST_F(ForeignCases, ModelFileStatesWhatIsKnown) {
  const Solved solved = Write(CaseNamed("values-1"), "a");
  const hydro::model::ModelDescription model = hydro::settings::LoadModelFile(Folder("a") + "/model.toml");
  std::map<std::string, double> known;
  for (const ValueForm& form : ValueForms()) {
    if (form.name != "f") known[form.name] = form.uncertainty;  // these models have no such friction
  }
  EXPECT_EQ(model.uncertainty, known);
  for (const hydro::model::BaseParameter& base : hydro::model::BaseParameters()) {
    for (const ValueForm& form : ValueForms()) {
      if (form.name != base.info.name) continue;
      EXPECT_NEAR(model.parameters.*base.member, solved.given.*form.value,
                  1e-9 * std::abs(solved.given.*form.value))
          << form.name;
    }
  }
  EXPECT_EQ(hydro::settings::ParseModel(hydro::settings::FormatModel(model), "again").uncertainty, known);
}

// Tests that a seed gives the same files and answers to the bit, and that another seed gives other runs and
// answers.
TEST_F(ForeignCases, SeedDecides) {
  Case c = CaseNamed("values-1");
  const Solved first = Write(c, "a");
  Write(c, "b");
  c.seed += 1;
  const Solved other = Write(c, "c");
  EXPECT_EQ(Text(Folder("a") + ".json"), Text(Folder("b") + ".json"));
  EXPECT_NE(Text(Folder("a") + ".json"), Text(Folder("c") + ".json"));
  for (const auto& entry : fs::directory_iterator(Folder("a"))) {
    const fs::path name = entry.path().filename();
    EXPECT_EQ(Text(entry.path()), Text(fs::path(Folder("b")) / name)) << name;
    if (name.extension() == ".toml" && name != "model.toml") continue;
    EXPECT_NE(Text(entry.path()), Text(fs::path(Folder("c")) / name)) << name;
  }
  EXPECT_NE(first.rig.values.displacement, other.rig.values.displacement);
  Rig rig = first.rig;
  const Truth here = FindEffect("pump.stribeck").put(0.5, 1, &rig);
  const Truth there = FindEffect("pump.stribeck").put(0.5, 2, &rig);
  EXPECT_NE(here.parameters[1].second, there.parameters[1].second);
}

// Tests that nothing handed over names what is in the rig, and that the key does.
TEST_F(ForeignCases, OnlyTheKeyTells) {
  Write(CaseNamed("sensor.pressure_lag-8"), "a");
  for (const auto& entry : fs::directory_iterator(Folder("a"))) {
    const std::string text = Text(entry.path());
    for (const std::string word : {"lag", "effect", "single", "richness", "given", "gap"})
      EXPECT_EQ(text.find(word), std::string::npos) << entry.path() << ": " << word;
  }
  const std::string key = Text(Folder("a") + ".json");
  for (const std::string word : {"sensor.pressure_lag", "\"class\": \"single\"", "\"richness\"", "\"tau\""})
    EXPECT_NE(key.find(word), std::string::npos) << word;
}

// Tests that every effect of the catalogue is there, in three sizes where it has sizes, and every class.
TEST_F(ForeignCases, CasesAreComplete) {
  std::map<std::string, int> kinds;
  std::set<std::string> names, whats;
  std::set<uint64_t> seeds;
  for (const Case& c : AllCases()) {
    ++kinds[c.kind];
    names.insert(c.name);
    seeds.insert(c.seed);
    whats.insert(c.what);
  }
  EXPECT_EQ(kinds["single"], 70);
  EXPECT_EQ(kinds["pair"], 12);
  EXPECT_EQ(kinds["nothing"], 24);
  EXPECT_EQ(kinds["bias"], 6);
  EXPECT_EQ(kinds["drift"], 6);
  EXPECT_EQ(kinds["newcomer"], 18);
  EXPECT_EQ(kinds["outside"], 36);
  EXPECT_EQ(kinds["exact"], 52);
  EXPECT_EQ(kinds["parameter"], 16);
  EXPECT_EQ(names.size(), AllCases().size());
  EXPECT_EQ(seeds.size(), AllCases().size());
  for (const EffectForm& form : EffectForms()) EXPECT_TRUE(whats.contains(form.id)) << form.id;
}

// Tests that cases which were scored before keep their seeds: others come after them.
TEST_F(ForeignCases, FormerCasesKeepTheirSeeds) {
  EXPECT_EQ(AllCases()[0].name, "amp.lag-3");
  EXPECT_EQ(AllCases()[0].seed, 50000u);
  EXPECT_EQ(AllCases()[165].name, "outside-10-15");
  EXPECT_EQ(AllCases()[165].seed, 165050495u);
}

// Tests that every number of the model is off, by no more than twice what its kind is known to.
TEST_F(ForeignCases, EveryValueIsWrong) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    const Values values = DrawValues(seed);
    const Values given = DrawGiven(values, seed);
    for (const ValueForm& form : ValueForms()) {
      if (values.*form.value == 0) continue;
      const double off = std::abs(given.*form.value / (values.*form.value) - 1);
      EXPECT_GE(off, 0.199 * form.uncertainty) << form.name;
      EXPECT_LE(off, 2.001 * form.uncertainty) << form.name;
    }
  }
}

// Tests that a newcomer's table is the right one but for the mistake.
TEST_F(ForeignCases, MistakesAreInTheTable) {
  Case c = CaseNamed("newcomer-bar-1");
  Write(c, "bar");
  c.what = "";  // the same rig without the mistake
  Write(c, "right");
  const auto bar = hydro::runs::ReadMeasuredRun(Folder("bar") + "/run2.csv");
  const auto right = hydro::runs::ReadMeasuredRun(Folder("right") + "/run2.csv");
  for (size_t i = 0; i < right.samples(); ++i)
    EXPECT_NEAR(bar.p2.values[i] * 14.5037738, right.p2.values[i], 1e-3);
  EXPECT_EQ(bar.motor_speed.values, right.motor_speed.values);
}

// Tests that a day's values are the run's own, and of the stated spread.
TEST_F(ForeignCases, DaysDiffer) {
  Daily daily;
  daily.friction = 0.1;
  std::vector<double> all;
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    std::vector<Plan> plans = DrawPlans(seed, 1, 0.3);
    ApplyDaily(daily, seed, &plans);
    for (const Plan& plan : plans) all.push_back(plan.day.friction - 1);
  }
  double square = 0;
  for (const double off : all) square += off * off / static_cast<double>(all.size());
  EXPECT_NEAR(std::sqrt(square), 0.1, 0.01);
}

}  // namespace
}  // namespace foreign_rig
