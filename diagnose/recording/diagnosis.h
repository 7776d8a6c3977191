// The result of a diagnosis: the content of report.json and report.html.
#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "model/response.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

enum class Verdict { kNamed, kTied, kPartly, kParameters, kUnexplained, kNothingMissing };

// Whether the verdict leaves a significant gap.
inline bool IsOpen(Verdict verdict) {
  return verdict == Verdict::kUnexplained || verdict == Verdict::kPartly;
}

// A clock of a recording, relative to that of p1 and p2.
struct ClockDelay {
  std::string run;
  std::vector<std::string> signals;  // recorded by that clock
  double delay = 0;                  // s; negative: early
  double error = 0;                  // half the width of the 95 % interval, s
};

// A number with its 95 % interval.
struct Estimated {
  std::string name;
  double value = 0;
  double low = 0, high = 0;
  std::string unit;
};

struct Window {
  std::string run;
  double from = 0, to = 0;  // s
};

// Where simulation and data disagree.
struct Location {
  // pump_torque | flow_1 | flow_2 | arm_torque | command | sensor; where no balance can be formed, a signal's name
  std::string balance;
  double share = 0;   // of the disagreement
  std::string where;  // "|motor_speed| < 5 rad/s, at reversals"
  std::vector<Window> windows;
};

// Something of the machine over the variable that it depends on, as the balances measure it without any simulation: means
// over bins, and their standard errors; beside them what models have at the same instants. The missing term of a balance (no
// models), the term of an effect that was found (what the balance lacks without it, and the effect's own), or what one element
// does: the pump's friction, the leakage across its ports, the arm's load.
struct MeasuredCurve {
  // pump_friction | cross_leakage | arm_load; of a term the effect; "": what is missing.
  std::string element = {};
  std::string balance = {}, unit = {};          // the curve's unit, e.g. in-lbf
  std::string against = {}, against_unit = {};  // "motor_speed", "rad/s"
  std::vector<double> at = {}, measured = {}, error = {};
  // The model's own as given, and with what was found; empty: none.
  std::vector<double> model = {}, found = {};
};

// A stretch of a run in which an effect that acts through time shows: one signal, in the model's unit, and what the
// model with what was found predicts with the effect and without it.
struct FoundStretch {
  std::string effect, run;
  model::Channel channel = model::Channel::kP1;
  std::vector<double> time, measured, with, without;
};

// What no known effect explains, as a smooth curve of one variable or a surface over two that is added to a balance.
// It is a part of the model, and no cause.
struct Closure {
  std::string id, unit;  // "closure.pump_torque"; of the values
  std::vector<std::string> against, against_units;
  std::vector<std::vector<double>> knots;  // of each variable
  // At each knot; of two variables row by row, a row for each knot of the first. Below and above: the 95 % band.
  std::vector<double> value, low, high;
  // Typical error of held-out predictions over `seconds`, in noise units: of windows, the geometric mean.
  double before = 0, after = 0;
  double seconds = 0;
  // The model has other values than what was found, fitted with the same effects: it predicts windows better.
  bool on_refit = false;
  std::string resembles;  // "grows as the square root of |p2 - p1|"
};

struct FoundEffect {
  std::string id, summary, equation;
  std::vector<Estimated> parameters;
  std::vector<std::string> names;  // "signal = p1"
  // What could stand in its place: effects, "parameter b", or "parameters" for other values of them all.
  std::vector<std::string> tied_with;
  // The part of the held-out squared gap that comes back without it, 0 to 1; NaN where it cannot be said.
  double share = std::numeric_limits<double>::quiet_NaN();
  double weight = 0;  // of all explanations that have it
};

// A base parameter ("J"), or one of an effect that the model as given has ("valve.relief.set").
struct ChangedParameter {
  Estimated fitted;
  double model = 0;  // as given
  bool implausible = false;
  std::string why;  // the reason for calling it implausible
  // The runs do not show it apart from other values: it rests on how well the model's values are known.
  bool resting = false;
};

// A base parameter with a value for each run, fitted with all others as in the model that was found.
struct ValueByRun {
  std::string name, unit;
  std::vector<Estimated> values;  // named by run; NaN where the run cannot be simulated
  // The typical gap of the runs' windows that were not fitted, in noise units, with one value and with their own.
  double before = 0, after = 0;
  bool differs = true;  // both the balances and these windows say so

  double Spread() const;  // relative standard deviation between runs
};

// Root-mean-square residuals, in noise units or, for a single signal, in its unit.
struct BeforeAfter {
  double before = 0;      // the model as given
  double refit_only = 0;  // its own parameters refitted
  double after = 0;       // with the changes found
};

