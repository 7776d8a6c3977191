#include "diagnose/evidence/estimated_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "diagnose/evidence/estimated_closure.h"
#include "diagnose/fit/closure.h"
#include "diagnose/fit/hypothesis.h"
#include "model/effects/catalogue.h"

namespace hydro::diagnose {
namespace {

using model::Parameters;
using MeaningKind = ColumnMeaning::Kind;

// No value is estimated below this part of the given value: that would be another machine.
constexpr double kLeastPart = 0.05;
// The step along a whole effect's shape by which its size is seen to change.
constexpr double kMoveStep = 0.1;

// Whether any balance of the runs has the column. A column that no balance has may still seem to move,
// together with others that share its yardstick.
bool Acts(const Rows& rows, int column) {
  return std::ranges::any_of(rows.blocks, [&](const RowBlock& block) {
    const auto found = std::ranges::lower_bound(block.columns, column);
    if (found == block.columns.end() || *found != column) return false;
    return block.X.col(found - block.columns.begin()).squaredNorm() > 0;
  });
}

// Runs show a value if they shrink its interval at least to this part of its former width.
constexpr double kShown = 0.9;

// The sum of the amounts of all columns of a base parameter that hold for all runs.
struct ValueMove {
  double amount = 0;
  Eigen::VectorXd columns;  // of the fit: 1 for those that are summed

