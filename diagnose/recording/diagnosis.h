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
  std::vector<std::string> signals;  // the signals that this clock timed
  double delay = 0;                  // s; negative: early
  double error = 0;                  // half the width of the 95 % interval, s
};

// A number with its 95 % interval.
struct Estimated {
  std::string name;
  double value = 0;
  double low = 0, high = 0;
  std::string unit;
  bool shown = true;  // false: the interval is so wide that the runs do not show the value
};

struct Window {
  std::string run;
  double from = 0, to = 0;  // s
};

// Where simulation and data disagree.
struct Location {
  // pump_torque | flow_1 | flow_2 | arm_torque | command | sensor. Where no balance can be formed, the name
  // of a signal.
  std::string balance;
  double share = 0;   // of the disagreement
  std::string where;  // "|motor_speed| < 5 rad/s, at reversals"
  std::vector<Window> windows;
};

// A part of the machine's behaviour over the variable that it depends on, as the balances measure it without
// any simulation: means over bins and their standard errors, with the models' values at the same instants. It
// is one of three: the missing term of a balance (no models); the term of an effect that was found (what the
// balance lacks without it, and the effect's own); or the behaviour of one element: the pump's friction, the
// leakage across its ports, the arm's load.
struct MeasuredCurve {
  // pump_friction | cross_leakage | arm_load; for a term, the effect; "": what is missing.
  std::string element = {};
  std::string balance = {}, unit = {};          // the curve's unit, e.g. in-lbf
  std::string against = {}, against_unit = {};  // "motor_speed", "rad/s"
  std::vector<double> at = {}, measured = {}, error = {};
  // The model's values as given, and with what was found; empty: none.
  std::vector<double> model = {}, found = {};
};

// A stretch of a run in which an effect that acts through time shows: one signal, in the model's unit, and
// the predictions of the model that was found, with the effect and without it.
struct FoundStretch {
  std::string effect, run;
  model::Channel channel = model::Channel::kP1;
  std::vector<double> time, measured, with, without;
};

// What no known effect explains, as a smooth curve over one variable or a surface over two that is added to a
// balance. It is a part of the model, but names no cause.
struct Closure {
  std::string id, unit;  // "closure.pump_torque"; of the values
  std::vector<std::string> against, against_units;
  std::vector<std::vector<double>> knots;  // of each variable
  // The values at each knot. For two variables they are stored row by row, one row for each knot of the
  // first. `low` and `high` bound the 95 % band.
  std::vector<double> value, low, high;
  // Typical error of held-out predictions over `seconds`, in noise units; over windows, the geometric mean.
  double before = 0, after = 0;
  double seconds = 0;
  std::string resembles;  // "grows as the square root of |p2 - p1|"
};

struct FoundEffect {
  std::string id, summary, equation;
  std::vector<Estimated> parameters;
  std::vector<std::string> names;  // "signal = p1"
  // Alternatives that explain the runs as well: effects, "parameter b", or "parameters" for other values of
  // them all.
  std::vector<std::string> tied_with;
  // The part of the held-out squared gap that returns without the effect, 0 to 1; NaN where it cannot be
  // determined.
  double share = std::numeric_limits<double>::quiet_NaN();
  double weight = 0;  // the total of all explanations that have it
};

// A base parameter ("J"), or a parameter of an effect in the model as given ("valve.relief.set").
struct ChangedParameter {
  Estimated fitted;
  double model = 0;  // as given
  bool implausible = false;
  std::string why;  // why it is called implausible
  // The runs do not distinguish it from other values: the value rests on how well the model's values are
  // known.
  bool resting = false;
};

// A base parameter with a value for each run, fitted together with all other values of the model that was
// found.
struct ValueByRun {
  std::string name, unit;
  std::vector<Estimated> values;  // named by run; NaN where the run cannot be simulated
  // The typical gap of the runs' windows that were not fitted, in noise units: with one value for all, and
  // with one for each run.
  double before = 0, after = 0;
  bool differs = true;  // both the balances and these windows say that it differs

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
  double seconds = 0;      // how far the predictions reach; 0: whole runs
  bool closed = false;     // in an open verdict: a curve has closed this gap, and another is open
  bool of_fitted = false;  // of the fitted runs, because the held-out runs show no gap
};

struct SignalGap {
  model::Channel channel = model::Channel::kP1;
  double noise = 0;
  BeforeAfter fit, held_out;
};

