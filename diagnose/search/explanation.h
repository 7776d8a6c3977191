// An explanation of the runs: a hypothesis, fitted, and how well it predicts runs that it was not fitted to.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "diagnose/fit/comparison.h"
#include "diagnose/fit/fit.h"
#include "diagnose/fit/held_out.h"
#include "diagnose/search/progress.h"

namespace hydro::diagnose {

// A hypothesis and how well it does.
struct Explanation {
  Fitted fitted;
  HeldOut held_out;
  BlockSums blocks;      // of held_out; of windows the logarithms of their squared gaps
  bool windows = false;  // it explains windows, not whole runs

  double squared_gap() const { return fitted.squared_gap(); }
  double held_out_gap() const { return windows ? held_out.typical_squared_gap() : held_out.squared_gap(); }
  const std::vector<Change>& changes() const { return fitted.hypothesis.changes; }
};

// What an explanation costs by its squared gap and its new numbers: of two that predict equally well, the one
// with fewer numbers costs less, and a wrong value less than a missing effect.
double NumbersFactor(const Hypothesis& hypothesis);
double Cost(double squared_gap, double numbers_factor);

// What every step of a search needs.
struct SearchContext {
  model::ModelDescription given;
  std::vector<const RunData*> runs;
  std::vector<const RunData*> held_out;  // empty: the runs are held out in turn
  bool windows = false;                  // the runs are windows of runs
  std::vector<Change> changes;           // those that may be made
  Sizes sizes;
  int jobs = 1;
  uint64_t seed = 1;
  // The runs that an explanation's held_out speaks of.
  const std::vector<const RunData*>& predicted() const { return held_out.empty() ? runs : held_out; }
  std::function<bool()> time_is_up;  // may be empty: the search has all the time it needs
  ProgressCallback report_progress;
};

// Whether the search has to end with what it has.
bool TimeIsUp(const SearchContext& context);

// How what is reported is fitted, and what is only compared: steps that gain less say nothing about which is better.
inline constexpr double kToCompare = 1e-3;
FitOptions FineFit(int jobs);
FitOptions FitToCompare(int jobs);

// What a fit to the context's runs predicts of the held-out ones.
Explanation ExplanationOf(const SearchContext& context, Fitted fitted, int jobs);

// Fits the hypothesis and predicts the held-out runs, both with the options' jobs.
Explanation Explain(const SearchContext& context, const Hypothesis& hypothesis,
                    const std::vector<model::StartState>& starts, const FitOptions& options);

// What is known of base parameters beforehand, where a fit leaves `sum`: a deviation of one standard deviation has to gain its part.
std::shared_ptr<const Knowledge> KnownAt(const SearchContext& context, double sum);

// Whether both have the same changes, in whatever order and with whatever numbers.
bool SameChanges(const Hypothesis& a, const Hypothesis& b);

}  // namespace hydro::diagnose
