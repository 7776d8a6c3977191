#include "scope/signals/noise_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace hydro::scope {
namespace {

constexpr size_t kWindow = 2048;
constexpr size_t kUpdateAfter = 512;
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

// A second difference of independent samples has sqrt(1 + 4 + 1) times their deviation; the median of a
// normal distribution's absolute values is 0.67449 times its deviation.
constexpr double kOfNormal = 0.6744897501960817 * 2.449489742783178;

}  // namespace

NoiseEstimate::NoiseEstimate() : before_(kNotKnown), last_(kNotKnown), sigma_(kNotKnown) {}

void NoiseEstimate::Add(double value) {
  const double difference = std::abs(before_ - 2 * last_ + value);
  before_ = last_;
  last_ = value;
  if (std::isnan(difference)) return;
  if (differences_.size() < kWindow) {
    differences_.push_back(difference);
  } else {
    differences_[next_] = difference;
    next_ = (next_ + 1) % kWindow;
  }
  const bool first = std::isnan(sigma_) && differences_.size() == kFirst;
  if (++fresh_ >= kUpdateAfter || first) Update();
}

void NoiseEstimate::Update() {
  fresh_ = 0;
  if (differences_.size() < kFirst) return;
  std::vector<double> sorted = differences_;
  const auto middle = sorted.begin() + static_cast<ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  sigma_ = *middle > 0 ? *middle / kOfNormal : kNotKnown;
}

}  // namespace hydro::scope
