// A small search on a rig: a fitted run, one held out, three candidates.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnose/search/search.h"
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
    search = diagnose::Search(context, diagnose::Explain(context, given, starts, diagnose::FineFit(1)), {2});
  }
};

// On a rig with a drag that its model lacks.
inline SmallSearch& OfADrag() {
  static SmallSearch small(Table1With({{"pump.quadratic_drag", {{"k", 2e-4}}, {}}}));
  return small;
}

}  // namespace hydro::testing