// The gap that the verdict's sentence states.
struct ComparedGap {
  BeforeAfter gap;
  double seconds = 0;      // that the predictions reach; 0: whole runs
  bool closed = false;     // of an open verdict: this gap is not what is open, a curve has closed it
  bool of_fitted = false;  // of the fitted runs: the held-out ones show none
};

struct SignalGap {
  model::Channel channel = model::Channel::kP1;
  double noise = 0;
  BeforeAfter fit, held_out;
};

// Gaps of predictions over a horizon: windows of that length, each from a start of its own.
struct HorizonGap {
  double seconds = 0;
  BeforeAfter fit, held_out;  // in noise units of all signals
  std::vector<SignalGap> signals;
  BeforeAfter typical = {};  // the geometric mean of the held-out windows' gaps
};

struct Candidate {
  // Of the effect, or "parameter k_1"; sets of them are joined with " + ". "parameters": all values refitted;
  // "as given": the model itself.
  std::string id;
  // What the balances say of it, beyond what they say of nothing: nats of evidence, and of odds beforehand. NaN: nothing.
  double score = 0;
  // Typical gap of the held-out windows that judge, or of whole runs where these do, in noise units; NaN: not tried.
  double held_out = 0;
  // Probability that chance alone gives as much evidence for it, allowing for the number tried.
  double p_value = 1;
  std::string rejected_because;  // "" for those that were taken
  // How probable the explanation is among those that the balances compared: those of all candidates add to 1.
  double weight = 0;
};

// Why a candidate was rejected that no simulation has tried.
inline constexpr char kNotProposed[] = "the balances of the runs do not propose it";

// One run as the pictures show it, thinned to what a page can hold.
struct RunCurves {
  std::string run;
  bool held_out = false;  // the values are from a fit that did not see it
  std::vector<double> time;
  struct Curve {
    model::Channel channel = model::Channel::kP1;
    std::vector<double> measured, before, after;
  };
  std::vector<Curve> curves;
  // Residuals are plotted against these; may be empty.
  std::vector<double> voltage;
};

// What the other runs choose among what was tried, where each run is held out in turn.
struct ChoiceWithout {
  std::string run;     // that is left out
  std::string chosen;  // as a candidate's id
  bool same = false;   // it is what was found with all runs
};

// A set of changes that may explain the runs: effects, closures ("closure.pump_torque(motor_speed)"), values that are far off ("value.b") and
// values that differ by run ("run.T_s"); empty: nothing is missing.
struct WeightedSet {
  std::vector<std::string> changes;
  double weight = 0;  // how probable it is among all that were compared; they add to 1
};

// Effects that the runs cannot show, whatever they do, and why: "p1 and p2 were not recorded".
struct Unjudged {
  std::vector<std::string> effects;
  std::string because;
};

struct NextExperiment {
  std::string why;
  std::string config;              // TOML of a stack that runs it, "" when none is needed
  double expected_separation = 0;  // of the models, in noise units
};

struct Diagnosis {
  Verdict verdict = Verdict::kNothingMissing;
  std::string sentence;               // the verdict in one sentence
  ComparedGap compared;               // of the sentence
  std::vector<ClockDelay> recording;  // clocks found to differ, now aligned
  // What is suspect in the recordings, what could not be tried, and noise unlike the stated noise.
  std::vector<std::string> remarks;
  std::vector<Location> location;
  std::vector<MeasuredCurve> missing;
  std::vector<MeasuredCurve> terms;     // of effects, where they act at an instant
  std::vector<MeasuredCurve> measured;  // of what balances could be formed for
  std::vector<FoundStretch> stretches;  // of effects that have no term
  std::vector<FoundEffect> effects;
  std::vector<ChangedParameter> parameters;
  std::vector<ValueByRun> per_run;
  std::vector<SignalGap> signals;
  BeforeAfter fit, held_out;
  std::vector<HorizonGap> horizons;  // the shortest first
  std::vector<Closure> closures;     // usually none; then the largest first, of different balances
  NextExperiment next;
  std::vector<Candidate> candidates;
  std::vector<WeightedSet> explanations;  // the likeliest first
  size_t set_90 = 0;                      // so many of the first hold the truth nine times in ten
  std::vector<Unjudged> unjudged;         // effects that the runs say nothing of, neither for nor against
  std::vector<RunCurves> curves;
  model::ModelDescription model;  // with the changes found
  // When held_out_runs is empty, the runs were held out in turn.
  std::vector<std::string> runs, held_out_runs;
  std::vector<ChoiceWithout> choices;  // where they were, and there are three or more
  size_t samples = 0;
};

}  // namespace hydro::diagnose
