#include "diagnose/fit/joint_mistakes.h"

#include <algorithm>
#include <array>
#include <utility>

namespace hydro::diagnose {
namespace {

using Mistakes = std::vector<RecordingMistake>;

constexpr double kOneMore = 0.5;   // what a further mistake has to close, a logarithm
constexpr size_t kExhaustive = 3;  // mistakes of which every combination is tried
constexpr size_t kExtended = 40;   // of these, which are tried with one more

// A combination, as places in the list of possible mistakes, and what it leaves open.
struct Combination {
  double open = 0;
  std::array<size_t, kMostMistakes> places{};
  size_t count = 0;
};

class Combinations {
 public:
  Combinations(const SignalBalances& balances, const Mistakes& possible)
      : balances_(balances), possible_(possible) {}

  // None first, then each of up to kExhaustive mistakes, and the best of these with one more.
  std::vector<Combination> All() {
    all_.push_back({balances_.LeftOpen({})});
    Extend(0, {});
    std::vector<Combination> best = all_;
    std::stable_sort(best.begin(), best.end(), [](const auto& a, const auto& b) { return a.open < b.open; });
    size_t extended = 0;
    for (const Combination& one : best) {
      if (extended == kExtended) break;
      if (one.count != kExhaustive) continue;
      ++extended;
      for (size_t m = 0; m < possible_.size(); ++m) Add(one, m);
    }
    return std::move(all_);
  }

 private:
  // Returns the combination with one more; without it where the two cannot come together.
  Combination Add(const Combination& chosen, size_t m) {
    const bool excluded =
        std::any_of(chosen.places.begin(), chosen.places.begin() + chosen.count,
                    [&](size_t one) { return one == m || Exclude(possible_[one], possible_[m]); });
    if (excluded) return chosen;
    Combination more = chosen;
    more.places[more.count++] = m;
    std::sort(more.places.begin(), more.places.begin() + more.count);
    SignalFactors factors;
    for (size_t i = 0; i < more.count; ++i) AddFactors(possible_[more.places[i]], &factors);
    more.open = balances_.LeftOpen(factors) + kOneMore * static_cast<double>(more.count);
    all_.push_back(more);
    return more;
  }

  void Extend(size_t next, const Combination& chosen) {
    if (chosen.count == kExhaustive) return;
    for (size_t m = next; m < possible_.size(); ++m) {
      const Combination more = Add(chosen, m);
      if (more.count > chosen.count) Extend(m + 1, more);
    }
  }

  const SignalBalances& balances_;
  const Mistakes& possible_;
  std::vector<Combination> all_;
};

}  // namespace

std::vector<Mistakes> JointMistakes(const SignalBalances& balances, const Mistakes& possible, size_t most) {
  std::vector<Combination> all = Combinations(balances, possible).All();
  const double none = all.front().open;
  std::erase_if(all, [none](const Combination& one) { return one.open >= none; });
  std::stable_sort(all.begin(), all.end(),
                   [](const Combination& a, const Combination& b) { return a.open < b.open; });
  std::vector<Mistakes> best;
  for (const Combination& one : all) {
    if (best.size() == most) break;
    Mistakes mistakes;
    for (size_t i = 0; i < one.count; ++i) mistakes.push_back(possible[one.places[i]]);
    // What was extended comes in several ways.
    if (best.empty() || best.back() != mistakes) best.push_back(std::move(mistakes));
  }
  return best;
}

}  // namespace hydro::diagnose
