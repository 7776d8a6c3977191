#include "base/random.h"

#include <cmath>
#include <numbers>

namespace hydro {
namespace {

// In (0, 1]: never 0, because Box-Muller takes its logarithm.
double Uniform(uint64_t x) { return (static_cast<double>(x >> 11) + 1.0) * 0x1p-53; }

}  // namespace

double StandardNormal(uint64_t key) {
  const uint64_t first = Scatter(key);
  return std::sqrt(-2 * std::log(Uniform(first))) * std::cos(2 * std::numbers::pi * Uniform(Scatter(~first)));
}

}  // namespace hydro
