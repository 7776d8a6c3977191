// Makes rows from runs: motions, balances, masks, columns and test functions.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "diagnose/balances/columns.h"
#include "diagnose/balances/masks.h"
#include "diagnose/balances/rows.h"

namespace hydro::diagnose {

struct ScanOptions {
  int jobs = 1;
  std::vector<size_t> allowed;             // base parameters that may differ, as in BaseParameters()
  std::vector<Change> changes;             // effects that may be named
  std::vector<std::string> inverted = {};  // sensors whose readings have the wrong sign
  bool only_always = false;                // no columns but those of every hypothesis
  bool curves = true;                      // whether closures are among the columns
  double highest = 120;                    // Hz: such machines and their sensors are not faster
  double tile = 0;                         // s; 0: chosen from the runs' lengths
  // Base parameters of any kind ("J") that may differ by run. Friction, charge pressure and load always may.
  std::vector<std::string> per_run = {};
  bool hold_effects = false;  // the numbers of the model's own effects stay as they are
  // The model with which pressures that were not measured are marched; none: the model as given. The balances
  // always use the model as given.
  std::optional<model::ModelDescription> marched = std::nullopt;
};

// The measured runs in the form that the scan uses, made once.
class ScanRuns {
 public:
  // Throws ModelError where the given model's equations cannot be set up for a run.
  ScanRuns(const model::ModelDescription& given, const std::vector<const RunData*>& runs,
           const ScanOptions& options);

  // Makes all rows, including waves at these periods per turn.
  Rows MakeRows(const std::vector<int>& periods);

  const ColumnSetup& setup() const { return setup_; }
  const std::vector<RunMotion>& motions() const { return motions_; }
  const std::vector<ColumnMeaning>& meaning() const { return meaning_; }
  const std::vector<BaseSeries>& base() const { return base_; }
  // By run and balance.
  const std::vector<std::array<std::vector<uint8_t>, kBalanceKinds>>& masks() const { return masks_; }
  double tile() const { return tile_; }
  // Effects that these runs cannot tell from another value of the base parameter named beside them. That
  // value stands for both.
  const std::vector<std::pair<std::string, std::string>>& doubles() const { return doubles_; }

  // Whether some pressure was not measured and is marched instead.
  bool HasLatent() const;
  // Sets of changes (ScanColumn::set) that act in the balances only through such a pressure. The runs show
  // that one of these is present, but not which.
  std::set<std::string> OilOnly() const;

  // Makes the same rows with only the columns of waves at these periods.
  Rows MakeWaveRows(const std::vector<int>& periods) const;

  // Columns of an effect at other shapes than its variant's. `rows` has only these columns, those of the
  // first shape first.
  struct OtherShapes {
    Rows rows;
    std::vector<double> units;  // of the columns (ColumnMeaning::unit)
  };
  OtherShapes MakeShapeRows(size_t variant, const std::vector<model::EffectDescription>& at) const;
  // From now on the variant stands at this shape, and its columns have these units.
  void SetShape(size_t variant, const model::EffectDescription& at, const std::vector<double>& units);
  // The columns of a variant, in the order that MakeShapeRows() uses.
  std::vector<int> ColumnsOf(size_t variant) const;

 private:
  static void Append(const ColumnTable& more, ColumnTable* table);
  void Project(const ColumnTable& clean, const ColumnTable& noisy, Rows* rows) const;

  int jobs_ = 1;
  double highest_;  // Hz
  ColumnSetup setup_;
  std::vector<RunMotion> motions_, noisy_;
  std::vector<BaseSeries> base_, noisy_base_;
  std::vector<std::array<std::vector<uint8_t>, kBalanceKinds>> masks_;
  ColumnTable clean_, noisy_table_;  // without waves
  std::vector<std::pair<std::string, std::string>> doubles_;
  std::vector<ColumnMeaning> meaning_;
  double tile_ = 0.25;  // s
};

}  // namespace hydro::diagnose
