// Makes columns: registers each column once and fills its series run by run. Only .cc files of this room use
// it.
#pragma once

#include <functional>
#include <optional>

#include "diagnose/balances/columns.h"

namespace hydro::diagnose {

// The usual size of an effect, as a fraction of the balance's main term. One ten times as small or as large
// costs little.
inline constexpr double kUsualPart = 0.15;

// For "one value is far off", and for a parameter of an effect without a grid: either may be wrong by a half.
inline constexpr double kFarOff = 0.5;

// Work on one run that fills the series of some columns. Different works fill different columns.
using ColumnWork = std::function<void(size_t run)>;

struct ColumnMaker {
  ColumnSetup* setup = nullptr;
  const std::vector<RunMotion>* runs = nullptr;
  const std::vector<BaseSeries>* base = nullptr;
  ColumnTable table;
  const ColumnTable* again = nullptr;  // the same columns of the runs without added noise, where they exist
  std::vector<std::vector<ColumnWork>>
      works;  // done one after the other: later works use columns of earlier ones

  const RunMotion& Motion(size_t run) const { return (*runs)[run]; }
  const model::Parameters& given() const { return setup->given.parameters; }
  double Size(BalanceKind balance) const { return setup->sizes.of[static_cast<size_t>(balance)]; }

  int Add(ScanColumn column, ColumnMeaning meaning = {}) {
    return table.Add(std::move(column), std::move(meaning));
  }
  void Put(int column, size_t run, BalanceKind balance, Eigen::VectorXd series) {
    table.series[run][static_cast<size_t>(balance)][column] = std::move(series);
  }
  void Put(int column, size_t run, const BalanceSeries& all, double factor = 1);
  // The series of a column that an earlier work made, or null.
  const Eigen::VectorXd* Find(int column, size_t run, BalanceKind balance) const;
  // The column of that name.
  std::optional<int> Named(const std::string& name) const;
  // Adds a column that equals another one, in one run or in all.
  int AddAlias(ScanColumn column, ColumnMeaning meaning, int of, int only_run);
};

// What the balances change by when a signal reads `errors` too high, for errors of that size and in
// proportion.
BalanceSeries ReadingColumn(const ColumnMaker& maker, size_t run, const SignalErrors& errors);

void AddBaseColumns(ColumnMaker* maker);
void AddEffectColumns(ColumnMaker* maker);
void AddWaveColumns(ColumnMaker* maker);
void AddNuisanceColumns(ColumnMaker* maker);
void AddClosureColumns(ColumnMaker* maker);
void AddValueColumns(ColumnMaker* maker);

}  // namespace hydro::diagnose
