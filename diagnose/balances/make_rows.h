// From runs to rows: motions, balances, masks, columns, test functions.
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
  // Base parameters that may differ by run, of any kind ("J"). Friction, charge pressure and load always may.
  std::vector<std::string> per_run = {};
  bool hold_effects = false;  // numbers of effects that the model has stay as they are
  // What pressures are marched with that were not measured; none: the model as given. The balances stay those of the model as given.
  std::optional<model::ModelDescription> marched = std::nullopt;
};

// The measured runs as the scan sees them, made once.
class ScanRuns {
 public:
  // Throws ModelError where the given model's equations cannot be set up for a run.
  ScanRuns(const model::ModelDescription& given, const std::vector<const RunData*>& runs,
           const ScanOptions& options);

  // All rows, with waves at these periods per turn.
  Rows MakeRows(const std::vector<int>& periods);

  const ColumnSetup& setup() const { return setup_; }
  const std::vector<RunMotion>& motions() const { return motions_; }
  const std::vector<ColumnMeaning>& meaning() const { return meaning_; }
  const std::vector<BaseSeries>& base() const { return base_; }
  // By run and balance.
  const std::vector<std::array<std::vector<uint8_t>, kBalanceKinds>>& masks() const { return masks_; }
  double tile() const { return tile_; }
  // Effects that these runs cannot tell from another value of the base parameter beside them: the value stands for both.
  const std::vector<std::pair<std::string, std::string>>& doubles() const { return doubles_; }

  // Whether some pressure was not measured, and is marched.
  bool HasLatent() const;
  // Sets of changes (ScanColumn::set) that act in no balance but through such a pressure: of those, only that there is one can be told.
  std::set<std::string> OilOnly() const;

  // The same rows with the columns of waves at these periods alone.
  Rows MakeWaveRows(const std::vector<int>& periods) const;

 private:
  static void Append(const ColumnTable& more, ColumnTable* table);
  void Project(const ColumnTable& clean, const ColumnTable& noisy, Rows* rows) const;

  int jobs_ = 1;
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
