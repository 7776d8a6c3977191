// What an experiment is and what it yields: numbers, a table, pictures, and how they compare with the paper.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "base/maths/spread.h"
#include "base/tables/table.h"
#include "experiments/runs/stack_run.h"
#include "page/plot.h"

namespace hydro::experiments {

// One row of the comparison between the paper's value and ours.
struct Comparison {
  std::string quantity;  // "peak of p_2"
  std::string unit;      // "psi"; "" for pure numbers
  std::string paper;     // what the paper prints or its figure shows; "" if it is silent
  // The same quantity computed independently from the paper's equations (closed form, Routh, ...); NaN: none.
  double expected = std::numeric_limits<double>::quiet_NaN();
  double here = std::numeric_limits<double>::quiet_NaN();  // result of this run; NaN: does not exist
  std::string remark;                                      // why they differ, or what the value depends on
};

// Where the paper contradicts itself or leaves something open. The project never patches this silently:
// `treatment` states what it does.
struct Finding {
  int number = 0;         // as in docs/experiments.md
  std::string paper;      // what the paper says
  std::string evidence;   // what was computed here, with numbers
  std::string treatment;  // what the project does
};

struct Picture {
  std::string suffix;  // "" gives the experiment's own NAME.svg; "-noise" gives NAME-noise.svg
  page::Figure figure;
};

struct ExperimentResult {
  std::string conditions;               // model, mode, rates, references, in one or two sentences
  std::string paper_says;               // what the paper reports, in a sentence or two
  std::string explanation;              // why the two differ, or that they agree
  std::vector<Comparison> comparisons;  // in the report's order
  std::vector<Finding> findings;        // for which this experiment gives evidence
  std::string numbers = "{}";           // a JSON object: the keys of docs/experiments.md, and more
  tables::Table table;                  // NAME.csv; columns may be padded with NaN
  std::vector<Picture> pictures;        // the first is NAME.svg
};

struct ExperimentOptions {
  StackRunner run_stack = RunStackInProcess;  // how experiments run the stack
  int64_t seed = 1;                           // for all noise and all random draws
  int machines = 10000;                       // fig10_uncertainty: drawn from Table 1 and its uncertainty
  int jobs = 1;                               // threads of an experiment that can use several
  bool noise = false;                         // sensor noise like the paper's, for figures that show it
  std::string measured_run;                   // friction, leakage: file to analyse; "": simulate a rig
  // Called now and then with the fraction done, 0 to 1. Calls may come from any thread, but never from two at
  // a time.
  std::function<void(double)> progress = [](double) {};
};

struct Experiment {
  std::string name;   // "fig3"; names the files
  std::string title;  // "Figure 3: open-loop response to a torque of 10 in-lb"
  ExperimentResult (*run)(const ExperimentOptions&);
  double cost = 1;  // rough duration in seconds, for the progress bar and the starting order
  bool takes_measured_run = false;
  bool draws_machines = false;
  bool takes_noise = false;
  bool runs_stack = false;
};

// All experiments, in the order of the paper and of the report.
const std::vector<Experiment>& Experiments();

// JSON to text and back: nlohmann's writer and parser, compiled once, because they cost seconds in each file
// that uses them.

// Indented by 2; values that are not finite become null.
std::string JsonText(const nlohmann::json& value);

// Throws nlohmann::json::parse_error.
nlohmann::json ParseJson(const std::string& text);

// [low, high].
nlohmann::json IntervalJson(const maths::Estimate& estimate);

}  // namespace hydro::experiments
