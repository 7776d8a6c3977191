#include "diagnose/evidence/set_scan.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "base/parallel.h"

namespace hydro::diagnose {
namespace {

// The width of the search. Right answers were among the first three singles or pairs on nearly all rigs.
constexpr size_t kWithAllPartners = 3;  // singles
constexpr size_t kSinglesToPair = 8, kPartnersOfSingles = 20;
constexpr size_t kPairsToExtend = 6, kLargerToExtend = 2, kPartnersOfLarger = 25;
// Explanations with more changes are not worth reporting.
constexpr size_t kMostOfASet = 6;
// Where no pair comes this close to the best single, no third change is worth trying.
constexpr double kWithinReach = 2;

class SetSearch {
 public:
  explicit SetSearch(SetScores* scores) : scores_(*scores) {}

  void Search(const std::vector<std::string>& names) {
    Extend({ChangeSet()}, names);
    for (size_t changes = 1; changes < kMostOfASet; ++changes) {
      // Pairs are searched from every single. From then on each further change must have been a gain.
      if (changes > 2 && Best(changes) <= Best(changes - 1)) return;
      if (changes == 1)
        Pair(names);
      else
        ExtendLeaders(changes);
      if (Best(changes + 1) < Best(changes) - kWithinReach) return;
    }
  }

 private:
  static constexpr double kNone = -std::numeric_limits<double>::infinity();

  double Best(size_t changes) const {
    const std::vector<ScoredSet> leader = scores_.Leaders(changes, 1);
    return leader.empty() ? kNone : leader.front().score;
  }

  std::vector<std::string> BestPartners() const {
    std::vector<std::string> partners;
    for (const ScoredSet& one : scores_.BestFirst())
      if (one.set.size() == 1 && partners.size() < kPartnersOfLarger) partners.push_back(one.set.front());
    return partners;
  }

  void Pair(const std::vector<std::string>& names) {
    const std::vector<ScoredSet> singles = scores_.Leaders(1, std::max(kSinglesToPair, kPartnersOfSingles));
    std::vector<std::string> partners;
    partners.reserve(singles.size());
    for (const ScoredSet& single : singles) partners.push_back(single.set.front());
    for (size_t i = 0; i < std::min(singles.size(), kSinglesToPair); ++i)
      Extend({singles[i].set}, i < kWithAllPartners ? names : partners);
  }

  void ExtendLeaders(size_t changes) {
    std::vector<ChangeSet> leaders;
    for (ScoredSet& leader : scores_.Leaders(changes, changes == 2 ? kPairsToExtend : kLargerToExtend))
      leaders.push_back(std::move(leader.set));
    Extend(leaders, BestPartners());
  }

  void Extend(const std::vector<ChangeSet>& sets, const std::vector<std::string>& partners) {
    std::vector<ChangeSet> extended;
    for (const ChangeSet& set : sets)
      for (const std::string& partner : partners)
        if (!HasChange(set, partner)) extended.push_back(WithChange(set, partner));
    scores_.Try(extended);
  }

  SetScores& scores_;
};

bool Comes(const ScoredSet& a, const ScoredSet& b) {
  return a.score != b.score ? a.score > b.score : a.set < b.set;
}

}  // namespace

SetScores::SetScores(const SetEvidence& evidence, int jobs)
    : evidence_(evidence), odds_(evidence.names()), jobs_(jobs) {
  Try({ChangeSet()});
}

void SetScores::Try(const std::vector<ChangeSet>& sets) {
  std::set<ChangeSet> fresh;
  for (const ChangeSet& set : sets) {
    const ChangeSet changes = ChangesOf(set);
    const bool shown = evidence_.Shows(set);
    const bool twice = std::adjacent_find(changes.begin(), changes.end()) != changes.end();
    if (shown && !twice && !Has(set)) fresh.insert(set);
  }
  const std::vector<ChangeSet> work(fresh.begin(), fresh.end());
  std::vector<double> scores(work.size());
  ParallelFor(work.size(), jobs_,
              [&](size_t i) { scores[i] = evidence_.Log(work[i]) + odds_.LogOdds(work[i]); });
  // A set that cannot be computed is not probable.
  for (size_t i = 0; i < work.size(); ++i)
    scores_[work[i]] = std::isnan(scores[i]) ? -std::numeric_limits<double>::infinity() : scores[i];
}

std::vector<ScoredSet> SetScores::BestFirst() const {
  std::vector<ScoredSet> all;
  for (const auto& [set, score] : scores_) all.push_back({set, score});
  std::ranges::sort(all, Comes);
  return all;
}

std::vector<ScoredSet> SetScores::Leaders(size_t changes, size_t most) const {
  std::vector<ScoredSet> leaders;
  std::set<ChangeSet> seen;
  for (ScoredSet& one : BestFirst()) {
    if (leaders.size() == most) break;
    if (one.set.size() == changes && seen.insert(ChangesOf(one.set)).second)
      leaders.push_back(std::move(one));
  }
  return leaders;
}

SetScores ScanSets(const SetEvidence& evidence, int jobs) {
  SetScores scores(evidence, jobs);
  // Where curves lead, sets of named changes would not be extended: they are searched by themselves first.
  std::vector<std::string> named = evidence.names();
  std::erase_if(named, [](const std::string& name) { return HasCurve({name}); });
  SetSearch(&scores).Search(named);
  SetSearch(&scores).Search(evidence.names());
  return scores;
}

}  // namespace hydro::diagnose
