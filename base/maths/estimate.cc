#include "base/maths/estimate.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace hydro::maths {

std::string PlusMinus(const Estimate& estimate) {
  const double half = estimate.half_width();
  if (!std::isfinite(half)) return "not told";
  if (!(half > 0)) return fmt::format("{:.5g} +/- {:.2g}", estimate.value, half);
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(half)));
  // Small values are written in powers of ten: 6.502e-06 +/- 0.011e-06 is easier to read than ten decimals.
  const int exponent =
      estimate.value == 0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(estimate.value))));
  if (exponent >= -3) {
    return fmt::format("{:.{}f} +/- {:.{}f}", estimate.value, std::max(0, decimals), half,
                       std::max(0, decimals));
  }
  const double scale = std::pow(10.0, -exponent);
  const int digits = std::max(0, decimals + exponent);
  return fmt::format("({:.{}f} +/- {:.{}f})e{}", estimate.value * scale, digits, half * scale, digits,
                     exponent);
}

}  // namespace hydro::maths
