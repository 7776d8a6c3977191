// The same machine in other units gives the same numbers: experiments read logs of models in any.
#include "experiments/studies/paper_units.h"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/leakage_fit.h"
#include "runs/log/log_writer.h"
#include "settings/model_file.h"
#include "sim/simulation.h"
#include "tests/model_in_units.h"

namespace hydro::experiments {
namespace {

using hydro::testing::InUnits;
using hydro::testing::kSystems;
using hydro::testing::WithArm;
using nlohmann::json;
using ::testing::HasSubstr;

// What both experiments need, with the quantities in units of their own, so that it is the same run whatever
// the model's are. `held` is where the arm is clamped.
std::string Config(double duration, const std::string& steps, bool bypass, const std::string& held) {
  return "[model]\nfile = \"model.toml\"\nshaft = \"clamped\"\narm_angle = \"" + held +
         "\"\nbypass = " + (bypass ? "true" : "false") +
         "\n[time]\nmode = \"lockstep\"\nduration_s = " + std::to_string(duration) +
         "\n[plant]\nrate_hz = 1000\n[pressure]\nk_p = 0.0\nk_v = 0.0\n"
         "[position]\nsample_interval_s = 0.001\n"
         "[reference]\nsignal = \"voltage\"\nkind = \"steps\"\nsteps = [" +
         steps + "]\n[noise]\nseed = 1\nmotor_speed = 0.1\np1 = \"3 psi\"\np2 = \"3 psi\"\n";
}

// Holds of 15 s, seven time constants J/b, in both directions.
std::string FrictionConfig() {
  return Config(90, "[0.0, 1.5], [15.0, 2.0], [30.0, 3.0], [45.0, -1.5], [60.0, -2.0], [75.0, -3.0]", true,
                "0 rad");
}

std::string LeakageConfig(const std::string& held) {
  return Config(4.5, "[0.1, 2.5], [2.5, 0.0]", false, held);
}

// The experiment's result for the log of a simulated run of that machine.
ExperimentResult ResultOfLog(ExperimentResult (*experiment)(const ExperimentOptions&),
                             const std::string& config_text, const model::ModelDescription& model) {
  const settings::StackConfig config =
      settings::ParseStackConfig(config_text, "stack.toml", settings::FormatModel(model), "model.toml");
  ExperimentOptions options;
  options.measured_run = ::testing::TempDir() + "/paper_units_test.lcmlog";
  std::filesystem::remove(options.measured_run);
  log::LogWriter writer(options.measured_run, Opening::kTemporary);
  EXPECT_EQ(sim::Simulate(config,
                          [&](const bus::RawMessage& message) {
                            writer.Append(message.channel, message.data, static_cast<size_t>(message.size),
                                          message.receive_utime);
                          })
                .exit_code,
            0);
  writer.Finish();
  ExperimentResult result = experiment(options);
  std::filesystem::remove(options.measured_run);
  return result;
}

void ExpectSame(const json& numbers, const json& paper, const std::vector<std::string>& keys,
                double tolerance) {
  for (const std::string& key : keys) {
    const json::json_pointer at(key);
    const double wanted = paper.at(at);
    EXPECT_NEAR(numbers.at(at), wanted, tolerance * std::abs(wanted)) << key;
  }
}

// Tests that T_s and b are in in-lbf and in-lbf-s, and k_1 in in-lbf/V, whatever the units of the log's
// model, and that the texts say so.
TEST(PaperUnits, FrictionIsTheSameFromLogsInAll) {
  const model::ModelDescription table1 = ShippedModel("table1");
  const json paper = ParseJson(ResultOfLog(RunFriction, FrictionConfig(), table1).numbers);
  EXPECT_NEAR(paper.at("T_s"), 4.0, 0.04);  // 1 %, as friction_test.cc has it
  EXPECT_NEAR(paper.at("b"), 0.01455, 0.0001455);
  for (const UnitSystem& units : kSystems) {
    SCOPED_TRACE(units.length);
    const ExperimentResult result = ResultOfLog(RunFriction, FrictionConfig(), InUnits(table1, units));
    // The integrator's tolerance is 1e-8.
    ExpectSame(ParseJson(result.numbers), paper,
               {"/k_1", "/T_s", "/b", "/ci95/T_s/0", "/ci95/T_s/1", "/ci95/b/0", "/ci95/b/1",
                "/points/0/torque_in_lbf"},
               1e-5);
    EXPECT_EQ(ParseJson(result.numbers).at("units").at("T_s"), "in-lbf");
    EXPECT_THAT(result.conditions, HasSubstr("k_1 = 4 in-lbf/V"));
    EXPECT_EQ(result.comparisons.at(0).unit, "in-lbf");
    EXPECT_THAT(result.comparisons.at(0).remark, HasSubstr(" in-lbf, 95 %"));  // with --si, the row is in N m
    EXPECT_EQ(result.comparisons.at(0).here, ParseJson(result.numbers).at("T_s").get<double>());
  }
}

// Tests the same of the leakages and of the table's pressures, with the arm held away from mid-stroke. (A
// search that starts at 1e-7 m^3/(s Pa) begins with a machine that the equations cannot follow.)
TEST(PaperUnits, LeakageIsTheSameFromLogsInAll) {
  for (const bool linear : {false, true}) {
    model::ModelDescription table1 = ShippedModel("table1");
    table1.units.linear_arm = linear;
    const std::string config = LeakageConfig(linear ? "0.1 in" : "0.1 rad");
    const ExperimentResult first = ResultOfLog(RunLeakage, config, table1);
    const json paper = ParseJson(first.numbers);
    EXPECT_NEAR(paper.at("c_E"), 6.5e-6, 0.05 * 6.5e-6);  // as leakage_test.cc has it
    EXPECT_NEAR(paper.at("c_I"), 1.0e-6, 0.05 * 1.0e-6);
    EXPECT_THAT(first.conditions, HasSubstr(linear ? "clamped at 0.1 in;" : "clamped at 0.1 rad;"));
    for (const UnitSystem& system : {kSiUnits, UnitSystem{"mm", "N"}}) {
      SCOPED_TRACE(system.length);
      const ExperimentResult result =
          ResultOfLog(RunLeakage, config, InUnits(table1, WithArm(system, linear)));
      const json numbers = ParseJson(result.numbers);
      // Both searches end where the cost changes by less than 1e-10 of itself, some 1e-6: a thousandth of a
      // standard error.
      ExpectSame(numbers, paper,
                 {"/c_E", "/c_I", "/ci95/c_E/0", "/ci95/c_E/1", "/ci95/c_I/0", "/ci95/c_I/1", "/rms_residual",
                  "/best_told/value"},
                 1e-3);
      EXPECT_EQ(numbers.at("not_identifiable"), paper.at("not_identifiable"));
      EXPECT_TRUE(numbers.at("model_describes_run"));
      EXPECT_EQ(result.conditions, first.conditions);
      for (const char* column : {"p1_psi", "p2_psi", "fitted_p1_psi", "fitted_p2_psi"}) {
        const std::vector<double>& values = result.table.Find(column)->values;
        const std::vector<double>& wanted = first.table.Find(column)->values;
        ASSERT_EQ(values.size(), wanted.size());
        // Of some 1000 psi; the fitted ones follow the leakages.
        for (size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(values[i], wanted[i], 0.1) << column << i;
      }
    }
  }
}

// Table 1 in these units with a constant load on the pump, written as text with the number in them.
model::ModelDescription Loaded(const UnitSystem& units, const std::string& load) {
  return settings::ParseModel(settings::FormatModel(InUnits(ShippedModel("table1"), units)) +
                                  "[effects.\"pump.towed\".definition]\nsummary = \"towed\"\n"
                                  "equation = \"load += " +
                                  load + "\"\n",
                              "towed.toml");
}

// Tests that an effect written as text, whose numbers count in the model's units, acts as it does there.
TEST(PaperUnits, FormulasStayInTheModelsUnits) {
  runs::MeasuredRun run;
  run.shaft = model::Shaft::kClamped;
  for (int i = 0; i < 200; ++i) {
    run.time.push_back(0.002 * i);
    run.voltage.values.push_back(2.5);
  }
  const double at_p_3 = std::numeric_limits<double>::quiet_NaN();
  const SimulatedRun paper = SimulateClamped(Loaded({}, "1.0"), run, at_p_3);
  const SimulatedRun si = SimulateClamped(Loaded(kSiUnits, "0.1129848290276167"), run, at_p_3);
  const SimulatedRun none = SimulateClamped(ShippedModel("table1"), run, at_p_3);
  for (size_t i = 0; i < run.samples(); ++i) EXPECT_NEAR(si.p2[i], paper.p2[i], 0.01) << i;  // of 1000 psi
  EXPECT_GT(none.p2[100] - paper.p2[100], 10);  // 1 in-lbf of the torque is worth some 100 psi
}

// Tests what one of the paper's units is in a model's.
TEST(PaperUnits, OfQuantities) {
  EXPECT_EQ(PaperUnitIn({}, "in^3/(s psi)"), 1);
  EXPECT_EQ(PaperUnitIn(WithArm({}, true), "rad", 1), 1);
  EXPECT_NEAR(PaperUnitIn(kSiUnits, "psi"), 6894.757, 1e-3);
  EXPECT_EQ(PaperUnitIn(kSiUnits, "rad", 1), 1);
  EXPECT_NEAR(PaperUnitIn(WithArm(kSiUnits, true), "rad", 1), 0.0254, 1e-15);
  EXPECT_NEAR(PaperParameters(ShippedModel("table1_si")).T_s, 4, 1e-5);  // its values have six digits
}

}  // namespace
}  // namespace hydro::experiments
