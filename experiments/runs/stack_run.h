// One run of the control stack for an experiment, as a table of signals: how it is run is exchangeable.
#pragma once

#include <functional>
#include <string>

#include "tables/table.h"

namespace hydro::experiments {

struct StackSetup {
  std::string name;    // for messages and files: "fig4-feedforward"
  std::string config;  // a whole configuration (TOML); model.file is only a name there, `model` replaces it
  std::string model;   // a model file's text (TOML)
};

// Runs a stack to the end of its time.duration_s and gives its signals, one row a plant tick, with the
// columns of hydro-log export (runs/run_table.h). Throws InputError for a faulty configuration,
// std::runtime_error naming the setup when the run failed (a fault tripped).
using StackRunner = std::function<tables::Table(const StackSetup&)>;

// Plant, pressure loop and position loop in this process, in lockstep on simulated time: bit-identical each
// time.
tables::Table RunStackInProcess(const StackSetup& setup);

// Separate processes in real time, started by hydro-launch (from `program_folder`); configurations and logs
// stay in `folder` under the setup's name. The setup's time.mode is overridden, and so is a command delay of
// 0.
StackRunner SeparateProcesses(const std::string& program_folder, const std::string& folder);

}  // namespace hydro::experiments
