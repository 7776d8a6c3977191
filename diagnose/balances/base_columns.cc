// Columns of base parameters: relative deviations from the given values.
#include <algorithm>
#include <cmath>

#include "diagnose/balances/column_maker.h"
#include "diagnose/fit/prior.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {
namespace {

using model::BaseParameters;
using model::Parameters;

// A value given as 0 may contribute up to a tenth of its balance.
constexpr double kFromNothing = 0.1;
// For "one value differs by run": this many times the deviation that each run may have in every hypothesis.
constexpr double kDiffersByRun = 6;

// One term of each balance keeps its value, and all others are measured by it. If every scale were free, the
// smallest balance would be the best.
bool IsFixed(double Parameters::*member) { return member == &Parameters::k_1 || member == &Parameters::k_2; }

// In the flows, the others are measured by D w.
bool CountsIn(double Parameters::*member, BalanceKind balance) {
  return member != &Parameters::D || balance == BalanceKind::kTorque;
}

void PutBase(ColumnMaker* maker, int column, size_t run, const BalanceSeries& series, double factor,
             double Parameters::*member) {
  BalanceSeries counted = series;
  for (const BalanceKind balance : kAllBalances) {
    if (!CountsIn(member, balance)) counted[static_cast<size_t>(balance)].resize(0);
  }
  maker->Put(column, run, counted, factor);
}

// The column of the motor's torque limit: a finite difference, because the limit acts through the held
// command.
void AddLimit(ColumnMaker* maker, int column, double Parameters::*member) {
  maker->works.back().push_back([maker, column, member](size_t run) {
    constexpr double kPart = 1e-3;
    model::ModelDescription more = maker->setup->given;
    more.parameters.*member *= 1 + kPart;
    maker->Put(column, run, Beyond(more, maker->Motion(run), (*maker->base)[run]), 1 / kPart);
  });
}

// Numbers of the model's own effects.
void AddGivenEffects(ColumnMaker* maker) {
  const model::ModelDescription& given = maker->setup->given;
  const std::vector<model::EffectParameter> all = model::EffectParameters(given);
  for (size_t i = 0; i < all.size(); ++i) {
    if (!all[i].IsStated(given)) continue;
    const model::EffectDescription& effect = given.effects[all[i].effect];
    const model::ParameterInfo& info = ParameterOf(effect, all[i].name);
    const bool phase = info.role == model::Role::kPhase;
    model::ModelDescription copy = given;
    const double value = all[i].In(&copy);
    const double deviation = DeviationOf(given, all[i]);
    if (deviation == 0 || (value == 0 && !phase)) continue;
    ScanColumn known{effect.id + "." + all[i].Label(), "", phase ? deviation : deviation / std::abs(value),
                     false};
    if (!phase && info.min >= 0) known.value = known.name;
    const int column = maker->Add(known, {.kind = ColumnMeaning::Kind::kGiven, .base = i});
    maker->works.back().push_back([maker, column, i, value, phase](size_t run) {
      const std::vector<BalanceSeries> found =
          DerivativesOf(maker->setup->given, maker->Motion(run), {{model::Unknown::Kind::kEffect, i}});
      if (!found.empty()) maker->Put(column, run, found.front(), phase ? 1 : value);
    });
  }
}

// Adds a base parameter that is tested for differing by run although no hypothesis otherwise lets it differ.
void AddAskedRuns(ColumnMaker* maker, int of) {
  const ScanColumn column = maker->table.columns[static_cast<size_t>(of)];
  const std::vector<std::string>& asked = maker->setup->per_run;
  ColumnMeaning meaning = maker->table.meaning[static_cast<size_t>(of)];
  const bool differs = std::ranges::any_of(
      maker->table.columns, [&](const ScanColumn& one) { return one.name.starts_with(column.name + "["); });
  if (meaning.kind != ColumnMeaning::Kind::kBase || meaning.run >= 0 || !column.set.empty() || differs)
    return;
  if (std::ranges::find(asked, column.name) == asked.end()) return;
  for (size_t r = 0; r < maker->runs->size(); ++r) {
    meaning.run = static_cast<int>(r);
    maker->AddAlias({"run." + column.name + "[" + std::to_string(r) + "]", "run." + column.name,
                     std::max(kFarOff, column.sd), false},
                    meaning, of, meaning.run);
  }
}

}  // namespace

void AddBaseColumns(ColumnMaker* maker) {
  if (!maker->setup->hold_effects) AddGivenEffects(maker);
  struct Free {
    size_t base;
    int column;
  };
  std::vector<Free> free;
  const model::ModelDescription& given = maker->setup->given;
  for (const size_t i : maker->setup->allowed) {
    const model::BaseParameter& base = BaseParameters()[i];
    if (IsFixed(base.member)) continue;
    const double value = given.parameters.*base.member;
    ScanColumn column{base.info.name, "",
                      value != 0 ? model::UncertaintyOf(given, i) : kFromNothing / kUsualPart, false};
    if (value > 0 && base.info.min >= 0) column.value = column.name;
    ColumnMeaning meaning{.kind = ColumnMeaning::Kind::kBase, .base = i, .unit = value != 0 ? 1.0 : 0.0};
    const int place = maker->Add(column, meaning);
    if (base.member == &Parameters::T_pmax) {
      AddLimit(maker, place, base.member);
    } else {
      free.push_back({i, place});
    }
  }
  for (size_t first = 0; first < free.size(); first += model::kJetWidth) {
    const std::vector<Free> some(
        free.begin() + static_cast<std::ptrdiff_t>(first),
        free.begin() + static_cast<std::ptrdiff_t>(std::min(free.size(), first + model::kJetWidth)));
    maker->works.back().push_back([maker, some](size_t run) {
      std::vector<model::Unknown> unknowns;
      unknowns.reserve(some.size());
      for (const Free& one : some) unknowns.push_back({model::Unknown::Kind::kBase, one.base});
      const std::vector<BalanceSeries> all = DerivativesOf(maker->setup->given, maker->Motion(run), unknowns);
      for (size_t u = 0; u < all.size(); ++u) {
        double Parameters::*member = BaseParameters()[some[u].base].member;
        const double value = maker->given().*member;
        PutBase(maker, some[u].column, run, all[u], value != 0 ? value : 1, member);
      }
    });
  }
}

void AddValueColumns(ColumnMaker* maker) {
  const size_t columns = maker->table.columns.size();
  for (size_t i = 0; i < columns; ++i) {
    const ColumnMeaning meaning = maker->table.meaning[i];
    const ScanColumn column = maker->table.columns[i];
    AddAskedRuns(maker, static_cast<int>(i));
    ScanColumn wide{"wide." + column.name, "value." + column.name, std::max(kFarOff, 3 * column.sd), false};
    wide.value = column.value;
    if (meaning.kind == ColumnMeaning::Kind::kGiven) maker->AddAlias(wide, meaning, static_cast<int>(i), -1);
    if (meaning.kind == ColumnMeaning::Kind::kBase && meaning.run < 0) {
      const bool zero = maker->given().*BaseParameters()[meaning.base].member == 0;
      wide.sd *= zero ? 3 : 1;
      maker->AddAlias(wide, meaning, static_cast<int>(i), -1);
    }
    if (meaning.run < 0 || !column.set.empty() || meaning.kind == ColumnMeaning::Kind::kOther) continue;
    const std::string name = column.name.substr(0, column.name.find('['));
    maker->AddAlias({"run." + column.name, "run." + name, kDiffersByRun * column.sd, false}, meaning,
                    static_cast<int>(i), meaning.run);
  }
}

}  // namespace hydro::diagnose
