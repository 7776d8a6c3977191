#include "diagnose/prove/propose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/estimated_model.h"
#include "diagnose/evidence/refined_shapes.h"
#include "diagnose/evidence/run_values.h"
#include "diagnose/evidence/wave_periods.h"
#include "diagnose/fit/closure.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/fit/likeliest_scale.h"
#include "diagnose/prove/unrecorded.h"

namespace hydro::diagnose {
namespace {

// In a prototype the truth was among the first five sets on all but one of 40 rigs.
constexpr size_t kMostExplanations = 5;
// Includes sets that gain little over a smaller set and are no explanations of their own. Simulation decides
// between the two.
constexpr size_t kMostProposals = 8;
// The number of effects whose shapes are refined before sets are compared. The true one was nearly always
// among the first three singles.
constexpr size_t kMostLeaders = 5;

// The torque limit bends the balance where it acts, so its column is valid only near the limit. If the limit
// is off by more than this part, its value is taken from the balances and the columns are made again. Two
// rounds suffice, because the range beyond the given limit shows the rest.
constexpr double kLimitOff = 0.01;
constexpr int kLimitsAgain = 2;

// Pressures that were not measured are marched again with the values that the balances then show. The second
// repetition hardly moves them.
constexpr int kMarchesAgain = 2;

// The model with each predicted run's own values of the parameters that differ by run, as that run's balances
// give them.
std::vector<model::ModelDescription> ModelsOfRuns(const ProofContext& context,
                                                  const std::vector<size_t>& allowed,
                                                  const model::ModelDescription& model,
                                                  const std::vector<std::string>& by_run) {
  std::vector<model::ModelDescription> models(context.predicted().size(), model);
  for (const size_t place : ValuesOfADay(allowed)) {
    const model::BaseParameter& base = model::BaseParameters()[place];
    if (std::ranges::find(by_run, base.info.name) == by_run.end()) continue;
    const std::optional<RunValues> values = ValuesOfRuns(model, context.predicted(), place, context.jobs);
    for (size_t r = 0; r < models.size() && values; ++r) models[r].parameters.*base.member = values->value[r];
  }
  return models;
}

// The sets that may be proposed, in this order: the empty set, the likeliest named explanation, the best
// single change of each kind, further explanations, the best named set by score, the likeliest explanation of
// all if it has a curve, the sets with one change less than the first explanation, and each single change at
// its best shape.
std::vector<ChangeSet> SetsToPropose(const ExplanationWeights& named, const ExplanationWeights& weights,
                                     const std::vector<ScoredSet>& scores) {
  std::vector<ChangeSet> sets = {{}};
  // Values for each run come from the runs that they predict, so no simulation can compare them with values
  // common to all runs. The balances decide whether they are tried.
  const bool runs_first = !named.explanations.empty() && NamesARun(named.explanations.front().set);
  const auto add = [&](const ChangeSet& set) {
    if (NamesARun(set) && !(runs_first && set == named.explanations.front().set)) return;
    if (std::ranges::find(sets, set) == sets.end()) sets.push_back(set);
  };
  const auto add_best = [&](const auto& is) {
    const auto best = std::ranges::find_if(scores, is);
    if (best != scores.end()) add(best->set);
  };
  const auto is_single = [](const ScoredSet& one) { return one.set.size() == 1; };
  const auto explain = [&](size_t from, size_t to) {
    for (size_t i = from; i < std::min(to, named.explanations.size()); ++i) add(named.explanations[i].set);
  };
  explain(0, 1);
  // One of each kind is simulated, whatever the balances make of them together: the best effect, since two
  // that no simulation bears out may explain more than the one that is there; the best curve, or the nearest
  // effect would take its place; and the best value, since wrong values are the likeliest cause of all.
  add_best([&](const ScoredSet& one) {
    return is_single(one) && IsMissingTerm(one.set[0]) && !HasCurve(one.set);
  });
  add_best([&](const ScoredSet& one) { return is_single(one) && HasCurve(one.set); });
  add_best([&](const ScoredSet& one) { return is_single(one) && one.set[0].starts_with("value."); });
  explain(1, kMostExplanations);
  add_best([](const ScoredSet& one) { return !HasCurve(one.set); });
  if (!weights.explanations.empty() && HasCurve(weights.explanations.front().set))
    add(weights.explanations.front().set);
  if (!named.explanations.empty()) {
    const ChangeSet& first = named.explanations.front().set;
    for (size_t without = 0; without < first.size(); ++without) {
      ChangeSet less = first;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(without));
      add(less);
    }
  }
  std::vector<std::string> alone;
  for (const ScoredSet& scored : scores) {
    if (!is_single(scored) || !IsMissingTerm(scored.set[0])) continue;
    const std::string change(ChangeOf(scored.set[0]));
    if (std::ranges::find(alone, change) != alone.end()) continue;
    alone.push_back(change);
    add(scored.set);
  }
  return sets;
}

// The balances measure every torque by k_1 v and every flow by D w, so that the estimate has k_1 as given and
// moves flows that it did not estimate.
void AtLikeliestScale(const model::ModelDescription& given, EstimatedModel* estimated) {
  std::vector<size_t> moved;
  for (size_t place = 0; place < model::BaseParameters().size(); ++place) {
    const auto member = model::BaseParameters()[place].member;
    const bool there = std::ranges::find(estimated->base, place) != estimated->base.end();
    const bool differs = estimated->model.parameters.*member != given.parameters.*member;
    if (there || differs || member == &model::Parameters::k_1) moved.push_back(place);
  }
  MoveToLikeliestScale(given, moved, estimated->changes, &estimated->model);
  if (estimated->model.parameters.k_1 != given.parameters.k_1)
    estimated->base.push_back(model::BasePlace("k_1"));
}

// If one value is far off, or differs by run, the model with only this value changed: all other values may be
// right as given.
std::optional<Proposal> OneValueAlone(const ProofContext& context, const std::vector<size_t>& allowed,
                                      const ChangeSet& set, const Proposal& all) {
  const bool is_value = set.size() == 1 && set[0].starts_with("value.") && all.changes.size() == 1;
  const bool by_run = set.size() == 1 && all.by_run.size() == 1;
  if (!is_value && !by_run) return std::nullopt;
  const std::string& name = by_run ? all.by_run[0] : all.changes[0].parameter;
  const std::vector<model::BaseParameter>& bases = model::BaseParameters();
  const auto base =
      std::ranges::find_if(bases, [&](const model::BaseParameter& one) { return one.info.name == name; });
  if (base == bases.end()) return std::nullopt;  // of an effect that the model has
  Proposal alone = all;
  const auto keep_one = [&](const model::ModelDescription& estimated, model::ModelDescription* model) {
    model->parameters = context.given.parameters;
    model->parameters.*base->member = estimated.parameters.*base->member;
  };
  keep_one(all.model, &alone.model);
  if (by_run) {
    alone.without = ModelsOfRuns(context, allowed, alone.model, all.by_run);
  } else {
    for (size_t r = 0; r < alone.without.size(); ++r) keep_one(all.without[r], &alone.without[r]);
  }
  alone.base = {static_cast<size_t>(base - bases.begin())};
  return alone;
}

// A model has each effect once, so it cannot contain two curves on one balance over different variables.
bool HasTwoOfAKind(const model::ModelDescription& model) {
  std::vector<std::string> ids;
  for (const model::EffectDescription& effect : model.effects) ids.push_back(effect.id);
  std::ranges::sort(ids);
  return std::adjacent_find(ids.begin(), ids.end()) != ids.end();
}

// States that the sensor reads with the wrong sign.
void Invert(const std::string& sensor, Proposal* proposal) {
  const Change change{"sensor.sign", {{"signal", sensor}}, ""};
  const model::EffectDescription effect{.id = change.effect, .parameters = {}, .names = change.names};
  proposal->changes.push_back(change);
  proposal->model.effects.push_back(effect);
  for (model::ModelDescription& model : proposal->without) model.effects.push_back(effect);
}

// Values that a fit may move: those that the balances show, the yardsticks of those that could be formed, and
// what a simulation shows where balances do not. Oil at low pressure has no balance, because a valve may pass
// some, but a simulation shows how fast it leaks and how far the pump moves the arm.
std::vector<size_t> Shown(const Rows& rows, const EstimatedModel& values,
                          const std::vector<size_t>& allowed) {
  bool torque = false, oil = false, arm = false;
  for (const RowBlock& block : rows.blocks) {
    const bool is_torque = block.balance == BalanceKind::kTorque;
    arm |= block.balance == BalanceKind::kArm;
    torque |= is_torque;
    oil |= !is_torque;
  }
  using model::Parameters;
  std::vector<size_t> shown;
  for (const size_t place : allowed) {
    double Parameters::*member = model::BaseParameters()[place].member;
    const bool beside = (torque && member == &Parameters::k_1) ||
                        (arm && (member == &Parameters::k_2 || member == &Parameters::c)) ||
                        (oil && (member == &Parameters::c_E || member == &Parameters::c_I));
    if (beside || std::ranges::find(values.base, place) != values.base.end()) shown.push_back(place);
  }
  return shown;
}

std::vector<std::string> RemarksOn(const ScanRuns& runs) {
  std::vector<std::string> remarks;
  for (const auto& [effect, value] : runs.doubles()) {
    // Once, however many shapes of it do.
    const std::string remark = std::string(ChangeOf(effect)) + " does in these runs what another value of " +
                               value + " does: it is said as the value";
    if (std::ranges::find(remarks, remark) == remarks.end()) remarks.push_back(remark);
  }
  return remarks;
}

// The ids of effects that by themselves score so far below the best single effect that, with tempered scores,
// they are a hundred times less likely.
std::vector<std::string> UnlikelyEffects(const std::vector<ScoredSet>& scores) {
  const double least = kTemperature * std::log(100.0);
  std::vector<std::string> likely, unlikely;
  double best = -std::numeric_limits<double>::infinity();
  for (const ScoredSet& scored : scores) {  // the best first
    if (scored.set.size() != 1 || !IsMissingTerm(scored.set[0])) continue;
    best = std::max(best, scored.score);
    const std::string id = EffectOf(scored.set[0]);
    std::vector<std::string>& to = scored.score > best - least ? likely : unlikely;
    const bool known = std::ranges::find(likely, id) != likely.end();
    if (!known && std::ranges::find(to, id) == to.end()) to.push_back(id);
  }
  return unlikely;
}

// Moves the shapes of the likeliest effects to where the evidence has them, so that no effect loses to
// another because it lies between two points of its grid.
void RefineLeaders(ScanRuns* runs, Rows* rows, int jobs) {
  std::vector<std::string> refined;
  const std::vector<ScoredSet> scores = ScanSets(SetEvidence(*rows), jobs).BestFirst();
  const auto refine = [&](const ChangeSet& set) {
    if (refined.size() >= kMostLeaders) return;
    const bool fresh = std::ranges::any_of(set, [&](const std::string& name) {
      const std::string change(ChangeOf(name));
      const bool has_shape = name.find('|') != std::string::npos;
      return has_shape && std::ranges::find(refined, change) == refined.end();
    });
    if (!fresh) return;
    for (const std::string& name : set) refined.emplace_back(ChangeOf(name));
    RefinedShapes(runs, *rows, set).Keep(rows);
  };
  const auto named = std::ranges::find_if(scores, [](const ScoredSet& one) { return !HasCurve(one.set); });
  if (named != scores.end()) refine(named->set);
  for (const ScoredSet& one : scores) {
    if (one.set.size() == 1) refine(one.set);
  }
}

// The total weight of all explanations that have a change, by its id. An unknown curve is no rival for the
// name of an effect; simulation compares the two. Effects are therefore weighed without curves.
std::map<std::string, double> SaidOf(const ExplanationWeights& all,
                                     const ExplanationWeights& without_curves) {
  std::map<std::string, double> said;
  for (const ExplanationWeights* weights : {&all, &without_curves}) {
    for (const WeighedExplanation& one : weights->explanations) {
      for (const std::string& change : one.changes) {
        if (IsClosureEffect(change) == (weights == &all)) said[EffectOf(change)] += one.weight;
      }
    }
  }
  return said;
}

double WeightOf(const ExplanationWeights& weights, const ChangeSet& set) {
  for (const WeighedExplanation& one : weights.explanations) {
    if (one.set == set) return one.weight;
  }
  return 0;
}

// The runs as the scan reads them: at the torque limit that their balances show, with pressures that were not
// measured marched with the values that they show. Neither needs the columns of effects, which take most of
// the work.
ScanRuns SettledRuns(const ProofContext& context, ScanOptions options) {
  ScanOptions bare = options;
  bare.only_always = true;
  model::ModelDescription given = context.given;
  const auto values_of = [&](ScanRuns& runs) -> std::optional<EstimatedModel> {
    const Rows rows = runs.MakeRows({});
    return rows.blocks.empty() ? std::nullopt : ModelOf(runs, rows, {}, SetEvidence(rows).Fit({}));
  };
  ScanRuns runs(given, context.runs, bare);
  std::optional<EstimatedModel> values = values_of(runs);
  for (int again = 0; again < kLimitsAgain && values; ++again) {
    const double limit = values->model.parameters.T_pmax;
    if (!(limit > 0) || std::abs(limit / given.parameters.T_pmax - 1) <= kLimitOff) break;
    given.parameters.T_pmax = limit;
    runs = ScanRuns(given, context.runs, bare);
    values = values_of(runs);
  }
  for (int again = 0; again < kMarchesAgain && runs.HasLatent() && values; ++again) {
    options.marched = bare.marched = values->model;
    runs = ScanRuns(given, context.runs, bare);
    values = values_of(runs);
  }
  return {given, context.runs, options};
}

}  // namespace

