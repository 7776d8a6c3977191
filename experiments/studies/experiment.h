// What an experiment is and what it yields: numbers, a table, pictures, and how they compare with the paper.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "experiments/runs/stack_run.h"
#include "page/plot.h"
#include "tables/table.h"

namespace hydro::experiments {

// One line of "what the paper says, what we get".
struct Comparison {
  std::string quantity;  // "peak of p_2"
  std::string unit;      // "psi"; "" for pure numbers
  std::string paper;     // what the paper prints or its figure shows; "" where it is silent
  // The same quantity by an independent computation from the paper's equations (closed form, Routh, ...);
  // NaN: none.
  double expected = std::numeric_limits<double>::quiet_NaN();
  double here = std::numeric_limits<double>::quiet_NaN();  // what this run gave; NaN: it does not exist
  std::string remark;                                      // why they differ, what it depends on
};

// Where the paper contradicts itself or leaves something open. Never silently patched: what the project does
// is said.
struct Finding {
  int number = 0;         // as in docs/experiments.md
  std::string paper;      // what the paper says
  std::string evidence;   // what was computed here, with figures
  std::string treatment;  // what the project does
};

struct Picture {
  std::string suffix;  // "" is the experiment's own, NAME.svg; "-noise" gives NAME-noise.svg
  page::Figure figure;
};

struct ExperimentResult {
  std::string conditions;               // model, mode, rates, references: one or two sentences
  std::string paper_says;               // what the paper reports, in a sentence or two
  std::string explanation;              // why the two differ, or that they agree
  std::vector<Comparison> comparisons;  // in the order of the report
  std::vector<Finding> findings;        // those that this experiment gives evidence for
  std::string numbers = "{}";           // a JSON object: the keys of docs/experiments.md and more
  tables::Table table;                  // NAME.csv; columns may be padded with NaN
  std::vector<Picture> pictures;        // the first is NAME.svg
};

struct ExperimentOptions {
  StackRunner run_stack = RunStackInProcess;  // how experiments over the stack run it
  int64_t seed = 1;                           // of every noise
  bool noise = false;        // sensors as noisy as the paper's plots, for the figures that show them
  std::string measured_run;  // friction, leakage: analyse this file instead of a simulated rig; "": simulate
  // Told now and then how much is done, 0 to 1. May be called from any one thread at a time.
  std::function<void(double)> progress = [](double) {};
};

struct Experiment {
  std::string name;   // "fig3"; names the files
  std::string title;  // "Figure 3: open-loop response to a torque of 10 in-lb"
  ExperimentResult (*run)(const ExperimentOptions&);
  double cost = 1;  // seconds it takes, roughly: for the progress bar and the order of starting
  bool takes_measured_run = false;
};

// All, in the order of the paper (and of the report).
const std::vector<Experiment>& Experiments();

}  // namespace hydro::experiments
