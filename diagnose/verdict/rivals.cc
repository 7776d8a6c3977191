#include "diagnose/verdict/rivals.h"

#include <algorithm>

#include "base/word_list.h"
#include "diagnose/closure/closure.h"
#include "diagnose/verdict/evidence.h"

namespace hydro::diagnose {

namespace {

// A rival is ruled out if it is worse by this many standard errors, block by block.
constexpr double kDistinguished = 2.5;
// The share of the weight of what was found that makes a rival of an explanation.
constexpr double kComparable = 0.2;

double WeightOf(const std::map<std::string, double>& weights, const Explanation& one) {
  const auto weight = weights.find(ClaimOf(one.fitted.hypothesis));
  return weight == weights.end() ? 0 : weight->second;
}

double Largest(const std::map<std::string, double>& weights) {
  double largest = 0;
  for (const auto& [claim, weight] : weights) largest = std::max(largest, weight);
  return largest;
}

// What `other` has that `best` does not: effects or, where it has none at all, its values. "" if nothing.
std::string InPlace(const Explanation& other, const Explanation& best) {
  std::vector<std::string> labels;
  bool effects = false;
  for (const Change& change : other.changes()) {
    effects = effects || !change.effect.empty();
    if (!change.effect.empty() && !best.fitted.hypothesis.Has(change)) labels.push_back(change.Label());
  }
  if (effects) return Joined(labels, " + ");
  const std::string claim = ClaimOf(other.fitted.hypothesis);
  return claim == kAsGiven ? "" : claim;
}

bool Exchanges(const Explanation& other, const Explanation& best) {
  return other.changes().size() == best.changes().size() &&
         other.fitted.hypothesis.OneBeyond(best.fitted.hypothesis) != nullptr;
}

bool LeavesNearlyTheSame(const Explanation& other, const Explanation& best) {
  const double loss = other.held_out_gap() - best.held_out_gap();
  return loss <= std::max(kLeastGain, 0.1 * (best.held_out_gap() - 1));
}

// A curve of its own can draw most effects: that it does as well is no reason to doubt their names.
bool HasAClosure(const Explanation& one) {
  return std::any_of(one.changes().begin(), one.changes().end(),
                     [](const Change& change) { return IsClosureEffect(change.effect); });
}

// Adds the rivals among explanations of the same blocks as `best`.
void AddRivals(const Change& change, const std::vector<const Explanation*>& tried, const Explanation& best,
               const std::map<std::string, double>& weights, std::vector<Rival>* rivals) {
  const double comparable = kComparable * std::min(WeightOf(weights, best), Largest(weights));
  for (const Explanation* other : tried) {
    if (other->blocks.sums.size() != best.blocks.sums.size() || other->blocks.sums.empty()) continue;
    if (other->fitted.hypothesis.Has(change) || HasAClosure(*other)) continue;
    const double weight = WeightOf(weights, *other);
    const bool weighty = weight > 0 && weight >= comparable;
    if (!weighty && !(Exchanges(*other, best) && LeavesNearlyTheSame(*other, best))) continue;
    if (TValue(other->blocks, best.blocks) > kDistinguished) continue;
    std::string label = InPlace(*other, best);
    if (label.empty() && Exchanges(*other, best)) {
      label = other->fitted.hypothesis.OneBeyond(best.fitted.hypothesis)->Label();
    }
    const bool there =
        std::any_of(rivals->begin(), rivals->end(), [&](const Rival& had) { return had.label == label; });
    if (!label.empty() && !there) rivals->push_back({label, other});
  }
}

}  // namespace

std::vector<Rival> RivalsOf(const Change& change, const SearchResult& search, const Explanation& refit,
                            const WindowTrials& windows, const std::map<std::string, double>& weights) {
  std::vector<Rival> rivals;
  const Explanation* near = windows.decide ? OnWindowsOf(windows, search.best.fitted.hypothesis) : nullptr;
  if (near != nullptr) {
    AddRivals(change, PointersToAll(windows.tried), *near, weights, &rivals);
    return rivals;
  }
  std::vector<const Explanation*> whole = PointersToAll(search.tried);
  whole.push_back(&refit);
  AddRivals(change, whole, search.best, weights, &rivals);
  return rivals;
}

}  // namespace hydro::diagnose
