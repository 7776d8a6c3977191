// A small search on a rig: a fitted run, one held out, three candidates.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnose/search/wide_search.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {

struct SmallSearch {
  std::vector<diagnose::RunData> runs, held_out;
  diagnose::SearchContext context;
  diagnose::SearchResult search;
  std::vector<std::string> stages;

  explicit SmallSearch(const model::ModelDescription& truth) {
    runs = ClampedPair(truth, 0.5, 5);
    held_out.push_back(std::move(runs.back()));
    runs.pop_back();
    context.given = Table1With();
    context.runs = PointersTo(runs);
    context.held_out = PointersTo(held_out);
    context.sizes = diagnose::SizesOf(context.given, context.runs);
    context.changes = {{"pump.quadratic_drag", {}, ""}, {"valve.relief", {}, ""}, {"", {}, "beta"}};
    context.report_progress = [this](const diagnose::Progress& progress) {
      stages.push_back(progress.stage);
    };
    diagnose::Hypothesis given;
    given.model = context.given;
    const std::vector<model::StartState> starts = diagnose::MeasuredStarts(context.runs);
    search.given = search.best = diagnose::Explain(context, given, starts, diagnose::FineFit(1));
    for (const diagnose::Change& change : context.changes) Try(given, change, starts);
  }

  // As where no windows can be cut: whole runs decide. The refit is the model as given.
  diagnose::WideSearch Found() const { return {search, search.given, {}}; }

 private:
  // Fits the change from each of its starts, and takes the best fit.
  void Try(const diagnose::Hypothesis& given, const diagnose::Change& change,
           const std::vector<model::StartState>& starts) {
    diagnose::Explanation best;
    for (const diagnose::Hypothesis& start : diagnose::With(given, change, context.sizes, false)) {
      diagnose::Explanation one = diagnose::Explain(context, start, starts, diagnose::FineFit(1));
      if (!one.fitted.ok()) continue;
      if (best.held_out.gaps.empty() || one.squared_gap() < best.squared_gap()) best = std::move(one);
    }
    search.rated.push_back({change, search.given.squared_gap() - best.squared_gap(), ""});
    search.tried.push_back(best);
    if (diagnose::Material(search.best.held_out_gap(), best.held_out_gap())) search.best = std::move(best);
  }
};

// On a rig with a drag that its model lacks.
inline SmallSearch& OfADrag() {
  static SmallSearch small(Table1With({{"pump.quadratic_drag", {{"k", 2e-4}}, {}}}));
  return small;
}

}  // namespace hydro::testing
