// How far a diagnosis has come, for display.
#pragma once

#include <functional>
#include <string>

namespace hydro::diagnose {

struct Progress {
  std::string stage;    // "trying each effect"
  double fraction = 0;  // of all the work, 0 to 1; an estimate
};

// Two threads never call this at once.
using ProgressCallback = std::function<void(const Progress&)>;

}  // namespace hydro::diagnose
