// All columns of the scan: what each change would do to each balance at the measured motion. Each column is a
// derivative of the balances themselves, so an effect that is new in the catalogue, or written as text, gets
// its columns without further code.
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
    kReading,  // an error of a sensor's reading in one run
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
  // series[run][balance]: from the column to its values at every stride-th instant, for an amount of 1.
  std::vector<std::array<std::map<int, Eigen::VectorXd>, kBalanceKinds>> series;
  // Whether the column acts directly in some balance, and not only through a pressure that was not measured.
  std::vector<bool> direct;

  int Add(ScanColumn column, ColumnMeaning means) {
    columns.push_back(std::move(column));
    meaning.push_back(std::move(means));
    return static_cast<int>(columns.size()) - 1;
  }
};

// How large the balances are in the runs: the scale in which amounts are measured.
struct BalanceSizes {
  std::array<double, kBalanceKinds>
      of{};  // torque, flow, arm torque, pressure: root mean square of the main term
  double speed = 0, pressure = 0, difference = 0, largest_speed = 0;
  double arm_low = 0, arm_high = 0, arm_speed = 0;
};

// What the columns are made from. Clean and noisy motions use the same setup.
struct ColumnSetup {
  model::ModelDescription given;
  std::vector<size_t> allowed;       // base parameters that may differ
  std::vector<std::string> per_run;  // those that are tested for differing by run
  bool hold_effects = false;         // the numbers of the model's own effects stay as they are
  std::vector<EffectVariant> variants;
  std::vector<int> periods;  // numbers of periods per turn at which waves are tried
  bool only_always = false;  // no columns but those of every hypothesis
  bool curves = true;        // whether closures are among the columns
  BalanceSizes sizes;
  std::vector<double> units;  // by column, set when the column is first made: the unit of an amount of 1
};

BalanceSizes SizesOfBalances(const std::vector<RunMotion>& runs, const std::vector<BaseSeries>& base,
                             const model::Parameters& given);

// Makes all columns except those of waves. The first call fixes the units of the amounts (`setup->units`). A
// later call, with noisier motions of the same runs and with the first call's table as `again`, keeps them.
// `jobs` is the number of threads; the result does not depend on it.
ColumnTable MakeColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                        const std::vector<BaseSeries>& base, int jobs, const ColumnTable* again = nullptr);

// Makes the columns of `setup->variants` alone.
ColumnTable MakeEffectColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                              const std::vector<BaseSeries>& base, int jobs,
                              const ColumnTable* again = nullptr);

// Makes the columns of effects that repeat with the shaft, at `setup->periods`.
ColumnTable MakeWaveColumns(ColumnSetup* setup, const std::vector<RunMotion>& runs,
                            const std::vector<BaseSeries>& base, int jobs);

}  // namespace hydro::diagnose
