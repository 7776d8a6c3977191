#include "diagnose/fit/joint_mistakes.h"

#include <algorithm>
#include <utility>

namespace hydro::diagnose {
namespace {

using Mistakes = std::vector<RecordingMistake>;

constexpr double kOneMore = 0.5;  // what a further mistake has to close, a logarithm

class Combinations {
 public:
  Combinations(const SignalBalances& balances, const Mistakes& possible)
      : balances_(balances), possible_(possible) {}

  // Each with what it leaves open, in the order of `possible`.
  std::vector<std::pair<double, Mistakes>> All() {
    Extend(0, {});
    return std::move(all_);
  }

 private:
  void Extend(size_t next, const Mistakes& chosen) {
    const double open = balances_.LeftOpen(FactorsOf(chosen));
    all_.emplace_back(open + kOneMore * static_cast<double>(chosen.size()), chosen);
    if (chosen.size() == kMostMistakes) return;
    for (size_t m = next; m < possible_.size(); ++m) {
      const bool excluded = std::any_of(chosen.begin(), chosen.end(), [&](const RecordingMistake& one) {
        return Exclude(one, possible_[m]);
      });
      if (excluded) continue;
      Mistakes more = chosen;
      more.push_back(possible_[m]);
      Extend(m + 1, more);
    }
  }

  const SignalBalances& balances_;
  const Mistakes& possible_;
  std::vector<std::pair<double, Mistakes>> all_;
};

}  // namespace

std::vector<Mistakes> JointMistakes(const SignalBalances& balances, const Mistakes& possible, size_t most) {
  auto all = Combinations(balances, possible).All();
  const double none = all.front().first;
  std::erase_if(all, [none](const auto& one) { return one.first >= none; });
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Mistakes> best;
  for (size_t i = 0; i < std::min(most, all.size()); ++i) best.push_back(std::move(all[i].second));
  return best;
}

}  // namespace hydro::diagnose
