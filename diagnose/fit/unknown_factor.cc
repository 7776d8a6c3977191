#include "diagnose/fit/unknown_factor.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hydro::diagnose {
namespace {

using Run = runs::MeasuredRun;

constexpr double kLeast = 2, kMost = 1000;
constexpr double kClosesMore = 1;  // than without the factor, a logarithm
constexpr double kNearly = 0.2;
const double kFactorStep = std::log(1.05);

}  // namespace

std::vector<RecordingMistake> UnknownFactors(const SignalBalances& balances, const Run& run) {
  std::vector<RecordingMistake> factors;
  const std::vector<std::vector<SignalOfRun>> kinds = {
      {&Run::p1, &Run::p2}, {&Run::motor_speed}, {&Run::motor_angle}, {&Run::arm_angle}, {&Run::arm_speed}};
  for (const std::vector<SignalOfRun>& signals : kinds) {
    if (!(run.*signals.front()).measured() || !(run.*signals.back()).measured()) continue;
    // What closes nearly as well as the best is as likely: the middle of it.
    std::vector<std::pair<double, double>> open;  // and the factor's logarithm
    for (double size = std::log(kLeast); size < std::log(kMost); size += kFactorStep) {
      for (const double logarithm : {size, -size}) {
        SignalFactors with;
        AddFactors(UnknownUnit(signals, std::exp(logarithm)), &with);
        open.emplace_back(balances.LeftOpen(with), logarithm);
      }
    }
    const double least = std::min_element(open.begin(), open.end())->first;
    if (least > balances.LeftOpen({}) - kClosesMore) continue;
    double sum = 0, count = 0;
    for (const auto& [left, logarithm] : open) {
      if (left > least + kNearly) continue;
      sum += logarithm;
      count += 1;
    }
    factors.push_back(UnknownUnit(signals, std::exp(sum / count)));
  }
  return factors;
}

}  // namespace hydro::diagnose
