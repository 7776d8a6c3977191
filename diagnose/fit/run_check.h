// What a single recording says of its own mistakes: short predictions with the model as given, each mistake undone.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "diagnose/data/recording_mistake.h"
#include "diagnose/fit/check_windows.h"
#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

// A set of mistakes, and how well the run is predicted without them.
struct MistakeTrial {
  std::vector<RecordingMistake> mistakes;
  double gain = 0;   // logarithm of the fall of the squared error over all signals, in the median window
  double worst = 0;  // median squared error of the signal that is predicted worst
  // Of a free arm with the weight that the model has: the logarithm of the squared error over all signals, and the worst
  // signal's error. NaN elsewhere.
  double free_badness = 0, free_worst = 0;

  bool Explains() const;
  // The gain less what each mistake has to bring.
  double Merit() const;
};

// Fall of the squared error over all signals that counts as far better, a logarithm.
double FarBetter();
// The same where several other runs do not have the mistake, or no known unit explains it.
double FarAlone();
// A recording is in order when the median squared error of every signal is below: a fifth of its movement.
inline constexpr double kInOrder = 4;

class RunCheck {
 public:
  // `time_is_up` ends the trials.
  RunCheck(const model::ModelDescription& model, const runs::MeasuredRun& run,
           const std::function<bool()>& time_is_up);

  // Whether there is anything to be explained.
  bool IsInOrder() const { return in_order_; }
  double as_recorded() const { return as_recorded_; }

  // What explains the run, best first; empty where nothing does.
  std::vector<MistakeTrial> Explanations() const;

  // These mistakes, as far as this run can have them.
  MistakeTrial Try(const std::vector<RecordingMistake>& mistakes) const;

  // A factor of one signal that is no known unit's, where nothing else explains the run.
  std::optional<MistakeTrial> UnknownFactor() const;

 private:
  using Errors = std::vector<PredictionErrors>;

  Errors Unpredicted() const;
  // What the arm carries: as the model says, or as its motion in each window shows; whichever predicts better.
  enum class Load { kGiven, kShown };
  Errors Predict(const std::vector<RecordingMistake>& mistakes, size_t count, WindowStart start) const;
  Errors PredictWith(Load load, const std::vector<RecordingMistake>& mistakes, size_t count,
                     WindowStart start) const;
  double WorstSignal(const Errors& errors) const;
  MistakeTrial Tried(const std::vector<RecordingMistake>& mistakes) const;
  bool OnlyTakesTheCommand(const std::vector<RecordingMistake>& mistakes, double gain) const;
  std::vector<std::vector<RecordingMistake>> Candidates() const;
  std::vector<RecordingMistake> OneByOne() const;
  std::optional<RecordingMistake> BestNext(const std::vector<RecordingMistake>& found) const;

  const model::ModelDescription& model_;
  const std::function<bool()>& time_is_up_;
  runs::MeasuredRun run_;
  std::vector<RecordingMistake> possible_;
  bool slow_, in_order_ = true;
  // In order only with the load that the arm's motion shows: a wrong unit of the pressures may pass for that load, so a
  // mistake counts where the run is in order without it and with the model's own load.
  bool with_own_load_ = false;
  std::vector<runs::MeasuredRun> windows_;
  std::vector<std::array<bool, model::kChannels>> moves_;
  Errors given_;
  double as_recorded_ = 0;
};

}  // namespace hydro::diagnose
