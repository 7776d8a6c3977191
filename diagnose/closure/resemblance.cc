#include "diagnose/closure/resemblance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "maths/linear_fit.h"

namespace hydro::diagnose {
namespace {

// A value is not taken to be known better than to this part of the curve's range.
constexpr double kCoarse = 0.05;
// Few samples reach as far as the first and the last knot: their values are so many times less sure.
constexpr double kAtEnds = 3;
// What each number of a law has to gain, in squared standard deviations.
constexpr double kPerNumber = 4;
// A law has to explain this part of the curve's variation.
constexpr double kLikeIt = 0.9;

using Function = std::function<double(double)>;

struct Law {
  std::string says;
  std::vector<Function> parts;  // each with a coefficient
  int numbers = 0;              // besides the coefficients
  bool odd = false;             // its sign is that of the variable
};

double SignOf(double x) { return static_cast<double>((x > 0) - (x < 0)); }

// The curve's points, with what counts as a standard deviation.
struct Points {
  std::vector<double> x, value, error;
  double mean = 0, variation = 0;  // sum of squares about the mean, in these deviations

  explicit Points(const Closure& closure) : x(closure.knots[0]), value(closure.value) {
    const auto [low, high] = std::minmax_element(value.begin(), value.end());
    const double coarse = kCoarse * std::max(*high - *low, 1e-3 * std::max(std::abs(*high), std::abs(*low)));
    double weights = 0;
    for (size_t i = 0; i < value.size(); ++i) {
      error.push_back(std::max(std::hypot((closure.high[i] - closure.low[i]) / 3.92, coarse), 1e-300));
      if (i == 0 || i + 1 == value.size()) error.back() *= kAtEnds;
      mean += value[i] / (error[i] * error[i]);
      weights += 1 / (error[i] * error[i]);
    }
    mean /= weights;
    for (size_t i = 0; i < value.size(); ++i) variation += std::pow((value[i] - mean) / error[i], 2);
  }
};

struct LawFit {
  double left = std::numeric_limits<double>::infinity();  // sum of squares
  double first = 0;                                       // coefficient of its first part
};

LawFit FitLaw(const Law& law, const Points& points) {
  std::vector<std::vector<double>> columns;
  for (const Function& part : law.parts) {
    std::vector<double>& column = columns.emplace_back();
    for (size_t i = 0; i < points.x.size(); ++i) column.push_back(part(points.x[i]) / points.error[i]);
  }
  std::vector<double> scaled;
  for (size_t i = 0; i < points.x.size(); ++i) scaled.push_back(points.value[i] / points.error[i]);
  LawFit fit;
  try {
    const maths::LinearFit linear = maths::FitLinear(columns, scaled);
    fit.left = 0;
    for (size_t i = 0; i < scaled.size(); ++i) {
      double predicted = 0;
      for (size_t k = 0; k < columns.size(); ++k) predicted += linear.coefficients[k] * columns[k][i];
      fit.left += std::pow(scaled[i] - predicted, 2);
    }
    fit.first = linear.coefficients[0];
  } catch (const std::invalid_argument&) {
    // The law is another one on these points.
  }
  return fit;
}

// Laws of a variable, by themselves.
std::vector<Law> PlainLaws(const std::string& name, const std::string& unit, const std::vector<double>& x) {
  const bool both = x.front() < 0 && x.back() > 0;
  const std::string size = both ? "|" + name + "|" : name;
  std::vector<Law> laws;
  laws.push_back({"grows as the square root of " + size,
                  {[](double v) { return SignOf(v) * std::sqrt(std::abs(v)); }},
                  0,
                  both});
  laws.push_back({"grows as the square of " + size, {[](double v) { return v * std::abs(v); }}, 0, both});
  laws.push_back({"grows as the cube of " + size, {[](double v) { return v * v * v; }}, 0, both});
  const double reach = std::max(std::abs(x.front()), std::abs(x.back()));
  if (both) {
    laws.push_back(
        {"has a part that grows as the square of " + name, {[](double v) { return v * v; }}, 0, false});
    const bool speed = name.ends_with("speed");
    laws.push_back({"changes sign with " + name + (speed ? " (Coulomb friction)" : ""), {SignOf}, 0, true});
    for (const double part : {0.03, 0.1, 0.3}) {
      const double fall = part * reach;
      laws.push_back({"changes sign with " + name + " and falls with " + size + (speed ? " (Stribeck)" : ""),
                      {SignOf, [fall](double v) { return SignOf(v) * std::exp(-std::abs(v) / fall); }},
                      1,
                      true});
      laws.push_back({"grows with " + size + " up to a limit",
                      {[fall](double v) { return SignOf(v) * (1 - std::exp(-std::abs(v) / fall)); }},
                      1,
                      true});
    }
  }
  for (size_t i = 1; i + 1 < x.size(); ++i) {
    const double from = x[i];
    const std::string at = name + " = " + ShortNumber(from, 2) + " " + unit;
    laws.push_back({"begins above " + at, {[from](double v) { return std::max(0.0, v - from); }}, 1, false});
    laws.push_back({"begins below " + at, {[from](double v) { return std::max(0.0, from - v); }}, 1, false});
    if (!both || !(from > 0)) continue;
    laws.push_back({"begins beyond |" + name + "| = " + ShortNumber(from, 2) + " " + unit,
                    {[from](double v) { return SignOf(v) * std::max(0.0, std::abs(v) - from); }},
                    1,
                    true});
    laws.push_back(
        {"begins beyond |" + name + "| = " + ShortNumber(from, 2) + " " + unit + " and grows as the square",
         {[from](double v) { return SignOf(v) * std::pow(std::max(0.0, std::abs(v) - from), 2); }},
         1,
         true});
  }
  return laws;
}

std::vector<Law> LawsOf(const Closure& closure) {
  const std::string& name = closure.against[0];
  const Function one = [](double) { return 1.0; };
  const Function itself = [](double v) { return v; };
  const bool both = closure.knots[0].front() < 0 && closure.knots[0].back() > 0;
  std::vector<Law> laws = {{"is constant", {one}, 0, false},
                           {"is proportional to " + name, {itself}, 0, both},
                           {"is a straight line of " + name, {itself, one}, 0, both}};
  for (const Law& plain : PlainLaws(name, closure.against_units[0], closure.knots[0])) {
    laws.push_back(plain);
    Law more = plain;
    more.parts.push_back(one);
    more.says += ", beside a constant";
    laws.push_back(more);
    more.parts.push_back(itself);
    more.says = plain.says + ", beside a straight line";
    laws.push_back(more);
  }
  return laws;
}

// The part of a surface's sum of squares that is a function of one variable times the other.
double ProductShare(const Closure& closure, size_t factor) {
  const size_t columns = closure.knots[1].size();
  double all = 0, explained = 0;
  for (const double value : closure.value) all += value * value;
  for (size_t k = 0; k < closure.knots[1 - factor].size(); ++k) {
    double cross = 0, squares = 0;
    for (size_t i = 0; i < closure.knots[factor].size(); ++i) {
      const double by = closure.knots[factor][i];
      cross += by * closure.value[factor == 0 ? i * columns + k : k * columns + i];
      squares += by * by;
    }
    if (squares > 0) explained += cross * cross / squares;
  }
  return all > 0 ? explained / all : 0;
}

std::string SurfaceResemblance(const Closure& closure) {
  const size_t factor = ProductShare(closure, 1) >= ProductShare(closure, 0) ? 1 : 0;
  if (ProductShare(closure, factor) < kLikeIt) return "depends on both";
  return "is proportional to " + closure.against[factor] + ", by a factor that depends on " +
         closure.against[1 - factor];
}

}  // namespace

std::string Resemblance(const Closure& closure) {
  if (closure.against.size() == 2) return SurfaceResemblance(closure);
  const Points points(closure);
  const Law* best = nullptr;
  LawFit best_fit;
  double least = std::numeric_limits<double>::infinity();
  const std::vector<Law> laws = LawsOf(closure);
  for (const Law& law : laws) {
    const size_t numbers = law.parts.size() + static_cast<size_t>(law.numbers);
    if (numbers + 2 > points.x.size()) continue;
    const LawFit fit = FitLaw(law, points);
    const double cost = fit.left + kPerNumber * static_cast<double>(numbers);
    if (!(cost < least)) continue;
    least = cost;
    best = &law;
    best_fit = fit;
  }
  if (best == nullptr) return "follows no simple law";
  const bool flat = best == &laws.front();
  if (!flat && best_fit.left > (1 - kLikeIt) * points.variation) return "follows no simple law";
  return best->says + (best->odd && best_fit.first < 0 ? ", against it" : "");
}

}  // namespace hydro::diagnose
