#include "diagnose/search/scan.h"

#include <Eigen/Core>
#include <algorithm>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/search/score_test.h"
#include "maths/solve.h"
#include "model/terms/jet.h"

namespace hydro::diagnose {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The parameters at whose starting values a change does nothing: their derivatives are all there is to it.
// Empty for a change that acts already.
std::vector<size_t> Vanishing(const StartingPoint& point) {
  std::vector<size_t> places;
  if (point.moved) return places;
  for (size_t i = 0; i < point.own.size(); ++i) {
    const bool base = point.own[i].unknown.kind == model::Unknown::Kind::kBase;
    if (base || (point.own[i].value == 0 && !point.own[i].logarithmic)) places.push_back(i);
  }
  return places;
}

// A change that already acts at its starting point gets a simulation of its own.
std::vector<RunColumns> SimulateAlone(const Fitted& current, const std::vector<const RunData*>& runs,
                                      const StartingPoint& point) {
  std::vector<RunColumns> columns(runs.size());
  for (size_t r = 0; r < runs.size(); ++r) {
    const Residuals residuals = ResidualsOf(point.with.model, *runs[r], current.runs[r].start, point.own, {});
    const auto rows = static_cast<Index>(residuals.values.size());
    columns[r].values = Map<const VectorXd>(residuals.values.data(), rows);
    columns[r].own =
        Map<const MatrixXd>(residuals.jacobian.data(), rows, static_cast<Index>(point.own.size()));
  }
  return columns;
}

// Several changes that do nothing yet, in one model.
struct Combined {
  model::ModelDescription model;
  std::vector<FreeParameter> vanishing;  // of each change in turn
};

Combined Combine(const model::ModelDescription& given, const std::vector<const StartingPoint*>& points) {
  Combined combined;
  model::ModelDescription& model = combined.model = given;
  for (const StartingPoint* point : points) {
    if (point->own.front().unknown.kind == model::Unknown::Kind::kEffect) {
      model.effects.push_back(point->with.model.effects.back());
    }
  }
  // Where each change's parameters are in the common model, which orders effects by their ids.
  const std::vector<model::EffectParameter> all = model::EffectParameters(model);
  size_t effect = given.effects.size();
  for (const StartingPoint* point : points) {
    const bool adds = point->own.front().unknown.kind == model::Unknown::Kind::kEffect;
    for (const size_t place : Vanishing(*point)) {
      FreeParameter& parameter = combined.vanishing.emplace_back(point->own[place]);
      for (size_t i = 0; adds && i < all.size(); ++i) {
        if (all[i].effect == effect && model.effects[effect].id + "." + all[i].name == parameter.name) {
          parameter.unknown.index = i;
        }
      }
    }
    if (adds) ++effect;
  }
  return combined;
}

// Changes that do nothing yet share one simulation; `columns` gets the results by change. False if they turn
// out to do something after all.
bool SimulateTogether(const Fitted& current, const std::vector<const RunData*>& runs,
                      const std::vector<RunBasis>& bases, const std::vector<const StartingPoint*>& points,
                      std::vector<std::vector<RunColumns>>* columns) {
  const Combined combined = Combine(current.hypothesis.model, points);
  columns->assign(points.size(), std::vector<RunColumns>(runs.size()));
  for (size_t r = 0; r < runs.size(); ++r) {
    const Residuals residuals =
        ResidualsOf(combined.model, *runs[r], current.runs[r].start, combined.vanishing, {}, true);
    const auto rows = static_cast<Index>(residuals.values.size());
    const Map<const VectorXd> values(residuals.values.data(), rows);
    if (!((values - bases[r].values).squaredNorm() < 1e-4 * static_cast<double>(rows))) return false;
    const Map<const MatrixXd> jacobian(residuals.jacobian.data(), rows,
                                       static_cast<Index>(combined.vanishing.size()));
    Index next = 0;
    for (size_t t = 0; t < points.size(); ++t) {
      RunColumns& own = (*columns)[t][r];
      own.values = bases[r].values;
      own.own = MatrixXd::Zero(rows, static_cast<Index>(points[t]->own.size()));
      for (const size_t place : Vanishing(*points[t])) {
        own.own.col(static_cast<Index>(place)) = jacobian.col(next++);
      }
    }
  }
  return true;
}

std::vector<RunBasis> BasesOf(const Fitted& current, const std::vector<const RunData*>& runs,
                              const std::vector<FreeParameter>& known, int jobs) {
  std::vector<RunBasis> bases(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    const std::vector<model::Unknown> starts = StartUnknowns(current.hypothesis.model, *runs[r]);
    const Residuals residuals =
        ResidualsOf(current.hypothesis.model, *runs[r], current.runs[r].start, known, starts);
    const auto rows = static_cast<Index>(residuals.values.size());
    bases[r].columns = Map<const MatrixXd>(residuals.jacobian.data(), rows,
                                           static_cast<Index>(known.size() + starts.size()));
    bases[r].normal = maths::TransposeTimes(bases[r].columns, bases[r].columns);
    bases[r].values = Map<const VectorXd>(residuals.values.data(), rows);
  });
  return bases;
}