bool IsImpossible(const Rows& rows, const ChangeSet& set, const SetFit& fit) {
  return std::ranges::any_of(set, [&](const std::string& change) {
    bool only_adds = false, adds = false;
    for (size_t i = 0; i < fit.columns.size(); ++i) {
      const ScanColumn& column = rows.columns[static_cast<size_t>(fit.columns[i])];
      if (column.set != change) continue;
      only_adds |= column.positive;
      adds |= !column.positive || fit.amounts[static_cast<Eigen::Index>(i)] >= 0;
    }
    return only_adds && !adds;
  });
}

Proposed Propose(const ProofContext& context, const std::vector<size_t>& allowed,
                 const std::vector<std::string>& inverted) {
  ScanOptions options;
  options.jobs = context.jobs;
  options.allowed = allowed;
  options.changes = context.changes;
  options.inverted = inverted;
  ScanRuns runs = SettledRuns(context, options);
  Rows rows = runs.MakeRows({});
  Proposed proposed;
  if (rows.blocks.empty()) {
    proposed.unjudged = UnjudgedOf(context, runs, {});
    return proposed;
  }
  const std::vector<int> periods = LikelyPeriods(runs, rows, SetEvidence(rows), context.jobs);
  if (!periods.empty()) rows = runs.MakeRows(periods);
  proposed.remarks = RemarksOn(runs);
  RefineLeaders(&runs, &rows, context.jobs);
  const SetEvidence evidence(rows);
  SetScores scores = ScanSets(evidence, context.jobs);
  proposed.weights = WeighExplanations(&scores, context.seed);
  const ExplanationWeights named = WeighExplanations(&scores, context.seed, false);
  proposed.said.weights = SaidOf(proposed.weights, named);
  proposed.scores = scores.BestFirst();
  const double nothing = scores.Score({});
  for (ScoredSet& one : proposed.scores) one.score -= nothing;
  proposed.said.unlikely = UnlikelyEffects(proposed.scores);
  // What does as another value does is no finding of whole runs either.
  for (const auto& [effect, value] : runs.doubles()) proposed.said.unlikely.push_back(EffectOf(effect));
  proposed.unjudged = UnjudgedOf(context, runs, evidence.names());
  const std::set<std::string> oil = runs.OilOnly();
  for (const ChangeSet& set : oil.empty() ? SetsToPropose(named, proposed.weights, proposed.scores)
                                          : SetsWithout(oil, proposed.weights)) {
    if (proposed.proposals.size() >= kMostProposals) break;
    const RefinedShapes shaped(&runs, rows, set);
    const SetEvidence own = shaped.any() ? SetEvidence(shaped.rows()) : evidence;
    const Rows& own_rows = shaped.any() ? shaped.rows() : rows;
    const SetFit fit = own.Fit(set);
    std::optional<EstimatedModel> estimated = ModelOf(runs, own_rows, set, fit);
    if (estimated) AtLikeliestScale(context.given, &*estimated);
    if (!estimated || IsImpossible(own_rows, set, fit) || HasTwoOfAKind(estimated->model)) continue;
    if (set.empty()) proposed.shown = Shown(rows, *estimated, allowed);
    Proposal proposal{*estimated,
                      {},
                      fit.log_evidence - own.Log({}) + scores.odds().LogOdds(set),
                      WeightOf(HasCurve(set) ? proposed.weights : named, set)};
    if (context.held_out.empty() && context.runs.size() > 1) {
      for (size_t r = 0; r < context.runs.size(); ++r) {
        const SetEvidence others = own.Without({r});
        const bool shown = others.Shows(set);
        const ChangeSet left = shown ? set : ChangeSet{};
        std::optional<EstimatedModel> without = ModelOf(runs, own_rows, left, others.Fit(left));
        if (without) AtLikeliestScale(context.given, &*without);
        proposal.without.push_back(without && shown ? without->model : estimated->model);
      }
    }
    proposal.by_run = ParametersByRun(set);
    if (!proposal.by_run.empty())
      proposal.without = ModelsOfRuns(context, allowed, proposal.model, proposal.by_run);
    for (const std::string& sensor : inverted) Invert(sensor, &proposal);
    if (const std::optional<Proposal> alone = OneValueAlone(context, allowed, set, proposal))
      proposed.proposals.push_back(*alone);
    proposed.proposals.push_back(std::move(proposal));
  }
  proposed.weights = AsOneClass(oil, std::move(proposed.weights));
  return proposed;
}

Proposal WithOwnValues(const ProofContext& context, const std::vector<size_t>& allowed,
                       const std::string& parameter, const Proposed& proposed) {
  Proposal proposal;
  proposal.model = context.given;
  proposal.base = {model::BasePlace(parameter)};
  proposal.weight = WeightOf(proposed.weights, {"run." + parameter});
  proposal.by_run = {parameter};
  proposal.without = ModelsOfRuns(context, allowed, context.given, proposal.by_run);
  return proposal;
}

}  // namespace hydro::diagnose
