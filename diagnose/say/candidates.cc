#include "diagnose/say/candidates.h"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>

#include "base/number_text.h"
#include "diagnose/say/claims.h"

namespace hydro::diagnose {
namespace {

constexpr double kNotTried = std::numeric_limits<double>::quiet_NaN();

std::string GapOfWindows(const std::vector<WindowGap>& windows) {
  return IsTested(windows) ? ShortNumber(std::sqrt(TypicalGap(windows)), 3) : "";
}

// Whether the set has all of the best one's effects and more.
bool AddsToBest(const ProvedSet& set, const ProvedSet& best) {
  const std::vector<Change> found = best.Effects();
  return !found.empty() && set.Effects().size() > found.size() &&
         std::ranges::all_of(found, [&](const Change& change) { return set.hypothesis.Has(change); });
}

class Ranking {
 public:
  Ranking(const Proof& proof, const std::vector<WeightedSet>& explanations,
          const std::vector<ScoredSet>& scores, size_t singles)
      : proof_(proof), singles_(static_cast<double>(singles)) {
    for (const WeightedSet& one : explanations) weights_[ClaimOfSet(one.changes)] += one.weight;
    const std::string found = ClaimOf(proof.Found());
    // No balance holds its values. Where the given model does not suffice, the set without changes is the set
    // of other values.
    const auto given = weights_.find(kAsGiven);
    if (found == "parameters" && given != weights_.end()) {
      weights_[found] += given->second;
      weights_.erase(kAsGiven);
    }
    for (const ScoredSet& one : scores) scores_.try_emplace(ClaimOfSet(ChangesOf(one.set)), one.score);
    for (size_t i = 0; i < proof.sets.size(); ++i) {
      const auto [at, added] = places_.try_emplace(ClaimOf(proof.sets[i].hypothesis), i);
      const ProvedSet &other = proof.sets[at->second], &one = proof.sets[i];
      const bool better = one.tested() && (!other.tested() || TypicalGap(one.near) < TypicalGap(other.near));
      if (!added && (better || i == proof.best)) at->second = i;
    }
    places_[found] = proof.best;
  }

  std::vector<std::string> Claims() const {
    std::vector<std::string> claims;
    for (const auto& [claim, weight] : weights_) claims.push_back(claim);
    for (const auto& [claim, place] : places_) {
      if (weights_.count(claim) == 0) claims.push_back(claim);
    }
    return claims;
  }

  Candidate Of(const std::string& claim, bool found) const {
    Candidate candidate;
    candidate.id = claim;
    candidate.held_out = kNotTried;
    const auto score = scores_.find(claim);
    candidate.score = score == scores_.end() ? kNotTried : score->second;
    const auto weight = weights_.find(claim);
    candidate.weight = weight == weights_.end() ? 0 : weight->second;
    const auto place = places_.find(claim);
    const ProvedSet* set = place == places_.end() ? nullptr : &proof_.sets[place->second];
    if (set != nullptr && set->tested()) candidate.held_out = std::sqrt(TypicalGap(set->near));
    candidate.p_value = PValue(candidate, set);
    if (!found) candidate.rejected_because = Why(candidate, set);
    return candidate;
  }

 private:
  double PValue(const Candidate& candidate, const ProvedSet* set) const {
    if (candidate.id == kAsGiven) return kNotTried;
    if (!std::isnan(candidate.score)) return std::min(1.0, std::exp(-candidate.score));
    if (set == nullptr || !set->tested() || !proof_.Given().tested()) return kNotTried;
    const GapFall fall = FallOf(proof_.Given().near, set->near);
    if (!(fall.error > 0)) return kNotTried;
    const boost::math::normal normal;
    return std::min(
        1.0, singles_ * boost::math::cdf(boost::math::complement(normal, fall.logarithm / fall.error)));
  }

