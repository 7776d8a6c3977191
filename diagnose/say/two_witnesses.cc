#include "diagnose/say/two_witnesses.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_weights.h"
#include "diagnose/fit/closure.h"
#include "diagnose/prove/unrecorded.h"
#include "diagnose/say/claims.h"

namespace hydro::diagnose {
namespace {

// The names of an explanation's effects. A curve has one name whatever it acts on, because the proof writes
// one curve of leakage as two.
std::vector<std::string> EffectsOf(const std::vector<std::string>& changes) {
  std::vector<std::string> effects;
  for (const std::string& change : changes) {
    if (IsMissingTerm(change)) effects.push_back(IsClosureEffect(change) ? "closure" : change);
  }
  std::ranges::sort(effects);
  effects.erase(std::unique(effects.begin(), effects.end()), effects.end());
  return effects;
}

std::vector<std::string> NamesOf(const ProvedSet& set) {
  std::vector<std::string> names;
  for (const Change& change : set.Effects()) names.push_back(NameInSets(change));
  return names;
}

// The proof's weights of sets with the same effects: the chosen set, and those that predict nearly as well.
std::map<std::vector<std::string>, double> ProvedWeights(const Proof& proof) {
  std::map<std::vector<std::string>, double> weights;
  double sum = 0;
  for (const ProvedSet& set : proof.sets) {
    if (!set.tested()) continue;
    // With the effects' prices the balances would count twice.
    const double fall = set.near.empty() ? 0 : FallOf(proof.Best().near, set.near).logarithm;
    const auto effects = static_cast<double>(set.Effects().size());
    const double more = std::max(0.0, effects - static_cast<double>(proof.Best().Effects().size()));
    const double weight = std::exp(std::min(0.0, LogOddsOf(fall - more * kPartOfAnEffect)));
    double& of = weights[EffectsOf(NamesOf(set))];
    of = std::max(of, weight);
  }
  for (const auto& [effects, weight] : weights) sum += weight;
  for (auto& [effects, weight] : weights) weight /= sum;
  return weights;
}

}  // namespace

void HearBothWitnesses(const Proof& proof, Diagnosis* d) {
  const bool one_class = std::ranges::any_of(d->explanations, [](const WeightedSet& one) {
    return std::ranges::find(one.changes, kSomeOil) != one.changes.end();
  });
  if (one_class || d->explanations.empty() || !proof.Best().tested()) return;
  for (WeightedSet& one : d->explanations) one.weight *= 0.5;
  for (const auto& [names, weight] : ProvedWeights(proof)) {
    const std::vector<std::string>& effects = names;
    auto same = std::ranges::find_if(
        d->explanations, [&](const WeightedSet& one) { return EffectsOf(one.changes) == effects; });
    if (same == d->explanations.end()) {
      const auto proved = std::ranges::find_if(
          proof.sets, [&](const ProvedSet& set) { return EffectsOf(NamesOf(set)) == effects; });
      same = d->explanations.insert(same, {NamesOf(*proved), 0});
    }
    same->weight += 0.5 * weight;
  }
  d->set_90 = SortByWeight(&d->explanations);
  for (const Change& change : proof.Best().Effects()) {
    for (FoundEffect& effect : d->effects) {
      if (effect.id == change.effect) effect.weight = WeightOf(change, d->explanations);
    }
  }
}

}  // namespace hydro::diagnose