// What the change of `point` frees that was not free before.
void FindOwn(const Fitted& current, const std::vector<FreeParameter>& known, StartingPoint* point) {
  for (const FreeParameter& parameter : point->with.Free()) {
    const bool had = std::any_of(known.begin(), known.end(),
                                 [&](const FreeParameter& other) { return other.name == parameter.name; });
    if (had) continue;
    point->own.push_back(parameter);
    point->moved |= parameter.unknown.kind == model::Unknown::Kind::kBase &&
                    parameter.value != current.hypothesis.model.parameters.*
                                           model::BaseParameters()[parameter.unknown.index].member;
  }
}

std::vector<StartingPoint> StartingPoints(const Fitted& current, const std::vector<FreeParameter>& known,
                                          const std::vector<Change>& changes, const Sizes& sizes,
                                          bool elsewhere) {
  std::vector<StartingPoint> points;
  for (size_t c = 0; c < changes.size(); ++c) {
    for (Hypothesis& with : With(current.hypothesis, changes[c], sizes, elsewhere)) {
      StartingPoint& point = points.emplace_back(StartingPoint{c, std::move(with), {}, false});
      FindOwn(current, known, &point);
    }
  }
  return points;
}

// Which starting points are simulated together, and which one by one.
struct Passes {
  std::vector<std::vector<size_t>> groups;
  std::vector<size_t> single;
};

// Changes that do nothing at their starting point share simulations, as many as fit the directions of one
// pass.
Passes Group(const std::vector<StartingPoint>& points) {
  Passes passes;
  size_t directions = 0;
  for (size_t t = 0; t < points.size(); ++t) {
    const size_t own = Vanishing(points[t]).size();
    if (own == 0) {
      passes.single.push_back(t);
      continue;
    }
    if (passes.groups.empty() || directions + own > static_cast<size_t>(model::kJetWidth)) {
      passes.groups.emplace_back();
      directions = 0;
    }
    passes.groups.back().push_back(t);
    directions += own;
  }
  return passes;
}

// Tests all starting points against one fit.
class Scanner {
 public:
  Scanner(const Fitted& current, const std::vector<const RunData*>& runs, const std::vector<Change>& changes,
          const Sizes& sizes, bool elsewhere, int jobs)
      : current_(current),
        runs_(runs),
        known_(current.hypothesis.Free()),
        prior_(KnownBefore(current.hypothesis)),
        bases_(BasesOf(current, runs, known_, jobs)),
        points_(StartingPoints(current, known_, changes, sizes, elsewhere)),
        scanned_(points_.size()) {}

  void Run(int jobs) {
    const Passes passes = Group(points_);
    ParallelFor(passes.groups.size() + passes.single.size(), jobs, [&](size_t i) {
      if (i < passes.groups.size()) return TestTogether(passes.groups[i]);
      TestAlone(passes.single[i - passes.groups.size()]);
    });
  }

  // The results by change, best first.
  std::vector<std::vector<Scanned>> ByChange(const std::vector<Change>& changes) {
    std::vector<std::vector<Scanned>> by_change(changes.size());
    for (size_t t = 0; t < points_.size(); ++t) {
      scanned_[t].change = changes[points_[t].change];
      by_change[points_[t].change].push_back(std::move(scanned_[t]));
    }
    for (auto& rows : by_change) {
      std::stable_sort(rows.begin(), rows.end(),
                       [](const Scanned& a, const Scanned& b) { return a.expected > b.expected; });
    }
    return by_change;
  }

 private:
  void TestAlone(size_t t) {
    try {
      scanned_[t] = ScoreTest(bases_, known_, prior_, points_[t], SimulateAlone(current_, runs_, points_[t]));
    } catch (const model::ModelError& error) {
      scanned_[t].failure = error.what();
      scanned_[t].start = points_[t].with;
    }
  }

  void TestTogether(const std::vector<size_t>& group) {
    std::vector<const StartingPoint*> members;
    members.reserve(group.size());
    for (const size_t t : group) members.push_back(&points_[t]);
    std::vector<std::vector<RunColumns>> columns;
    bool together = false;
    try {
      together = SimulateTogether(current_, runs_, bases_, members, &columns);
      for (size_t m = 0; together && m < members.size(); ++m) {
        scanned_[group[m]] = ScoreTest(bases_, known_, prior_, *members[m], columns[m]);
      }
    } catch (const model::ModelError&) {
      together = false;  // one of them cannot be simulated; trying each alone shows which
    }
    if (!together) {
      for (const size_t t : group) TestAlone(t);
    }
  }

  const Fitted& current_;
  const std::vector<const RunData*>& runs_;
  std::vector<FreeParameter> known_;
  Prior prior_;
  std::vector<RunBasis> bases_;
  std::vector<StartingPoint> points_;
  std::vector<Scanned> scanned_;
};

}  // namespace

std::vector<std::vector<Scanned>> Scan(const Fitted& current, const std::vector<const RunData*>& runs,
                                       const std::vector<Change>& changes, const Sizes& sizes, bool elsewhere,
                                       int jobs) {
  Scanner scanner(current, runs, changes, sizes, elsewhere, jobs);
  scanner.Run(jobs);
  return scanner.ByChange(changes);
}

}  // namespace hydro::diagnose
