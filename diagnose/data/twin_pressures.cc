#include "diagnose/data/twin_pressures.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "base/word_list.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {
namespace {

constexpr double kWithinNoise = 3;
constexpr double kTurns = 20;  // noise units by which the speed of a motor that turns differs from zero

// Root mean square of a - b; b may be empty.
double RmsOf(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double value = a[i] - (b.empty() ? 0 : b[i]);
    if (std::isnan(value)) continue;
    sum += value * value;
    ++count;
  }
  return count == 0 ? 0 : std::sqrt(sum / static_cast<double>(count));
}

double NoiseOf(const std::vector<double>& values) {
  return std::max(EstimateNoise(values), EstimateResolution(values));
}

}  // namespace

std::string TwinPressures(const runs::MeasuredRun& run) {
  if (run.bypass || !run.p1.measured() || !run.p2.measured()) return "";
  const std::vector<double>&p1 = run.p1.values, &p2 = run.p2.values;
  const std::string sidecar = std::filesystem::path(run.sidecar).filename().string();
  const std::string where = sidecar.empty() ? "the sidecar" : sidecar;
  const double noise = std::max(NoiseOf(p1), NoiseOf(p2));
  if (p1 == p2 && noise > 0) {
    return RunNamed(run.name) + ": p1 and p2 are the same numbers: does " + where +
           " name one column for both?";
  }
  // An arm that moves freely may need no pressure difference.
  if (run.shaft != model::Shaft::kClamped || !run.motor_speed.measured()) return "";
  const std::vector<double>& speed = run.motor_speed.values;
  const bool turns = RmsOf(speed, {}) > kTurns * NoiseOf(speed);
  if (!turns || RmsOf(p1, p2) > kWithinNoise * noise) return "";
  return RunNamed(run.name) +
         ": p1 and p2 are the same within their noise while the motor turns: is the bypass open? This in " +
         where + " mends it: bypass = true";
}

}  // namespace hydro::diagnose
