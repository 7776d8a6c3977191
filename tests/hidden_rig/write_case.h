// A case as files: what the gap finder gets, and the answers, which it does not.
#pragma once

#include <string>

#include "cases.h"

namespace hidden_rig {

// DIR/run1.csv, run1.toml, ... and DIR/model.toml: no word about what is in them.
void WriteRuns(const Case& c, const Truth& truth, const Options& options, const std::string& folder);

// The answers, JSON.
void WriteKey(const Case& c, const Truth& truth, const std::string& file);

}  // namespace hidden_rig
