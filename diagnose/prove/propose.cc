#include "diagnose/prove/propose.h"

#include <algorithm>
#include <optional>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/estimated_model.h"
#include "diagnose/evidence/wave_periods.h"

namespace hydro::diagnose {

namespace {

// The truth was among the first five of a prototype's sets in all but one of 40 rigs.
constexpr size_t kMostExplanations = 5;
// What a set gains over a smaller one that is no explanation of its own; simulation decides between the two.
constexpr size_t kMostProposals = 8;

// The sets that are proposed: the likeliest explanations, the best sets by score, and those with one change less than the first.
std::vector<ChangeSet> SetsToPropose(const ExplanationWeights& weights,
                                     const std::vector<ScoredSet>& scores) {
  std::vector<ChangeSet> sets = {{}};
  const auto add = [&](const ChangeSet& set) {
    if (sets.size() >= kMostProposals) return;
    if (std::find(sets.begin(), sets.end(), set) == sets.end()) sets.push_back(set);
  };
  for (size_t i = 0; i < std::min(kMostExplanations, weights.explanations.size()); ++i)
    add(weights.explanations[i].set);
  if (!scores.empty()) add(scores.front().set);
  if (!weights.explanations.empty()) {
    const ChangeSet& first = weights.explanations.front().set;
    for (size_t without = 0; without < first.size(); ++without) {
      ChangeSet less = first;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(without));
      add(less);
    }
  }
  for (const ScoredSet& scored : scores) {
    if (scored.set.size() == 1) add(scored.set);
  }
  return sets;
}

double WeightOf(const ExplanationWeights& weights, const ChangeSet& set) {
  for (const WeighedExplanation& one : weights.explanations) {
    if (one.set == set) return one.weight;
  }
  return 0;
}

}  // namespace

Proposed Propose(const SearchContext& context, const std::vector<size_t>& allowed) {
  ScanOptions options;
  options.jobs = context.jobs;
  options.allowed = allowed;
  options.changes = context.changes;
  ScanRuns runs(context.given, context.runs, options);
  Rows rows = runs.MakeRows({});
  Proposed proposed;
  if (rows.blocks.empty()) return proposed;
  const std::vector<int> periods = LikelyPeriods(runs, rows, SetEvidence(rows), context.jobs);
  if (!periods.empty()) rows = runs.MakeRows(periods);
  const SetEvidence evidence(rows);
  SetScores scores = ScanSets(evidence, {}, context.jobs);
  proposed.weights = WeighExplanations(&scores, context.seed);
  proposed.scores = scores.BestFirst();
  const double nothing = scores.Score({});
  for (ScoredSet& one : proposed.scores) one.score -= nothing;
  for (const ChangeSet& set : SetsToPropose(proposed.weights, proposed.scores)) {
    const std::optional<EstimatedModel> estimated = ModelOf(runs, rows, set, evidence.Fit(set));
    if (!estimated) continue;
    Proposal proposal{estimated->changes,
                      estimated->model,
                      estimated->base,
                      {},
                      scores.Score(set) - nothing,
                      WeightOf(proposed.weights, set)};
    if (context.held_out.empty() && context.runs.size() > 1) {
      for (size_t r = 0; r < context.runs.size(); ++r) {
        const SetEvidence others = evidence.Without({r});
        const std::vector<std::string>& names = others.names();
        const bool shown = std::all_of(set.begin(), set.end(), [&](const std::string& name) {
          return std::find(names.begin(), names.end(), name) != names.end();
        });
        const ChangeSet left = shown ? set : ChangeSet{};
        const std::optional<EstimatedModel> without = ModelOf(runs, rows, left, others.Fit(left));
        proposal.without.push_back(without && shown ? without->model : estimated->model);
      }
    }
    proposed.proposals.push_back(std::move(proposal));
  }
  return proposed;
}

}  // namespace hydro::diagnose
