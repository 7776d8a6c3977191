// What the owner of a new rig wants to see before any search: which signals are recorded, over which range,
// and whether signs and sizes agree with the model.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

struct ChecklistLine {
  enum class State {
    kGood,
    kLook,    // worth a look: it differs from the model, or the data do not suffice to tell
    kAbsent,  // not recorded
  };
  State state = State::kGood;
  std::string item;  // "sign of the command"
  std::string text;
};

// The lines of one run, in the order in which they are best settled: samples, then ranges, then signs. A sign
// is judged by how the evidence of the balances changes when the sign is turned.
std::vector<ChecklistLine> Checklist(const model::ModelDescription& model, const runs::MeasuredRun& run,
                                     bool si = false);

// Formats a line: "ok       samples              1301 in 1.3 s, ..."
std::string Written(const ChecklistLine& line);

}  // namespace hydro::diagnose
