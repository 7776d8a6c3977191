// One run of the control stack for an experiment, as a table of signals. The way in which it runs is
// exchangeable.
#pragma once

#include <functional>
#include <string>

#include "base/tables/table.h"

namespace hydro::experiments {

struct StackSetup {
  std::string name;    // for messages and files: "fig4-feedforward"
  std::string config;  // a whole configuration (TOML); `model` replaces the file named by model.file
  std::string model;   // text of a model file (TOML)
};

// Runs a stack to the end of its time.duration_s and returns its signals, one row per plant tick, with the
// columns of hydro-log export (runs/recorded/run_table.h). Throws InputError for a faulty configuration, and
// std::runtime_error naming the setup when the run failed (a fault tripped).
using StackRunner = std::function<tables::Table(const StackSetup&)>;

// Runs plant, pressure loop and position loop in this process, in lockstep on simulated time: bit-identical
// every time.
tables::Table RunStackInProcess(const StackSetup& setup);

// Runs separate processes in real time, started by hydro-launch (from `program_folder`). Configurations and
// logs stay in `folder` under the setup's name. It overrides the setup's time.mode, and a command delay of 0.
StackRunner SeparateProcesses(const std::string& program_folder, const std::string& folder);

}  // namespace hydro::experiments
