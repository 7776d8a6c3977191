// A case as files: what the gap finder gets, and the answers, which it does not.
#pragma once

#include <string>

#include "cases.h"

namespace foreign_rig {

// FOLDER/run1.csv, run1.toml, ..., held1.csv, ... and model.toml: no word about what is in them.
void WriteRuns(const Case& c, const Solved& solved, const Options& options, const std::string& folder);

// The answers, JSON.
void WriteKey(const Case& c, const Solved& solved, const std::string& file);

}  // namespace foreign_rig
