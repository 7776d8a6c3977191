// Where a diagnosis stands; told to whoever shows it.
#pragma once

#include <functional>
#include <string>

namespace hydro::diagnose {

struct Progress {
  std::string stage;    // "trying each effect"
  double fraction = 0;  // of all the work, 0 to 1, as far as is known
};

// Called from one thread at a time.
using TellProgress = std::function<void(const Progress&)>;

}  // namespace hydro::diagnose
