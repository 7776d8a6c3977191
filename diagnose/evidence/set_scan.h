// Finds which sets of changes are probable: scores many sets, and searches for those worth a score.
#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

struct ScoredSet {
  ChangeSet set;
  double score = 0;  // log evidence + log prior odds
};

// The sets tried so far. They are the same for any number of jobs.
class SetScores {
 public:
  // Starts with the score of the empty set alone. `evidence` must outlive this object.
  explicit SetScores(const SetEvidence& evidence, int jobs = 1);

  // Scores those sets that have no score yet, on several threads. Skips sets with a change that the runs
  // cannot show, and sets with two variants of one change.
  void Try(const std::vector<ChangeSet>& sets);

  bool Has(const ChangeSet& set) const { return scores_.contains(set); }
  // Throws std::out_of_range for a set that was not tried.
  double Score(const ChangeSet& set) const { return scores_.at(set); }
  size_t size() const { return scores_.size(); }

  // All sets, best first; equal scores are ordered by name.
  std::vector<ScoredSet> BestFirst() const;
  // The best `most` sets of `changes` changes. Two sets that differ only in variants count once.
  std::vector<ScoredSet> Leaders(size_t changes, size_t most) const;

  const SetEvidence& evidence() const { return evidence_; }
  const ChangeOdds& odds() const { return odds_; }
  int jobs() const { return jobs_; }

 private:
  const SetEvidence& evidence_;
  ChangeOdds odds_;
  int jobs_;
  std::map<ChangeSet, double> scores_;
};

// Scores all single changes, pairs of the leading ones, and all partners of the best three. From there on it
// adds the change that gains most, up to six changes: first among named changes alone, then with curves. A
// set that both searches meet is scored once, at 0.1 ms. `evidence` must outlive the result.
SetScores ScanSets(const SetEvidence& evidence, int jobs = 1);

}  // namespace hydro::diagnose
