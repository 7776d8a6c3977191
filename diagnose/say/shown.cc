#include "diagnose/say/shown.h"

#include <cmath>
#include <numbers>

#include "base/number_text.h"
#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {
namespace {

constexpr double kMostFactor = 10;  // between a value and either end of its interval

bool MayBeZero(const model::ParameterInfo& info) {
  return info.min < 0 || (info.min == 0 && info.min_allowed);
}

}  // namespace

void JudgeInterval(const model::ParameterInfo& info, Estimated* estimated) {
  const double low = estimated->low, high = estimated->high;
  if (!std::isfinite(low) && !std::isfinite(high)) return;
  const bool fills_range = std::isfinite(info.max - info.min) && high - low >= info.max - info.min;
  if (info.role == model::Role::kPhase) {
    estimated->shown = high - low < 2 * std::numbers::pi;  // a whole turn is any phase
    return;
  }
  const double size = std::abs(estimated->value);
  const bool far = high > kMostFactor * size || low < -kMostFactor * size;
  const bool near = info.min >= 0 && low < size / kMostFactor;
  estimated->shown = low == high || !(far || near || fills_range);
}

std::string WhyRemarkable(const model::ParameterInfo& info, const ChangedParameter& changed) {
  const double ratio = changed.fitted.value / changed.model;
  if (changed.model == 0 || (ratio >= 1 / kImplausible && ratio <= kImplausible)) return "";
  const double low = changed.fitted.low, high = changed.fitted.high;
  if (MayBeZero(info) && low < high && low <= 0 && high >= 0) return "";
  return "moves by a factor of " + ShortNumber(ratio, 3);
}

}  // namespace hydro::diagnose
