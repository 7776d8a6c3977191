#include "experiments/runs/stack_run.h"

#include <gtest/gtest.h>

#include "base/input_error.h"
#include "experiments/runs/shipped_models.h"
#include "model/actuator.h"
#include "runs/recorded/run_table.h"

namespace hydro::experiments {
namespace {

constexpr char kOpenLoop[] = R"(
[model]
file = "table1.toml"
shaft = "clamped"
[time]
mode = "lockstep"
duration_s = 0.3
[plant]
rate_hz = 5000
[pressure]
natural_frequency_rad_s = 150.0
damping_ratio = 0.5
[position]
sample_interval_s = 0.005
[reference]
signal = "voltage"
kind = "steps"
initial = 2.5
)";

// Tests that a run of the stack gives the table of hydro-log export, one row a tick, with the plant's own
// pressures.
TEST(StackRun, GivesTheRunsTable) {
  const tables::Table table = RunStackInProcess({"open-loop", kOpenLoop, ShippedModelText("table1")});
  ASSERT_EQ(table.rows(), 1501u);
  ASSERT_EQ(table.columns.size(), runs::kRunColumns.size());
  model::Actuator actuator(ShippedModel("table1"), {.shaft = model::Shaft::kClamped});
  const tables::Column* p2 = table.Find("p2_psi");
  const tables::Column* voltage = table.Find("voltage_V");
  ASSERT_NE(p2, nullptr);
  ASSERT_NE(voltage, nullptr);
  for (size_t i = 0; i + 1 < table.rows(); ++i) {
    ASSERT_EQ(p2->values[i], actuator.Measure().p2) << "row " << i;
    actuator.Advance(voltage->values[i], static_cast<double>(i + 1) / 5000);
  }
  EXPECT_GT(p2->values.back(), 1000);
}

// Tests that an impossible run is refused with the setup's name.
TEST(StackRun, FaultyConfigurationIsRefused) {
  try {
    RunStackInProcess(
        {"my-setup", "[model]\nfile = \"x.toml\"\nshaft = \"bent\"\n", ShippedModelText("table1")});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("my-setup"), std::string::npos) << error.what();
  }
}

// Tests that a run that trips a fault is an error, not a table.
TEST(StackRun, TrippedFaultIsAnError) {
  std::string config = kOpenLoop;
  config += "[limits]\npressure_psi = 500.0\n";
  try {
    RunStackInProcess({"my-setup", config, ShippedModelText("table1")});
    FAIL();
  } catch (const InputError&) {
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("my-setup"), std::string::npos) << error.what();
  }
}

// Tests that the compiled-in models are those of config/models, by name.
TEST(ShippedModels, ByName) {
  EXPECT_EQ(ShippedModel("table1").name, "Table 1");
  EXPECT_EQ(ShippedModel("table1").parameters.k_2, 3.68);
  EXPECT_GT(ShippedModel("wide_actuator").parameters.V_ms, 5.787);
  EXPECT_THROW(ShippedModelText("nothing"), std::out_of_range);
}

}  // namespace
}  // namespace hydro::experiments
