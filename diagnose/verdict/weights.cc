#include "diagnose/verdict/weights.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

#include "diagnose/fit/comparison.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

namespace {

constexpr int kDraws = 1000;

// Random weights of blocks: that of their run, and within it their own. All are exponential, as in the Bayesian
// bootstrap (Rubin 1981). Draws of whole runs would leave out, every now and then, the only run that shows an
// effect, and what other runs cannot show is no doubt about it.
class Draws {
 public:
  Draws(const std::vector<std::string>& runs, uint64_t seed) : random_(seed), size_(runs.size()) {
    std::map<std::string, std::vector<size_t>> by_run;
    for (size_t b = 0; b < runs.size(); ++b) by_run[runs[b]].push_back(b);
    for (auto& [run, blocks] : by_run) blocks_.push_back(std::move(blocks));
  }

  std::vector<double> Next() {
    std::vector<double> weights(size_, 0.0);
    for (const std::vector<size_t>& blocks : blocks_) {
      const double of_run = Exponential() * static_cast<double>(blocks.size());
      double sum = 0;
      for (const size_t b : blocks) sum += weights[b] = Exponential();
      for (const size_t b : blocks) weights[b] *= of_run / sum;
    }
    return weights;
  }

 private:
  double Exponential() { return -std::log((static_cast<double>(random_() >> 11) + 0.5) * 0x1p-53); }

  std::mt19937_64 random_;
  size_t size_;
  std::vector<std::vector<size_t>> blocks_;
};

// Values whose mean is the squared gap, or its logarithm.
std::vector<double> ToAverage(const Evidence& one, bool geometric) {
  std::vector<double> values = one.squared_gaps;
  for (double& value : values) {
    value = std::clamp(value, 1e-3, 1e12);
    if (geometric) value = std::log(value);
  }
  return values;
}

bool AddsTo(const Evidence& more, const Evidence& less) {
  return more.parts.size() > less.parts.size() &&
         std::includes(more.parts.begin(), more.parts.end(), less.parts.begin(), less.parts.end());
}

class Bootstrap {
 public:
  // `evidence`: the simplest first.
  Bootstrap(std::vector<Evidence> evidence, bool geometric)
      : evidence_(std::move(evidence)), geometric_(geometric), simpler_(evidence_.size()) {
    for (size_t i = 0; i < evidence_.size(); ++i) {
      values_.push_back(ToAverage(evidence_[i], geometric));
      for (size_t k = 0; k < i; ++k) {
        if (AddsTo(evidence_[i], evidence_[k])) simpler_[i].push_back(k);
      }
    }
  }

  // The parts of the win, by id; they add to 1.
  std::map<std::string, double> Parts(const std::vector<double>& draw) const {
    const std::vector<double> costs = Costs(Gaps(draw));
    const double least = *std::min_element(costs.begin(), costs.end());
    const double near = std::max(kLeastGain, kLeastShare * (least - 1));
    std::map<std::string, double> parts;
    for (size_t i = 0; i < evidence_.size(); ++i) {
      double& part = parts[evidence_[i].id];
      part = std::max(part, 1 - (costs[i] - least) / near);
    }
    double sum = 0;
    for (const auto& [id, part] : parts) sum += part;
    for (auto& [id, part] : parts) part /= sum;
    return parts;
  }

 private:
  std::vector<double> Gaps(const std::vector<double>& draw) const {
    double all = 0;
    for (const double weight : draw) all += weight;
    std::vector<double> gaps;
    gaps.reserve(values_.size());
    for (const std::vector<double>& values : values_) {
      double sum = 0;
      for (size_t b = 0; b < draw.size(); ++b) sum += draw[b] * values[b];
      gaps.push_back(geometric_ ? std::exp(sum / all) : sum / all);
    }
    return gaps;
  }

  // Infinite for those that add to a simpler one without a material gain.
  std::vector<double> Costs(const std::vector<double>& gaps) const {
    std::vector<double> costs(gaps.size());
    for (size_t i = 0; i < gaps.size(); ++i) {
      const bool needless = std::any_of(simpler_[i].begin(), simpler_[i].end(), [&](size_t k) {
        return std::isfinite(costs[k]) && !Material(gaps[k], gaps[i]);
      });
      costs[i] = needless ? std::numeric_limits<double>::infinity() : Cost(gaps[i], evidence_[i].numbers);
    }
    return costs;
  }

  std::vector<Evidence> evidence_;
  bool geometric_;
  std::vector<std::vector<size_t>> simpler_;  // those that each adds to
  std::vector<std::vector<double>> values_;
};

}  // namespace

std::map<std::string, double> Weights(const Contest& contest, uint64_t seed) {
  if (contest.evidence.empty() || contest.runs.empty()) return {};
  std::vector<Evidence> evidence = contest.evidence;
  std::stable_sort(evidence.begin(), evidence.end(), [](const Evidence& a, const Evidence& b) {
    return std::make_tuple(a.parts.size(), a.parts, a.id, a.squared_gaps) <
           std::make_tuple(b.parts.size(), b.parts, b.id, b.squared_gaps);
  });
  const Bootstrap bootstrap(std::move(evidence), contest.geometric);
  Draws draws(contest.runs, seed);
  std::map<std::string, double> weights;
  for (int i = 0; i < kDraws; ++i) {
    for (const auto& [id, part] : bootstrap.Parts(draws.Next())) weights[id] += part;
  }
  double sum = 0;
  for (const auto& [id, weight] : weights) sum += weight;
  for (auto& [id, weight] : weights) weight /= sum;
  return weights;
}

}  // namespace hydro::diagnose
