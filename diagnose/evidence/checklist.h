// What somebody who brings a rig of his own wants to see before any search: what is recorded, in which range, and whether signs
// and sizes are those of the model.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

struct ChecklistLine {
  enum class State {
    kGood,
    kLook,    // worth a look: not as the model has it, or not enough to tell
    kAbsent,  // not recorded
  };
  State state = State::kGood;
  std::string item;  // "sign of the command"
  std::string text;
};

// The lines of one run, in the order in which they are best settled: samples, ranges, then signs. A sign is judged by what turning it
// does to the evidence of the balances.
std::vector<ChecklistLine> Checklist(const model::ModelDescription& model, const runs::MeasuredRun& run,
                                     bool si = false);

// "ok       samples              1301 in 1.3 s, ..."
std::string Written(const ChecklistLine& line);

}  // namespace hydro::diagnose
