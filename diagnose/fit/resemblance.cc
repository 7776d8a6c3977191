// Finds the simple law that a closure resembles.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/maths/linear_fit.h"
#include "base/number_text.h"
#include "diagnose/fit/closure.h"

namespace hydro::diagnose {
namespace {

// A value is never taken to be known better than to this part of the curve's range. At the first and the last
// knot, which few samples reach, the limit is this many times larger.
constexpr double kCoarse = 0.05, kAtEnds = 3;
// What each number of a law has to gain, in squared standard deviations: two standard deviations.
constexpr double kPerNumber = 4;
// A law has to explain this part of the curve's variation.
constexpr double kLikeIt = 0.9;

using Function = std::function<double(double)>;

struct Law {
  std::string says;
  std::vector<Function> parts;  // each with a coefficient
  double numbers = 0;           // besides the coefficients
  bool odd = false;             // it changes sign with the variable
};

double SignOf(double x) { return static_cast<double>((x > 0) - (x < 0)); }

// Laws of a variable, without a constant or a straight line added.
std::vector<Law> BareLaws(const std::string& name, const std::string& unit, const std::vector<double>& x) {
  const bool both = x.front() < 0 && x.back() > 0;
  const std::string size = both ? "|" + name + "|" : name;
  std::vector<Law> laws;
  const std::pair<const char*, double> powers[] = {{"square root", 0.5}, {"square", 2}, {"cube", 3}};
  for (const auto& [says, power] : powers) {
    laws.push_back({std::string("grows as the ") + says + " of " + size,
                    {[p = power](double v) { return SignOf(v) * std::pow(std::abs(v), p); }},
                    0,
                    both});
  }
  const bool speed = name.ends_with("speed");
  if (both)
    laws.push_back({"changes sign with " + name + (speed ? " (Coulomb friction)" : ""), {SignOf}, 0, true});
  for (const double part : {0.03, 0.1, 0.3}) {
    if (!both) break;
    const Function falls = [fall = part * std::max(-x.front(), x.back())](double v) {
      return SignOf(v) * std::exp(-std::abs(v) / fall);
    };
    laws.push_back({"changes sign with " + name + " and falls with " + size + (speed ? " (Stribeck)" : ""),
                    {SignOf, falls},
                    1,
                    true});
    laws.push_back({"grows with " + size + " up to a limit",
                    {[falls](double v) { return SignOf(v) - falls(v); }},
                    1,
                    true});
  }
  for (size_t i = 1; i + 1 < x.size(); ++i) {
    const double from = x[i];
    const std::string at = " = " + ShortNumber(from, 2) + " " + unit;
    laws.push_back({"begins above " + name + at, {[from](double v) { return std::max(0.0, v - from); }}, 1});
    laws.push_back({"begins below " + name + at, {[from](double v) { return std::max(0.0, from - v); }}, 1});
    if (!both || !(from > 0)) continue;
    laws.push_back({"begins beyond |" + name + "|" + at,
                    {[from](double v) { return SignOf(v) * std::max(0.0, std::abs(v) - from); }},
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
  std::vector<Law> laws = {{"is constant", {one}},
                           {"is proportional to " + name, {itself}, 0, both},
                           {"is a straight line of " + name, {itself, one}, 0, both}};
  for (const Law& bare : BareLaws(name, closure.against_units[0], closure.knots[0])) {
    Law more = bare;
    laws.push_back(bare);
    more.parts.push_back(one);
    more.says = bare.says + ", beside a constant";
    laws.push_back(more);
    more.parts.push_back(itself);
    more.says = bare.says + ", beside a straight line";
    laws.push_back(more);
  }
  return laws;
}

// A column's values divided by what counts as their standard deviations.
std::vector<double> Over(const std::vector<double>& error, const std::vector<double>& x, const Function& of) {
  std::vector<double> column;
  for (size_t i = 0; i < x.size(); ++i) column.push_back(of(x[i]) / error[i]);
  return column;
}

// The sum of squares that the law leaves, and the coefficient of its first part. Infinite: on these points it
// is another law.
std::pair<double, double> FitLaw(const Law& law, const std::vector<double>& x,
                                 const std::vector<double>& error, const std::vector<double>& scaled) {
  std::vector<std::vector<double>> columns;
  for (const Function& part : law.parts) columns.push_back(Over(error, x, part));
  try {
    const maths::LinearFit linear = maths::FitLinear(columns, scaled);
    return {std::pow(linear.residual_deviation, 2) * linear.degrees_of_freedom, linear.coefficients[0]};
  } catch (const std::invalid_argument&) {
    return {std::numeric_limits<double>::infinity(), 0};
  }
}

// For a surface: whether it is its second variable times a function of the first.
std::string SurfaceResemblance(const Closure& closure) {
  const size_t columns = closure.knots[1].size();
  double all = 0, explained = 0, squares = 0;
  for (const double by : closure.knots[1]) squares += by * by;
  for (size_t row = 0; row < closure.knots[0].size(); ++row) {
    double cross = 0;
    for (size_t k = 0; k < columns; ++k) {
      const double value = closure.value[row * columns + k];
      cross += closure.knots[1][k] * value;
      all += value * value;
    }
    explained += cross * cross / squares;
  }
  if (!(explained > kLikeIt * all)) return "depends on both";
  return "is proportional to " + closure.against[1] + ", by a factor that depends on " + closure.against[0];
}

}  // namespace

std::string Resemblance(const Closure& closure) {
  if (closure.against.size() == 2) return SurfaceResemblance(closure);
  const std::vector<double>&x = closure.knots[0], &value = closure.value;
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  const double coarse = kCoarse * std::max(*high - *low, 1e-3 * std::max(std::abs(*high), std::abs(*low)));
  std::vector<double> error, scaled;
  for (size_t i = 0; i < value.size(); ++i) {
    error.push_back(std::max(std::hypot((closure.high[i] - closure.low[i]) / 3.92, coarse), 1e-300));
    if (i == 0 || i + 1 == value.size()) error.back() *= kAtEnds;
    scaled.push_back(value[i] / error[i]);
  }
  std::string says = "follows no simple law";
  double least = std::numeric_limits<double>::infinity(), variation = 0;
  for (const Law& law : LawsOf(closure)) {
    const double numbers = static_cast<double>(law.parts.size()) + law.numbers;
    if (numbers + 2 > static_cast<double>(x.size())) continue;
    const auto [left, first] = FitLaw(law, x, error, scaled);
    const bool constant = least == std::numeric_limits<double>::infinity();  // the first law that is tried
    if (constant) variation = left;
    if (!(left + kPerNumber * numbers < least)) continue;
    least = left + kPerNumber * numbers;
    says = law.says + (law.odd && first < 0 ? ", against it" : "");
    if (!constant && left > (1 - kLikeIt) * variation) says = "follows no simple law";
  }
  return says;
}

}  // namespace hydro::diagnose
