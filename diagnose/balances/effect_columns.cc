// Columns of the catalogue's effects, from their own equations.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/maths/spread.h"
#include "diagnose/balances/column_maker.h"

namespace hydro::diagnose {
namespace {

using VariantKind = EffectVariant::Kind;

// Transducers err by about this part of what they read.
constexpr double kReadingPart = 0.02;
// s: filters and buses of recorders add a few milliseconds.
constexpr double kReadingTime = 3e-3;
// The step over which derivatives by such parameters are taken.
constexpr double kMovedStep = 0.05;
// As a fraction of a balance's size: a difference with an amount that causes such a small change is as good
// as a derivative.
constexpr double kSmallChange = 1e-4;

model::ModelDescription With(const model::ModelDescription& given, const model::EffectDescription& effect) {
  model::ModelDescription with = given;
  with.effects.push_back(effect);
  return with;
}

// An amount that is practically zero; for a time, part of a sample.
double Probe(const EffectVariant& variant, const RunMotion& run) {
  return variant.is_time ? 0.25 * run.step : 1e-3;
}

model::EffectDescription AtAmount(const EffectVariant& variant, const std::string& parameter, double amount,
                                  double others) {
  model::EffectDescription effect = variant.at;
  for (const std::string& one : variant.amounts) effect.parameters[one] = one == parameter ? amount : others;
  if (parameter == variant.phase) {
    effect.parameters[variant.amounts.front()] = amount;
    effect.parameters[variant.phase] = std::numbers::pi / 2;
  }
  return effect;
}

// How an effect acts: only on the balances, on states of its own, or on readings.
enum class Way { kPlain, kWithMemory, kReading };

Way WayOf(const ColumnMaker& maker, const EffectVariant& variant) {
  Way way = Way::kPlain;
  for (const RunMotion& run : *maker.runs) {
    model::EffectDescription effect = variant.at;
    for (const std::string& one : variant.amounts) effect.parameters[one] = Probe(variant, run);
    const model::ModelDescription with = With(maker.setup->given, effect);
    // A run in which the signal is not measured, or stands still, says nothing.
    RunMotion begin = run;
    begin.at.resize(std::min<size_t>(begin.at.size(), 64));
    for (size_t k = 0; k < begin.at.size(); ++k) {
      model::KnownMotion& at = begin.at[k];
      at.p1_rate = at.p2_rate = at.motor_acceleration = at.motor_speed = at.arm_speed = 1;
      at.p1 = at.p2 = at.motor_angle = 1 + static_cast<double>(k) * run.step;
    }
    for (const std::vector<double>& of : ErrorsOf(with, begin).of) {
      if (!of.empty()) return Way::kReading;
    }
    if (model::BalanceEquations(with, run.options).remembers()) way = Way::kWithMemory;
  }
  return way;
}

// Columns that one evaluation with derivatives computes together.
struct Together {
  std::vector<size_t> variants;
  std::vector<int> columns;  // of all amounts of the variants, in order
  int switches = 0;
};

// The series of an amount of an effect that has states, computed from a change that is small compared with
// the balances.
void PutWithMemory(ColumnMaker* maker, size_t v, const std::string& parameter, int column, size_t run) {
  const EffectVariant& variant = maker->setup->variants[v];
  double amount = Probe(variant, maker->Motion(run));
  for (int pass = 0; pass < 2; ++pass) {
    const model::ModelDescription with = With(maker->setup->given, AtAmount(variant, parameter, amount, 0));
    const BalanceSeries change = Beyond(with, maker->Motion(run), (*maker->base)[run]);
    double largest = 0;
    for (size_t b = 0; b < kBalanceKinds; ++b) {
      if (change[b].size() == 0 || !(maker->setup->sizes.of[b] > 0)) continue;
      largest = std::max(largest, change[b].cwiseAbs().maxCoeff() / maker->setup->sizes.of[b]);
    }
    if (!(largest > 0) || !std::isfinite(largest)) return;
    if (pass == 1 || variant.is_time) return maker->Put(column, run, change, 1 / amount);
    // An effect that hardly acts in this run must not leave the range in which it means something.
    const model::ParameterInfo& info = ParameterOf(variant.at, parameter);
    amount = std::min(amount * kSmallChange / largest, 0.5 * info.max);
  }
}

// Evaluates the model once with all these effects, at amounts of 0.
void PutTogether(ColumnMaker* maker, const Together& together, size_t run) {
  model::ModelDescription model = maker->setup->given;
  struct Place {
    std::string id, parameter;
    size_t effect;
  };
  std::vector<Place> wanted;
  for (const size_t v : together.variants) {
    const EffectVariant& variant = maker->setup->variants[v];
    const size_t own = model.effects.size();
    model.effects.push_back(variant.at);
    for (const std::string& amount : variant.amounts) {
      const bool cosine = amount == variant.phase;
      wanted.push_back(
          {variant.at.id, cosine ? variant.amounts.front() : amount, cosine ? model.effects.size() : own});
      if (cosine) model.effects.push_back(AtAmount(variant, amount, 0, 0));
    }
  }
  const std::vector<model::EffectParameter> all = model::EffectParameters(model);
  std::vector<model::Unknown> unknowns;
  for (const Place& place : wanted) {
    for (size_t i = 0; i < all.size(); ++i) {
      if (all[i].effect == place.effect && all[i].name == place.parameter)
        unknowns.push_back({model::Unknown::Kind::kEffect, i});
    }
  }
  const std::vector<BalanceSeries> series = DerivativesOf(model, maker->Motion(run), unknowns);
  for (size_t u = 0; u < series.size(); ++u) maker->Put(together.columns[u], run, series[u]);
  if (!series.empty()) return;
  // Some of the effects change the motor's torque, which only a change of the whole model shows, and they
  // hide the others.
  size_t next = 0;
  for (const size_t v : together.variants) {
    const std::vector<std::string>& amounts = maker->setup->variants[v].amounts;
    const auto from = together.columns.begin() + static_cast<std::ptrdiff_t>(next);
    const std::vector<int> columns(from, from + static_cast<std::ptrdiff_t>(amounts.size()));
    next += amounts.size();
    if (together.variants.size() > 1) {
      PutTogether(maker, {{v}, columns, together.switches}, run);
      continue;
    }
    for (size_t a = 0; a < amounts.size(); ++a) PutWithMemory(maker, v, amounts[a], columns[a], run);
  }
}

// An effect that only scales k_2 dp, by which the arm's whole balance is measured, is written as growth of
// the remaining terms: a yardstick that shrinks would make every residual small.
void KeepTheArmsYardstick(const ColumnMaker& maker, size_t run, BalanceSeries* change) {
  constexpr double kOnlyScales = 0.99;
  constexpr auto kArm = static_cast<size_t>(BalanceKind::kArm);
  Eigen::VectorXd& arm = (*change)[kArm];
  if (arm.size() == 0) return;
  const RunMotion& motion = maker.Motion(run);
  Eigen::VectorXd push(arm.size());
  for (Eigen::Index i = 0; i < push.size(); ++i) {
    const model::KnownMotion& at = motion.at[static_cast<size_t>(i) * motion.stride];
    push[i] = maker.given().k_2 * (at.p2 - at.p1);
  }
  const double along = arm.dot(push), size = push.squaredNorm();
  if (!(along * along > kOnlyScales * kOnlyScales * size * arm.squaredNorm())) return;
  arm -= along / size * (*maker.base)[run].left[kArm];
}

// The series of an amount of a sensor's effect, and the resulting error of the signal.
void PutReading(ColumnMaker* maker, size_t v, const std::string& parameter, int column, size_t run) {
  const EffectVariant& variant = maker->setup->variants[v];
  const RunMotion& motion = maker->Motion(run);
  const double amount = Probe(variant, motion);
  const double others = variant.is_time ? amount : 0;
  SignalErrors errors =
      ErrorsOf(With(maker->setup->given, AtAmount(variant, parameter, amount, others)), motion);
  for (std::vector<double>& of : errors.of) {
    for (double& error : of) error /= amount;
  }
  BalanceSeries change = ReadingColumn(*maker, run, errors);
  KeepTheArmsYardstick(*maker, run, &change);
  maker->Put(column, run, change);
}

// The unit of a sensor effect's amount: the usual part of the signals' range.
double ReadingUnit(const ColumnMaker& maker, const EffectVariant& variant, const std::string& parameter) {
  if (variant.is_time) return kReadingTime;
  double unit = 0;
  for (const RunMotion& run : *maker.runs) {
    const double amount = Probe(variant, run);
    const SignalErrors errors =
        ErrorsOf(With(maker.setup->given, AtAmount(variant, parameter, amount, 0)), run);
    for (size_t s = 0; s < kGridChannels; ++s) {
      if (errors.of[s].empty() || !run.signals[s].measured()) continue;
      double sum = 0;
      for (const double error : errors.of[s]) sum += error * error;
      const double size = std::sqrt(sum / static_cast<double>(run.size())) / amount;
      const double range = maths::RangeOf(run.signals[s].values).size();
      unit = std::max(unit, kReadingPart * range / size);
    }
  }
  return unit;
}

// Adds an effect as a whole, and its derivatives by the logarithms of parameters without a grid.
void PutWhole(ColumnMaker* maker, size_t v, const std::vector<int>& columns, size_t run) {
  const EffectVariant& variant = maker->setup->variants[v];
  const RunMotion& motion = maker->Motion(run);
  const BaseSeries& base = (*maker->base)[run];
  const BalanceSeries whole = Beyond(With(maker->setup->given, variant.at), motion, base);
  maker->Put(columns[0], run, whole);
  for (size_t m = 0; m < variant.moved.size(); ++m) {
    model::EffectDescription moved = variant.at;
    moved.parameters[variant.moved[m]] *= std::exp(kMovedStep);
    BalanceSeries change = Beyond(With(maker->setup->given, moved), motion, base);
    for (size_t b = 0; b < kBalanceKinds; ++b) change[b] -= whole[b];
    maker->Put(columns[m + 1], run, change, 1 / kMovedStep);
  }
}

// Copies series that do not depend on the sensors: more noise does not change them.
void CopySeries(ColumnMaker* maker, const std::vector<int>& columns, size_t run) {
  for (size_t b = 0; b < kBalanceKinds; ++b) {
    for (const int column : columns) {
      const auto& clean = maker->again->series[run][b];
      const auto found = clean.find(column);
      if (found != clean.end()) maker->table.series[run][b][column] = found->second;
    }
  }
}

// Adds a column for each amount of a variant.
std::vector<int> AddAmounts(ColumnMaker* maker, size_t v, Way way) {
  const EffectVariant& variant = maker->setup->variants[v];
  std::vector<int> columns;
  const bool first = maker->setup->units.empty();
  for (const std::string& amount : variant.amounts) {
    const bool positive = ParameterOf(variant.at, amount).min >= 0;
    ColumnMeaning meaning{.kind = ColumnMeaning::Kind::kEffect, .variant = v, .parameter = amount, .unit = 0};
    if (way == Way::kReading && first) meaning.unit = ReadingUnit(*maker, variant, amount);
    columns.push_back(maker->Add({variant.set + ":" + amount, variant.set, 1, positive}, meaning));
  }
  return columns;
}

}  // namespace

void AddEffectColumns(ColumnMaker* maker) {
  std::vector<Together> groups;
  const std::vector<EffectVariant>& variants = maker->setup->variants;
  for (size_t v = 0; v < variants.size(); ++v) {
    const EffectVariant& variant = variants[v];
    if (variant.kind == VariantKind::kWave) continue;
    if (variant.kind == VariantKind::kWhole) {
      ColumnMeaning meaning{.kind = ColumnMeaning::Kind::kWhole, .variant = v};
      std::vector<int> columns = {maker->Add({variant.set + ":whole", variant.set, 1, true}, meaning)};
      meaning.kind = ColumnMeaning::Kind::kMoved;
      for (const std::string& moved : variant.moved) {
        meaning.parameter = moved;
        columns.push_back(maker->Add({variant.set + ":" + moved, variant.set, kFarOff, false}, meaning));
      }
      if (maker->again != nullptr &&
          DependsOnCommandAlone(With(maker->setup->given, variant.at), maker->Motion(0), (*maker->base)[0])) {
        maker->works.back().push_back([maker, columns](size_t run) { CopySeries(maker, columns, run); });
        continue;
      }
      maker->works.back().push_back([maker, v, columns](size_t run) { PutWhole(maker, v, columns, run); });
      continue;
    }
    const Way way = WayOf(*maker, variant);
    const std::vector<int> columns = AddAmounts(maker, v, way);
    if (way != Way::kPlain) {
      for (size_t a = 0; a < columns.size(); ++a) {
        maker->works.back().push_back([maker, v, way, a, columns](size_t run) {
          const std::string& amount = maker->setup->variants[v].amounts[a];
          if (way == Way::kReading) return PutReading(maker, v, amount, columns[a], run);
          PutWithMemory(maker, v, amount, columns[a], run);
        });
      }
      continue;
    }
    const int switches = model::Equations(With(maker->setup->given, variant.at), {}).switches();
    const size_t most = model::kJetWidth;
    if (groups.empty() || groups.back().columns.size() + columns.size() > most ||
        groups.back().switches + switches > model::kMaxEffectSwitches) {
      groups.emplace_back();
    }
    groups.back().variants.push_back(v);
    groups.back().columns.insert(groups.back().columns.end(), columns.begin(), columns.end());
    groups.back().switches += switches;
  }
  for (const Together& together : groups) {
    maker->works.back().push_back([maker, together](size_t run) { PutTogether(maker, together, run); });
  }
}

}  // namespace hydro::diagnose