// Gaps of predictions over a horizon: windows of that length, each from its own start.
struct HorizonGap {
  double seconds = 0;
  BeforeAfter fit, held_out;  // in noise units of all signals
  std::vector<SignalGap> signals;
  BeforeAfter typical = {};  // the geometric mean of the held-out windows' gaps
};

struct Candidate {
  // The effect's id, or "parameter k_1"; ids of a set are joined with " + ". "parameters": all values
  // refitted; "as given": the model itself.
  std::string id;
  // The balances' score of it above that of the empty set: nats of evidence and of prior odds. NaN: the
  // balances say nothing.
  double score = 0;
  // Typical gap of the held-out windows that judge, or of whole runs where these judge, in noise units; NaN:
  // not tried.
  double held_out = 0;
  // Probability that chance alone gives as much evidence for it, allowing for the number tried.
  double p_value = 1;
  std::string rejected_because;  // "" for those that were taken
  // The probability of the explanation among those that the balances compared. The weights of all candidates
  // add up to 1.
  double weight = 0;
};

// Why a candidate that no simulation has tried was rejected.
inline constexpr char kNotProposed[] = "the balances of the runs do not propose it";

// One run for the pictures, thinned to what a page can hold.
struct RunCurves {
  std::string run;
  bool held_out = false;  // the values come from a fit that did not see the run
  std::vector<double> time;
  struct Curve {
    model::Channel channel = model::Channel::kP1;
    std::vector<double> measured, before, after;
  };
  std::vector<Curve> curves;
};

// What the other runs choose among the sets that were tried, where each run is held out in turn.
struct ChoiceWithout {
  std::string run;     // the run left out
  std::string chosen;  // a candidate's id
  bool same = false;   // all runs together choose the same
};

// A set of changes that may explain the runs: effects, closures ("closure.pump_torque(motor_speed)"), values
// that are far off ("value.b") and values that differ by run ("run.T_s"). Empty: nothing is missing.
struct WeightedSet {
  std::vector<std::string> changes;
  double weight = 0;  // probability among all sets that were compared; they add up to 1
};

// An effect that the runs cannot show in any case, and why: "p1 and p2 were not recorded".
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
  ComparedGap compared;               // stated by the sentence
  std::vector<ClockDelay> recording;  // clocks found to differ, now aligned
  // Suspect features of the recordings, what could not be tried, and noise that differs from the stated
  // noise.
  std::vector<std::string> remarks;
  std::vector<Location> location;
  std::vector<MeasuredCurve> missing;
  std::vector<MeasuredCurve> terms;     // of effects that act without delay
  std::vector<MeasuredCurve> measured;  // of the balances that could be formed
  std::vector<FoundStretch> stretches;  // of effects without a term
  std::vector<FoundEffect> effects;
  std::vector<ChangedParameter> parameters;
  // Values that were refitted with the others and which the runs do not show to differ from those given.
  std::vector<std::string> unsure;
  std::vector<std::string> by_run;     // names of values of which the set that was found has one for each run
  std::vector<std::string> not_shown;  // names of refitted values on which nothing in the runs depends
  std::vector<ValueByRun> per_run;
  std::vector<SignalGap> signals;
  BeforeAfter fit, held_out;
  double noise_shown = 1;            // what the samples' own noise leaves, in noise units (NoiseShown())
  std::vector<HorizonGap> horizons;  // the shortest first
  std::vector<Closure> closures;     // usually none; else of different balances, largest first
  NextExperiment next;
  std::vector<Candidate> candidates;
  std::vector<WeightedSet> explanations;  // the likeliest first
  size_t set_90 = 0;                      // how many of the first hold the truth nine times in ten
  std::vector<Unjudged> unjudged;         // effects about which the runs say nothing, neither for nor against
  std::vector<RunCurves> curves;
  model::ModelDescription model;  // with the changes found
  // When held_out_runs is empty, the runs were held out in turn.
  std::vector<std::string> runs, held_out_runs;
  std::vector<ChoiceWithout> choices;  // filled if they were, and there are at least three
  // Whether runs were held out in turn, and every second window of each was fitted all the same: then
  // held-out gaps of whole runs are those of a model that saw half of each.
  bool half_fitted = false;
  bool recorder_may_be =
      false;  // what was found is a delay that the recorder may cause (MayBeTheRecorders())
  size_t samples = 0;
};

}  // namespace hydro::diagnose