  double Deviation(const SetFit& fit) const {
    return std::sqrt(std::max(0.0, columns.dot(fit.covariance * columns)));
  }
};

// For the parameters that the runs show.
std::map<size_t, ValueMove> MovesOf(const ScanRuns& runs, const Rows& rows, const SetFit& fit) {
  std::map<size_t, ValueMove> moves;
  for (size_t i = 0; i < fit.columns.size(); ++i) {
    const ColumnMeaning& meaning = runs.meaning()[static_cast<size_t>(fit.columns[i])];
    if (meaning.kind != MeaningKind::kBase || meaning.run >= 0) continue;
    const auto place = static_cast<Eigen::Index>(i);
    if (!Acts(rows, fit.columns[i])) continue;
    const double before = rows.prior(fit.columns[i], fit.columns[i]);
    if (fit.covariance(place, place) < kShown * kShown * before ||
        !rows.columns[static_cast<size_t>(fit.columns[i])].set.empty()) {
      ValueMove& move =
          moves.try_emplace(meaning.base, ValueMove{0, Eigen::VectorXd::Zero(fit.amounts.size())})
              .first->second;
      move.amount += fit.amounts[place] * meaning.unit;
      move.columns[place] = meaning.unit;
    }
  }
  return moves;
}

// Whether any balance of the runs has a column of this value: a held arm shows nothing about its area.
bool IsSeen(const ScanRuns& runs, const Rows& rows, double Parameters::*member) {
  for (size_t i = 0; i < runs.meaning().size(); ++i) {
    const ColumnMeaning& meaning = runs.meaning()[i];
    const bool is_it =
        meaning.kind == MeaningKind::kBase && model::BaseParameters()[meaning.base].member == member;
    if (is_it && Acts(rows, static_cast<int>(i))) return true;
  }
  return false;
}

// In the flows everything is measured by D w, so a displacement that the torques show scales the other flows
// that the runs show.
void ScaleFlows(const ScanRuns& runs, const Rows& rows, double by, Parameters* p) {
  if (IsSeen(runs, rows, &Parameters::beta)) p->beta /= by;
  for (double Parameters::*member : {&Parameters::c, &Parameters::c_E, &Parameters::c_I}) {
    if (IsSeen(runs, rows, member)) p->*member *= by;
  }
}

void SetBase(const ScanRuns& runs, const Rows& rows, const SetFit& fit, EstimatedModel* estimated) {
  Parameters& p = estimated->model.parameters;
  const Parameters given = p;
  for (const auto& [base, move] : MovesOf(runs, rows, fit)) {
    const model::BaseParameter& parameter = model::BaseParameters()[base];
    const double before = given.*parameter.member;
    double value = before != 0 ? before * std::max(kLeastPart, 1 + move.amount) : move.amount;
    value = std::clamp(value, parameter.info.min, parameter.info.max);
    p.*parameter.member = value;
    estimated->base.push_back(base);
    estimated->deviation[base] = move.Deviation(fit);
  }
  const double displacement = given.D != 0 ? p.D / given.D : 1;
  if (displacement != 1) ScaleFlows(runs, rows, displacement, &p);
}

double Bounded(const model::ParameterInfo& info, double value) {
  const double above = std::max(kAboveTheLeast * std::abs(info.min), std::numeric_limits<double>::min());
  const double least = info.min_allowed ? info.min : info.min + above;
  return std::clamp(value, least, info.max);
}

// Sets the numbers of the model's own effects.
void SetGivenEffects(const ScanRuns& runs, const SetFit& fit, EstimatedModel* estimated) {
  std::map<size_t, double> amounts;
  for (size_t i = 0; i < fit.columns.size(); ++i) {
    const ColumnMeaning& meaning = runs.meaning()[static_cast<size_t>(fit.columns[i])];
    if (meaning.kind == MeaningKind::kGiven)
      amounts[meaning.base] += fit.amounts[static_cast<Eigen::Index>(i)];
  }
  const std::vector<model::EffectParameter> all = model::EffectParameters(runs.setup().given);
  for (const auto& [place, amount] : amounts) {
    double& value = all[place].In(&estimated->model);
    const model::ParameterInfo& info =
        ParameterOf(estimated->model.effects[all[place].effect], all[place].name);
    const bool phase = info.role == model::Role::kPhase;
    value = Bounded(info, phase ? value + amount : value * std::max(kLeastPart, 1 + amount));
  }
}

// The size of the variant's series at another shape, relative to its size at the grid point.
double SizeAt(const ScanRuns& runs, const EffectVariant& variant, const std::string& parameter,
              double value) {
  model::ModelDescription with = runs.setup().given;
  model::EffectDescription effect = variant.at;
  effect.parameters[parameter] = value;
  with.effects.push_back(effect);
  double sum = 0;
  for (size_t r = 0; r < runs.motions().size(); ++r) {
    const BalanceSeries change = Beyond(with, runs.motions()[r], runs.base()[r]);
    for (size_t b = 0; b < kBalanceKinds; ++b) {
      const double size = runs.setup().sizes.of[b];
      if (change[b].size() > 0 && size > 0) sum += change[b].squaredNorm() / (size * size);
    }
  }
  return std::sqrt(sum);
}

// The shape at which the whole effect is as large as estimated.
void MoveWhole(const ScanRuns& runs, const EffectVariant& variant, double amount,
               model::EffectDescription* effect) {
  if (variant.shapes.empty()) return;
  const std::string& shape = variant.shapes.front();
  const double at = variant.at.parameters.at(shape);
  const double here = SizeAt(runs, variant, shape, at),
               there = SizeAt(runs, variant, shape, at * (1 + kMoveStep));
  if (!(here > 0) || !(there > 0) || !(amount > 0)) return;
  // A time acts in proportion. Where the series grows more slowly, the balances' filters pass only part of
  // it.
  const bool is_time = ParameterOf(*effect, shape).role == model::Role::kTime;
  const double slope = is_time ? 1 : std::log(there / here) / std::log(1 + kMoveStep);
  if (std::abs(slope) < kMoveStep) return;
  const double move = std::clamp(std::pow(amount, 1 / slope), 1 / kGridRatio, kGridRatio);
  effect->parameters[shape] = Bounded(ParameterOf(*effect, shape), at * move);
}

// Takes the amplitude from all runs and the phase from the first, where the shaft's angle counts.
void SetWave(const EffectVariant& variant, const std::string& set,
             const std::map<int, std::pair<double, double>>& parts, model::EffectDescription* effect) {
  double sum = 0;
  for (const auto& [run, part] : parts) sum += std::hypot(part.first, part.second);
  const double amplitude = parts.empty() ? 0 : sum / static_cast<double>(parts.size());
  const double periods = std::stod(set.substr(set.find('|') + 1));
  const std::pair<double, double> first = parts.empty() ? std::pair{0.0, 0.0} : parts.begin()->second;
  const model::CatalogueEntry* entry = model::FindCatalogueEntry(variant.at.id);
  for (const model::ParameterInfo& info : entry->info.parameters) {
    const bool wave = info.role == model::Role::kTorqueWave || info.role == model::Role::kDisplacementWave;
    if (wave) effect->parameters[info.name] = Bounded(info, amplitude);
    if (info.role == model::Role::kPeriods) effect->parameters[info.name] = periods;
    if (info.role == model::Role::kPhase)
      effect->parameters[info.name] = std::atan2(first.second, first.first);
  }
}

// The effect of that name in the set, with its amounts.
void AddEffect(const ScanRuns& runs, const Rows& rows, const std::string& name, const SetFit& fit,
               EstimatedModel* estimated) {
  std::optional<size_t> v;
  std::map<int, std::pair<double, double>> wave;
  std::map<std::string, double> amounts, moved;
  double whole = 1;
  for (size_t i = 0; i < fit.columns.size(); ++i) {
    const auto column = static_cast<size_t>(fit.columns[i]);
    if (rows.columns[column].set != name) continue;
    const ColumnMeaning& meaning = runs.meaning()[column];
    const double amount = fit.amounts[static_cast<Eigen::Index>(i)] * meaning.unit;
    v = meaning.variant;
    if (meaning.kind == MeaningKind::kEffect) amounts[meaning.parameter] = amount;
    if (meaning.kind == MeaningKind::kWhole) whole = amount;
    if (meaning.kind == MeaningKind::kMoved) moved[meaning.parameter] = amount;
    if (meaning.kind == MeaningKind::kWave)
      (meaning.parameter == "sin" ? wave[meaning.run].first : wave[meaning.run].second) = amount;
  }
  if (!v) return;
  const EffectVariant& variant = runs.setup().variants[*v];
  model::EffectDescription effect = variant.at;
  if (!variant.phase.empty()) {
    double& sine = amounts[variant.amounts.front()];
    double& cosine = amounts[variant.phase];
    const double phase = std::atan2(cosine, sine);
    sine = std::hypot(sine, cosine);
    cosine = phase;
  }
  for (const auto& [parameter, amount] : amounts)
    effect.parameters[parameter] = Bounded(ParameterOf(effect, parameter), amount);
  // What was moved is part of the whole, so it is relatively larger when there is less of the whole.
  for (const auto& [parameter, amount] : moved) {
    const double by = std::exp(
        std::clamp(amount / std::max(whole, 1 / kGridRatio), -std::log(kGridRatio), std::log(kGridRatio)));
    effect.parameters[parameter] = Bounded(ParameterOf(effect, parameter), effect.parameters[parameter] * by);
  }
  if (variant.kind == EffectVariant::Kind::kWhole) MoveWhole(runs, variant, whole, &effect);
  if (variant.kind == EffectVariant::Kind::kWave) SetWave(variant, name, wave, &effect);
  estimated->model.effects.push_back(std::move(effect));
  estimated->changes.push_back(variant.change);
}

}  // namespace

std::optional<EstimatedModel> ModelOf(const ScanRuns& runs, const Rows& rows, const ChangeSet& set,
                                      const SetFit& fit) {
  EstimatedModel estimated;
  estimated.model = runs.setup().given;
  SetBase(runs, rows, fit, &estimated);
  SetGivenEffects(runs, fit, &estimated);
  for (const std::string& name : set) {
    if (name.starts_with("run.")) continue;
    if (name.starts_with("value.")) {
      estimated.changes.push_back({"", {}, name.substr(name.find('.') + 1)});
    } else if (IsClosureEffect(name)) {
      const std::vector<model::EffectDescription> closures = ClosuresOf(runs, rows, name, fit);
      if (closures.empty()) return std::nullopt;
      for (const model::EffectDescription& closure : closures) {
        estimated.model.effects.push_back(closure);
        estimated.changes.push_back({closure.id, {}, ""});
      }
    } else {
      AddEffect(runs, rows, name, fit, &estimated);
    }
  }
  return estimated;
}

}  // namespace hydro::diagnose
