// A measured run prepared for comparison with simulations: what drove the actuator, what was measured, and
// how noisy the measurements are.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "model/response.h"
#include "model/trajectory/trajectory.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

// As a fraction of a signal's range: the noise that is assumed where none shows, since a simulation errs by
// as much. A 12-bit encoder's steps do show.
inline constexpr double kNoNoise = 1e-5;

struct SignalData {
  model::Channel channel = model::Channel::kP1;
  std::vector<double> values;  // one for each sample; NaN: missing
  double noise = 0;            // standard deviation in the signal's unit: as stated, else estimated
  double stated_noise = std::numeric_limits<double>::quiet_NaN();  // stated by the run itself
  double estimated_noise = 0;  // from the data, regardless of what is stated
  double resolution = 0;       // smallest step between values; 0 if none shows
  size_t valid = 0;            // samples that are not missing
  // Samples at the end of the sensor's range. They show only that the range was exceeded, and count as
  // missing.
  size_t saturated = 0;
};

inline constexpr model::StartState kUnknownStart = [] {
  model::StartState errors;
  errors.fill(std::numeric_limits<double>::infinity());
  return errors;
}();

struct RunData {
  std::string name;  // unique among the runs
  runs::MeasuredRun measured;
  model::Stimulus stimulus;  // `motion` points to the one below, or to that of the whole run
  std::unique_ptr<trajectory::Trajectory> motion;
  // Set for the first of the fitted runs: phases count from its shaft's angle. The other runs' shafts may
  // start at any angle.
  bool angle_counts = false;
  bool begins_within = false;  // a window that does not begin where its run does
  model::StartState start{};   // the base states at the first sample, from nearby samples
  // Which of these states are unknown because they were measured badly or not at all. The others are held
  // (for example the angle of a motor whose angle is not measured).
  std::array<bool, std::tuple_size_v<model::StartState>> start_free{};
  // How far each state may be from `start`, as a standard deviation: noise, and the effect of a wrong scale
  // or a late sensor. Infinite where nothing was measured.
  model::StartState start_error = kUnknownStart;
  std::vector<SignalData> signals;    // those compared with a simulation
  double most_steps_per_sample = 20;  // limit for a simulation of the run

  size_t samples() const { return stimulus.time.size(); }
  double duration() const { return stimulus.time.back() - stimulus.time.front(); }
  const SignalData* Find(model::Channel channel) const;
};

// The channel's row in the table of signals: its names, and where a run stores it.
const runs::SignalName& SignalOf(model::Channel channel);
// Whether a simulation of the run is compared with the channel: the channel is measured, and it does not
// belong to an arm that stands still (clamped) or whose motion is imposed (driven).
bool IsCompared(const runs::MeasuredRun& run, model::Channel channel);
// The size that no reading of a channel's sensor exceeds, in the model's own units: at least twice what the
// model's equations could produce, so that only a wrong unit or a damaged cell does, and no wrong parameter.
double LargestPossible(const runs::SignalName& row, const model::ModelDescription& model);
// The number of values that are not missing.
size_t CountValid(const std::vector<double>& values);
// Whether the oil takes part in any of the runs: a pressure was recorded, or a bypass was not open.
bool HaveOil(const std::vector<const RunData*>& runs);
// Whether anything is ever commanded in one of the runs.
bool AreDriven(const std::vector<const RunData*>& runs);
// The duration of the shortest run, s.
double ShortestDuration(const std::vector<const RunData*>& runs);
// The median time between successive samples of all runs, s.
double SampleInterval(const std::vector<const RunData*>& runs);
// The inputs of the actuator, without the motion of a driven shaft.
model::Stimulus StimulusOf(const runs::MeasuredRun& run);

std::vector<const RunData*> PointersTo(const std::vector<RunData>& runs);
// The starts of the runs as measured.
std::vector<model::StartState> MeasuredStarts(const std::vector<const RunData*>& runs);

// "motor_speed", as in sidecars and reports.
std::string ChannelName(model::Channel channel);
// "rad/s", in the model's units.
std::string ChannelUnit(model::Channel channel, const UnitSystem& units);

// A run with fewer samples cannot be used.
inline constexpr size_t kFewestSamples = 100;

// Throws InputError, with run, signal and row, for data that teach nothing in any unit: fewer than 100
// samples, times that are far too uneven for an even grid, or a signal that never changes or has hardly any
// values.
void CheckUsable(const runs::MeasuredRun& run);

// Throws InputError, with the sidecar and its key, when a clamped arm is held where the model has no volume.
void RequireArmInStroke(const runs::MeasuredRun& run, const model::ModelDescription& model);

// Throws InputError as CheckUsable() and RequireArmInStroke() do, and also when no signal can be compared
// with a model, or when times or values are impossible (speeds of 1e5 rad/s point to another unit).
RunData PrepareRun(runs::MeasuredRun run, const model::ModelDescription& model);

// Sets the run's start and start_free from its first samples. All other members of `data` must already be
// filled in.
void SetStart(const model::Parameters& model, RunData* data);

// In standard deviations of its noise: a signal that moves up and down by no more than this hardly moves.
inline constexpr double kHardlyMoves = 5;

// Median sample intervals: rows that are further apart lack some between them.
inline constexpr double kGapInTime = 5;
// A part of the command's range: a larger change from one sample to the next is a step.
inline constexpr double kStepOfCommand = 0.05;

// Samples: filters of recorders and means over a sample delay a signal by so many.
inline constexpr double kRecorderSamples = 2;

// Standard deviations: noise hides what is smaller.
inline constexpr double kHides = 3;

// Makes the runs' names unique.
void MakeNamesUnique(std::vector<RunData>* runs);

// The standard deviation of what no smooth signal explains: white noise and rounding. It comes from the
// quietest of several bands of the upper spectrum, so that neither the motion nor a ripple of one frequency
// counts, or from the quietest samples where these clearly have less noise. It is at least the rounding error
// of the resolution. `values` may contain NaN.
double EstimateNoise(const std::vector<double>& values);

// The smallest step between different values; 0 when most steps are not multiples of it.
double EstimateResolution(const std::vector<double>& values);

}  // namespace hydro::diagnose
