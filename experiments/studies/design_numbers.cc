#include "experiments/studies/design_numbers.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

namespace hydro::experiments {

std::vector<std::pair<double, double>> AsPairs(const std::vector<Complex>& poles) {
  std::vector<std::pair<double, double>> pairs;
  pairs.reserve(poles.size());
  for (const Complex& pole : poles) pairs.push_back({pole.real(), pole.imag()});
  return pairs;
}

Complex SlowestPole(const std::vector<Complex>& poles) {
  const Complex pole = *std::max_element(
      poles.begin(), poles.end(), [](const Complex& a, const Complex& b) { return a.real() < b.real(); });
  return {pole.real(), std::fabs(pole.imag())};
}

std::string PoleText(const Complex& pole) {
  if (pole.imag() == 0) return fmt::format("{:.2f}", pole.real());
  return fmt::format("{:.1f} ± {:.1f}j", pole.real(), std::fabs(pole.imag()));
}

std::string SettlingText(const runs::StepResponse& response) {
  return response.settling_time_s ? fmt::format("{:.3f} s", *response.settling_time_s) : "never";
}

}  // namespace hydro::experiments
