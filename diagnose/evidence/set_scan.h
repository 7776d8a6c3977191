// Which sets of changes are probable: scores of many sets, and the search for those worth a score.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

struct ScoredSet {
  ChangeSet set;
  double score = 0;  // log evidence + log odds beforehand
};

// The sets tried so far. The same for any number of jobs.
class SetScores {
 public:
  // `evidence` must outlive this. Tries nothing, and nothing but it is there at first.
  explicit SetScores(const SetEvidence& evidence, int jobs = 1);

  // Scores those sets that have none yet, on several threads. Left out: those with a change that the runs
  // cannot show, and those with two variants of one change.
  void Try(const std::vector<ChangeSet>& sets);

  bool Has(const ChangeSet& set) const { return scores_.contains(set); }
  // Throws std::out_of_range for a set that was not tried.
  double Score(const ChangeSet& set) const { return scores_.at(set); }
  size_t size() const { return scores_.size(); }

  // All, best first; equal ones by name.
  std::vector<ScoredSet> BestFirst() const;
  // The best `most` sets of `changes` changes that do not differ in variants only.
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

// Scores all changes alone, pairs of the leading ones, all partners of the best three, and from there on what
// each further change gains, up to six; and the sets in `also`. Some 450 sets of 100 changes, 0.1 ms
// each. `evidence` must outlive the result.
SetScores ScanSets(const SetEvidence& evidence, const std::vector<ChangeSet>& also = {}, int jobs = 1);

}  // namespace hydro::diagnose
