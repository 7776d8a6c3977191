// All columns of the scan: what each change would do to each balance, at the measured motion. Each is a derivative of the
// balances themselves, so an effect that is new in the catalogue, or written as text, has its columns by itself.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/balances/balance_series.h"
#include "diagnose/balances/effect_variants.h"

namespace hydro::diagnose {

// What a column stands for in a model.
struct ColumnMeaning {
  enum class Kind {
    kBase,     // a base parameter: amount = relative deviation (of a value given as 0: in units of `unit`)
    kGiven,    // a number of an effect that the model has: relative deviation, of a phase in rad
    kEffect,   // a number of an effect: value = amount * unit
    kWhole,    // the effect as a whole: 1 is the variant as it stands
    kMoved,    // logarithm of a parameter of such an effect
    kWave,     // sine or cosine part of a run's wave
    kReading,  // what a recorder reads too much in one run
    kOther,    // a nuisance or a closure
  };
  Kind kind = Kind::kOther;
  size_t base = 0;             // kBase: index in BaseParameters(); kGiven: in EffectParameters()
  size_t variant = 0;          // of an effect
  std::string parameter = "";  // kEffect, kMoved
  double unit = 1;
  int run = -1;  // of a value that belongs to one run
};

// Columns, and their series by run and balance.
struct ColumnTable {
  std::vector<ScanColumn> columns;
  std::vector<ColumnMeaning> meaning;
  // series[run][balance]: column -> values at every stride-th instant, for an amount of 1.
  std::vector<std::array<std::map<int, Eigen::VectorXd>, kBalanceKinds>> series;
  // Whether some balance has the column itself, and not only through a pressure that nobody measured.
  std::vector<bool> direct;

  int Add(ScanColumn column, ColumnMeaning means) {
    columns.push_back(std::move(column));
    meaning.push_back(std::move(means));
    return static_cast<int>(columns.size()) - 1;
  }
};

// How large the balances are in the runs: what amounts are measured by.
struct BalanceSizes {
  std::array<double, kBalanceKinds>
      of{};  // torque, flow, arm torque, pressure: root mean square of the main term
  double speed = 0, pressure = 0, difference = 0, largest_speed = 0;
  double arm_low = 0, arm_high = 0, arm_speed = 0;
};

// What the columns are made from, the same for clean and noisy motion.
struct ColumnSetup {
  model::ModelDescription given;
  std::vector<size_t> allowed;       // base parameters that may differ
  std::vector<std::string> per_run;  // those of which it is asked whether they differ by run
  bool hold_effects = false;         // numbers of effects that the model has stay as they are
  std::vector<EffectVariant> variants;
  std::vector<int> periods;  // per turn, that waves are tried at
  bool only_always = false;  // no columns but those of every hypothesis
  BalanceSizes sizes;
  std::vector<double> units;  // by column, set when it is first made: what an amount of 1 is
};

BalanceSizes SizesOfBalances(const std::vector<RunMotion>& runs, const std::vector<BaseSeries>& base,
                             const model::Parameters& given);

// Makes all columns but those of waves. The first call fixes the units of amounts (`setup->units`); a later one, with noisier motions
// of the same runs and `again` what the first one made, keeps them. `jobs`: threads; the result does not depend on them.
ColumnTable MakeColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                        const std::vector<BaseSeries>& base, int jobs, const ColumnTable* again = nullptr);

// Those of `setup->variants` alone.
ColumnTable MakeEffectColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                              const std::vector<BaseSeries>& base, int jobs,
                              const ColumnTable* again = nullptr);

// Those of what repeats with the shaft, at `setup->periods`.
ColumnTable MakeWaveColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                            const std::vector<BaseSeries>& base, int jobs);

}  // namespace hydro::diagnose
