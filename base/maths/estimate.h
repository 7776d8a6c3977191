// A value with its 95 % confidence interval.
#pragma once

#include <string>

namespace hydro::maths {

struct Estimate {
  double value = 0;
  double low = 0;
  double high = 0;

  double half_width() const { return (high - low) / 2; }
};

// "4.000017 +/- 0.000075", with as many decimals as the interval justifies.
std::string PlusMinus(const Estimate& estimate);

}  // namespace hydro::maths
