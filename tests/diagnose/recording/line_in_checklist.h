// What the checklist says of one item of a recording of Table 1's rig.
#pragma once

#include <string>

#include "diagnose/evidence/checklist.h"
#include "tests/diagnose/recording/swing.h"

namespace hydro::testing {

inline std::string LineInChecklist(const runs::MeasuredRun& run, const std::string& item, bool si = false) {
  for (const diagnose::ChecklistLine& line : diagnose::Checklist(Table1Model(), run, si)) {
    if (line.item == item) return Written(line);
  }
  return "no line";
}

}  // namespace hydro::testing
