#include "experiments/studies/design_numbers.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace hydro::experiments {

std::vector<std::pair<double, double>> AsPairs(const std::vector<design::Complex>& poles) {
  std::vector<std::pair<double, double>> pairs;
  pairs.reserve(poles.size());
  for (const design::Complex& pole : poles) pairs.push_back({pole.real(), pole.imag()});
  return pairs;
}

design::Complex SlowestPole(const std::vector<design::Complex>& poles) {
  const design::Complex pole = *std::max_element(
      poles.begin(), poles.end(),
      [](const design::Complex& a, const design::Complex& b) { return a.real() < b.real(); });
  return {pole.real(), std::fabs(pole.imag())};
}

std::string PoleText(const design::Complex& pole) {
  if (pole.imag() == 0) return fmt::format("{:.2f}", pole.real());
  return fmt::format("{:.1f} ± {:.1f}j", pole.real(), std::fabs(pole.imag()));
}

std::string SettlingText(const runs::StepResponse& response) {
  return response.settling_time_s ? fmt::format("{:.3f} s", *response.settling_time_s) : "never";
}

}  // namespace hydro::experiments
