// How far a diagnosis has come, for whoever displays it.
#pragma once

#include <functional>
#include <string>

namespace hydro::diagnose {

struct Progress {
  std::string stage;    // "trying each effect"
  double fraction = 0;  // of all the work, 0 to 1, as far as is known
};

// Never called from two threads at once.
using ProgressCallback = std::function<void(const Progress&)>;

}  // namespace hydro::diagnose
