// Finds the parts of a table that are runs, and how the shaft and the bypass were in each: [use], [skip], and
// what changes within a recording.
#pragma once

#include <string>
#include <vector>

#include "runs/measured/measured_run.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {

// A part with fewer samples is not a run.
inline constexpr size_t kFewestOfAPart = 100;

// What a sidecar states over time. Each entry holds from its time to that of the next one.
struct RunPlan {
  struct ShaftFrom {
    double from = 0;  // s; -infinity: not stated, from the beginning
    model::Shaft shaft = model::Shaft::kFree;
    double arm_angle = 0;
  };
  struct BypassFrom {
    double from = 0;
    bool open = false;
  };
  struct Window {
    double from = 0, to = 0;
  };
  std::vector<ShaftFrom> shafts;     // in the order of their times; the first holds from the beginning
  std::vector<BypassFrom> bypasses;  // the same; empty: the table has a column for it
  std::vector<Window> use, skip;     // an empty `use`: the whole table
};

// Reads shaft, arm_angle, bypass, use and skip. The angle is in the unit of the arm. Throws InputError.
RunPlan ReadPlan(settings::SectionReader& document, const UnitSystem& units);

// Finds the arm's angles in a list of shafts, which are texts with a unit or numbers.
std::vector<settings::TomlNode*> AnglesIn(settings::TomlNode* sidecar);

// Returns the run, or its parts, each with a name of its own. Throws InputError for a window that holds too
// little, for one or an entry that is outside the run, for a first entry that leaves unsaid what holds before
// it, and for a driven shaft without the arm's angle.
std::vector<MeasuredRun> PartsOf(const MeasuredRun& whole, const RunPlan& plan,
                                 const settings::SectionReader& document);

}  // namespace hydro::runs
