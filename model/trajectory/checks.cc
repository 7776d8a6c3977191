#include "model/trajectory/checks.h"

#include <cmath>
#include <stdexcept>

#include "base/number_text.h"

namespace hydro::trajectory {

void RequireFinite(const std::string& what, double value) {
  if (!std::isfinite(value)) {
    throw std::invalid_argument(what + ": found " + ShortestNumber(value) + ", allowed: a finite number");
  }
}

void RequirePositive(const std::string& what, double value) {
  if (!std::isfinite(value) || value <= 0) {
    throw std::invalid_argument(what + ": found " + ShortestNumber(value) +
                                ", allowed: a finite number above 0");
  }
}

void RequireIncreasing(const std::string& what, const std::vector<Step>& items) {
  for (size_t i = 0; i < items.size(); ++i) {
    const std::string item = what + " " + std::to_string(i + 1);
    RequireFinite(item + " time", items[i].time);
    RequireFinite(item + " value", items[i].value);
    if (i > 0 && items[i].time <= items[i - 1].time) {
      throw std::invalid_argument(item + " time: found " + ShortestNumber(items[i].time) +
                                  ", allowed: above " + ShortestNumber(items[i - 1].time) +
                                  ", the time before it");
    }
  }
}

}  // namespace hydro::trajectory
