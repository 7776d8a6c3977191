#include "base/maths/spread.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numeric>

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

namespace {

// The indices of `x`, ordered by value; equal values keep their order.
std::vector<size_t> OrderOf(const std::vector<double>& x) {
  std::vector<size_t> order(x.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return x[a] < x[b]; });
  return order;
}

// Ranks from 0, less their mean.
std::vector<double> CentredRanks(const std::vector<double>& x) {
  const std::vector<size_t> order = OrderOf(x);
  std::vector<double> ranks(x.size());
  for (size_t begin = 0; begin < order.size();) {
    size_t end = begin + 1;
    while (end < order.size() && x[order[end]] == x[order[begin]]) ++end;
    const double rank = (static_cast<double>(begin + end) - static_cast<double>(order.size())) / 2;
    for (; begin < end; ++begin) ranks[order[begin]] = rank;
  }
  return ranks;
}

double MeanOf(const std::vector<double>& y) {
  return std::accumulate(y.begin(), y.end(), 0.0) / std::max(1.0, static_cast<double>(y.size()));
}

double SquaresAbout(const std::vector<double>& y, double mean) {
  return std::accumulate(y.begin(), y.end(), 0.0,
                         [=](double sum, double value) { return sum + (value - mean) * (value - mean); });
}

}  // namespace

double Quantile(const std::vector<double>& sorted, double share) {
  const double place = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<size_t>(place);
  const double part = place - static_cast<double>(below);
  if (part == 0) return sorted[below];
  return sorted[below] == sorted[below + 1] ? sorted[below]
                                            : (1 - part) * sorted[below] + part * sorted[below + 1];
}

Estimate Share(int hits, int count) {
  constexpr double kNormal95 = 1.959963984540054;
  const double n = count;
  const double share = hits / n;
  const double weight = 1 + kNormal95 * kNormal95 / n;
  const double centre = (share + kNormal95 * kNormal95 / (2 * n)) / weight;
  const double half =
      kNormal95 / weight * std::sqrt(share * (1 - share) / n + kNormal95 * kNormal95 / (4 * n * n));
  return {share, std::max(0.0, centre - half), std::min(1.0, centre + half)};
}

double Correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const double of_x = MeanOf(x), of_y = MeanOf(y);
  const double size = std::sqrt(SquaresAbout(x, of_x) * SquaresAbout(y, of_y));
  const auto product = [=](double a, double b) { return (a - of_x) * (b - of_y); };
  return size == 0 ? 0
                   : std::inner_product(x.begin(), x.end(), y.begin(), 0.0, std::plus<>(), product) / size;
}

double RankCorrelation(const std::vector<double>& x, const std::vector<double>& y) {
  return Correlation(CentredRanks(x), CentredRanks(y));
}

double MainEffect(const std::vector<double>& x, const std::vector<double>& y, int bins) {
  const auto count = static_cast<double>(y.size());
  const double total = SquaresAbout(y, MeanOf(y));
  if (total == 0) return 0;
  const std::vector<size_t> order = OrderOf(x);
  double within = 0;
  for (size_t bin = 0; bin < static_cast<size_t>(bins); ++bin) {
    const size_t begin = bin * order.size() / static_cast<size_t>(bins);
    const size_t end = (bin + 1) * order.size() / static_cast<size_t>(bins);
    std::vector<double> part;
    for (size_t i = begin; i < end; ++i) part.push_back(y[order[i]]);
    within += SquaresAbout(part, MeanOf(part));
  }
  return 1 - within / total * (count - 1) / (count - bins);
}

}  // namespace hydro::maths
