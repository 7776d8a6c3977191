// The search for the closures that close a gap best.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/closure/closure_windows.h"
#include "diagnose/locate/locate.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// One way to close the gap: a curve or a surface for each of some balances.
struct ClosureTrial {
  std::vector<const PossibleTerm*> terms;
  std::vector<model::EffectDescription> closures;  // with values of 0
  double score = 0;  // how much of the sum of squares the first step of a fit would take, to first order
};

class ClosureSearch {
 public:
  // On windows of the runs, half of them to fit and half to judge.
  ClosureSearch(const SearchContext& context, const Hypothesis& base, const std::vector<const RunData*>& runs,
                double seconds);

  // The base, with its own values in the balances concerned fitted to the windows where that predicts others better.
  const model::ModelDescription& base() const { return base_.model; }
  const std::vector<const RunData*>& windows() const { return fitted_.chosen; }

  // The best closures, fitted together with the base's own values where that is better; nothing if none is worthwhile on
  // the fitted runs themselves.
  std::optional<Fitted> Find(const std::vector<PossibleTerm>& possible);

 private:
  struct Tried {
    ClosureTrial trial;
    Fitted fitted;
    std::vector<double> gaps;  // of the judging windows
  };

  // Where the windows begin, as the base fits them, and how far its residuals are from independent noise.
  void FitStarts();

  // A closure must not make up for values of the base that belong to its balances: these are as free without it.
  void RefitBase();

  // The base's free values in the balances that have a closure.
  std::vector<size_t> ValuesOfBalances() const;

  // A curve for each table, and for each variable curves of both flows together: what leaks across leaves one side and
  // enters the other.
  static std::vector<ClosureTrial> Curves(const std::vector<PossibleTerm>& possible);

  // The likeliest for each choice of balances.
  static std::vector<const ClosureTrial*> BestOfEach(const std::vector<ClosureTrial>& trials);

  double Score(const ClosureTrial& trial) const;

  Fitted FitValues(const Hypothesis& hypothesis, const std::vector<model::StartState>& starts, double size,
                   int iterations) const;

  // Keeps what is better on the judging windows than the best so far, by this part of the squared gap above the noise.
  void Try(const ClosureTrial& trial, double by);

  // Fits the base's own values too: beside a closure they may be others.
  void FitAll();

  // The same balances over a second variable.
  void TrySurfaces(const std::vector<PossibleTerm>& possible);

  // A curve in another balance too, the likeliest that is one curve.
  void TryAnother(const std::vector<ClosureTrial>& trials);

  int jobs_;
  Hypothesis base_;
  ClosureWindows fitted_, judging_;
  std::vector<model::StartState> starts_;
  double inflation_ = 1;  // how many residuals count as one
  std::vector<double> before_;
  std::optional<Tried> best_;
};

}  // namespace hydro::diagnose
