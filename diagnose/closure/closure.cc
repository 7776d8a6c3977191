#include "diagnose/closure/closure.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "diagnose/closure/closure_band.h"
#include "diagnose/closure/closure_search.h"
#include "diagnose/closure/curve_start.h"
#include "diagnose/closure/resemblance.h"
#include "diagnose/search/window_search.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kBasesTried = 2;  // of those that the search fitted to windows

bool IsClosure(const model::EffectDescription& effect) { return effect.id.starts_with("closure."); }

bool Has(const model::ModelDescription& model, const std::string& id) {
  return std::any_of(model.effects.begin(), model.effects.end(),
                     [&id](const model::EffectDescription& effect) { return effect.id == id; });
}

size_t EffectsOf(const Explanation& one) {
  return static_cast<size_t>(std::count_if(one.changes().begin(), one.changes().end(),
                                           [](const Change& change) { return !change.effect.empty(); }));
}

bool HaveSameEffects(const Explanation& one, const Explanation& other) {
  const bool in_both =
      std::all_of(one.changes().begin(), one.changes().end(), [&other](const Change& change) {
        return change.effect.empty() || other.fitted.hypothesis.Has(change);
      });
  return in_both && EffectsOf(one) == EffectsOf(other);
}

// Every other run, from `first` on.
std::vector<const RunData*> EveryOther(const std::vector<const RunData*>& runs, size_t first) {
  std::vector<const RunData*> some;
  for (size_t r = first; r < runs.size(); r += 2) some.push_back(runs[r]);
  return some;
}

Closure Describe(const Fitted& fitted, const std::vector<PossibleTerm>& possible,
                 const model::EffectDescription& effect, const std::vector<const RunData*>& windows) {
  Closure closure;
  closure.id = effect.id;
  closure.against = effect.name_lists.at("against");
  closure.knots.push_back(effect.lists.at("knots"));
  if (closure.against.size() == 2) closure.knots.push_back(effect.lists.at("knots_2"));
  closure.value = ValuesOf(effect);
  for (const std::string& name : closure.against) {
    for (const PossibleTerm& term : possible) {
      if (term.table.against != name) continue;
      closure.against_units.push_back(term.table.against_unit);
      break;
    }
  }
  for (const PossibleTerm& term : possible) {
    if ("closure." + term.table.balance == effect.id) closure.unit = term.table.unit;
  }
  SetBand(fitted, windows, &closure);
  closure.resembles = Resemblance(closure);
  return closure;
}

}  // namespace

ClosureBase BaseOfClosure(const SearchContext& context, const Explanation& best, const Explanation& refit,
                          const WindowTrials& trials) {
  std::vector<const Explanation*> likely;
  for (const Explanation& one : trials.tried) {
    if (one.fitted.ok() && !one.held_out.gaps.empty() && HaveSameEffects(one, best)) likely.push_back(&one);
  }
  std::stable_sort(likely.begin(), likely.end(), [](const Explanation* a, const Explanation* b) {
    return a->held_out_gap() < b->held_out_gap();
  });
  likely.resize(std::min(likely.size(), kBasesTried));
  if (refit.fitted.ok() && HaveSameEffects(refit, best)) likely.push_back(&refit);
  const ClosureWindows windows = WindowsOfRuns(context.runs, SearchHorizon(context.runs),
                                               context.given.parameters, kJudgingWindows, 1, 2);
  const Explanation* base = &best;
  std::vector<double> gaps = GapsOf(best.fitted.hypothesis.model, windows, context.jobs);
  for (const Explanation* one : likely) {
    std::vector<double> others = GapsOf(one->fitted.hypothesis.model, windows, context.jobs);
    const auto [had, has] = Compare(gaps, others);
    if (!(has < had)) continue;
    base = one;
    gaps = std::move(others);
  }
  return {base, base != &best};
}

ClosedModel FindClosure(const SearchContext& context, const ClosureBase& base,
                        const std::vector<PossibleTerm>& possible) {
  const Hypothesis& hypothesis = base.explanation->fitted.hypothesis;
  const double seconds = SearchHorizon(context.runs);
  const bool in_turn = context.held_out.empty();
  const std::vector<const RunData*> fitted = in_turn ? EveryOther(context.runs, 0) : context.runs;
  const std::vector<const RunData*> held_out = in_turn ? EveryOther(context.runs, 1) : context.held_out;
  std::vector<PossibleTerm> open = possible;  // not those of balances that the model given has closed
  std::erase_if(open, [&hypothesis](const PossibleTerm& term) {
    return Has(hypothesis.model, "closure." + term.table.balance);
  });
  if (open.empty() || held_out.empty()) return {};
  ClosureSearch search(context, hypothesis, fitted, seconds);
  const std::optional<Fitted> found = search.Find(open);
  if (!found.has_value() || !found->ok()) return {};

  const ClosureWindows proof =
      WindowsOfRuns(held_out, seconds, hypothesis.model.parameters, kJudgingWindows, 0, 1);
  const std::pair<double, double> gaps = Compare(GapsOf(search.base(), proof, context.jobs),
                                                 GapsOf(found->hypothesis.model, proof, context.jobs));
  if (!Worthwhile(gaps)) return {};
  ClosedModel closed;
  closed.model = found->hypothesis.model;
  for (const model::EffectDescription& effect : closed.model.effects) {
    if (!IsClosure(effect) || Has(hypothesis.model, effect.id)) continue;
    Closure closure = Describe(*found, open, effect, search.windows());
    closure.before = std::sqrt(gaps.first);
    closure.after = std::sqrt(gaps.second);
    closure.seconds = seconds;
    closure.on_refit = base.other_values;
    closed.closures.push_back(std::move(closure));
  }
  return closed;
}

}  // namespace hydro::diagnose