  std::string Why(const Candidate& candidate, const ProvedSet* set) const {
    if (set == nullptr) return candidate.weight > 0 ? "others explain more" : kNotProposed;
    if (!set->tested())
      return "could not be tried: it cannot be simulated over the held-out " +
             std::string(proof_.OnWindows() ? "windows" : "runs");
    const std::string of = proof_.OnWindows() ? "the gap of windows" : "the gap of whole runs";
    const std::string gap = GapOfWindows(set->near), best = GapOfWindows(proof_.Best().near);
    if (set == &proof_.Best()) return "it leaves a gap of " + gap;
    if (AddsToBest(*set, proof_.Best()))
      return "added to what was found, it changes " + of + " only from " + best + " to " + gap;
    std::string both = of + " is " + gap + " with it, " + best + " with what was found";
    if (!(TypicalGap(set->near) < TypicalGap(proof_.Best().near))) return both;
    const std::vector<WindowGap>&far = set->far, &best_far = proof_.Best().far;
    if (!far.empty() && !best_far.empty() && TypicalGap(far) > TypicalGap(best_far))
      return both + "; but over four times as long " + GapOfWindows(far) + " and " + GapOfWindows(best_far);
    return both + ", by less than an effect has to gain";
  }

  const Proof& proof_;
  double singles_;
  std::map<std::string, double> weights_, scores_;
  std::map<std::string, size_t> places_;
};

void Sort(std::vector<Candidate>* candidates) {
  const auto order = [](const Candidate& c) {
    const double gap = std::isnan(c.held_out) ? std::numeric_limits<double>::infinity() : c.held_out;
    const double chance = std::isnan(c.p_value) ? 1 : c.p_value;
    return std::make_tuple(!c.rejected_because.empty(), -c.weight, gap, chance);
  };
  std::ranges::stable_sort(*candidates,
                           [&](const Candidate& a, const Candidate& b) { return order(a) < order(b); });
}

// What the other runs choose: their windows replace those of the sets.
size_t ChoiceWithoutRun(const Proof& proof, const std::string& run) {
  std::vector<ProvedSet> sets = proof.sets;
  for (ProvedSet& set : sets) {
    for (size_t w = set.near.size(); w-- > 0;) {
      if (proof.runs[w] == run) set.near.erase(set.near.begin() + static_cast<std::ptrdiff_t>(w));
    }
  }
  const ProvedSet& found = sets[proof.best];
  const std::vector<Change> effects = found.Effects();
  for (const Change& change : effects) {
    std::vector<Change> fewer = effects;
    std::erase(fewer, change);
    const size_t without = BestWithEffects(sets, fewer);
    if (without >= sets.size() || !sets[without].tested()) continue;
    const GapFall fall = FallOf(sets[without].near, found.near);
    if (fall.windows > 0 && !fall.Exceeds(0)) return without;
  }
  const size_t leading = LeadingSet(sets);
  if (leading >= sets.size()) return proof.best;
  return FallOf(found.near, sets[leading].near).Exceeds(kPartOfAnEffect) ? leading : proof.best;
}

}  // namespace

std::vector<Candidate> CandidatesOf(const ProofContext& context, const Proof& proof, const Diagnosis& d,
                                    const std::vector<ScoredSet>& scores) {
  const Ranking ranking(proof, d.explanations, scores, context.changes.size());
  const std::string found = ClaimOf(proof.Found());
  std::vector<std::string> claims = ranking.Claims();
  for (const Change& change : context.changes) {
    const std::string label = change.Label();
    if (std::ranges::find(claims, label) == claims.end()) claims.push_back(label);
  }
  std::vector<Candidate> candidates;
  for (const std::string& claim : claims) {
    const bool parts = std::any_of(proof.Found().changes.begin(), proof.Found().changes.end(),
                                   [&](const Change& change) { return change.Label() == claim; });
    const bool taken = claim == found && (claim != kAsGiven || d.verdict == Verdict::kNothingMissing);
    candidates.push_back(ranking.Of(claim, taken || parts));
  }
  Sort(&candidates);
  return candidates;
}

std::vector<ChoiceWithout> ChoicesWithoutEach(const Proof& proof) {
  constexpr size_t kFewestInTurn = 3;
  std::vector<std::string> runs;
  for (const std::string& run : proof.runs) {
    if (std::ranges::find(runs, run) == runs.end()) runs.push_back(run);
  }
  if (runs.size() < kFewestInTurn) return {};
  const std::string found = ClaimOf(proof.Found());
  std::vector<ChoiceWithout> choices;
  for (const std::string& run : runs) {
    const std::string chosen = ClaimOf(proof.sets[ChoiceWithoutRun(proof, run)].hypothesis);
    choices.push_back({run, chosen, chosen == found});
  }
  return choices;
}

}  // namespace hydro::diagnose
