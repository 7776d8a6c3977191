// A measured run prepared for comparison with simulations: what drove the actuator, what was measured, and
// how noisy the measurements are.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/response.h"
#include "model/trajectory/trajectory.h"
#include "runs/measured_run.h"
#include "runs/measured_signals.h"

namespace hydro::diagnose {

struct SignalData {
  model::Channel channel = model::Channel::kP1;
  std::vector<double> values;  // one a sample; NaN: missing
  double noise = 0;            // standard deviation in the signal's unit: as stated, else estimated
  double stated_noise = std::numeric_limits<double>::quiet_NaN();  // what the run itself states
  double estimated_noise = 0;                                      // from the data, whatever is stated
  double resolution = 0;  // smallest step between values; 0 if none shows
  size_t valid = 0;       // samples that are not missing
  // Samples at the end of the sensor's range: they say only that it was exceeded, and count as missing.
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
  // The first of the fitted runs: phases count from its shaft's angle. The other runs' shafts start anywhere.
  bool angle_counts = false;
  bool begins_within = false;  // a window that does not begin where its run does
  model::StartState start{};   // the base states at the first sample, from nearby samples
  // Which of these states are unknown: measured badly or not at all. The others are held (for example the
  // angle of a motor whose angle is not measured).
  std::array<bool, std::tuple_size_v<model::StartState>> start_free{};
  // How far each of these may be from `start`, a standard deviation: noise, and what a wrong scale or a late sensor
  // makes of it. Infinite where nothing was measured.
  model::StartState start_error = kUnknownStart;
  std::vector<SignalData> signals;    // those compared with a simulation
  double most_steps_per_sample = 20;  // that a simulation of it may take

  size_t samples() const { return stimulus.time.size(); }
  double duration() const { return stimulus.time.back() - stimulus.time.front(); }
  const SignalData* Find(model::Channel channel) const;
};

// The channel's row in the table of signals: its names, and where a run has it.
const runs::SignalName& SignalOf(model::Channel channel);
// Whether a simulation of the run is compared with the channel: it is measured, and is not of an arm that
// stands still (clamped) or whose motion is imposed (driven).
bool IsCompared(const runs::MeasuredRun& run, model::Channel channel);
// Values that are not missing.
size_t CountValid(const std::vector<double>& values);
// The same of all signals that are compared.
size_t CountValid(const RunData& run);
// Of several runs: the shortest one's duration, and the median time between successive samples of all, s.
double ShortestDuration(const std::vector<const RunData*>& runs);
double SampleInterval(const std::vector<const RunData*>& runs);
// What was done to the actuator, without the motion of a driven shaft.
model::Stimulus StimulusOf(const runs::MeasuredRun& run);

std::vector<const RunData*> PointersTo(const std::vector<RunData>& runs);
// Where the runs begin as measured.
std::vector<model::StartState> MeasuredStarts(const std::vector<const RunData*>& runs);

// "motor_speed", as in sidecars and reports.
const std::string& ChannelName(model::Channel channel);
// "rad/s", in the model's units.
std::string ChannelUnit(model::Channel channel, const UnitSystem& units);

// A run of fewer samples cannot be used.
inline constexpr size_t kFewestSamples = 100;

// Throws InputError, with run, signal and row, for data from which nothing can be learnt in any unit: fewer than 100 samples, a signal that
// never changes or has hardly a value.
void CheckUsable(const runs::MeasuredRun& run);

// Throws InputError as CheckUsable() does, and for no signal that a model could be compared with, or
// impossible values (speeds of 1e5 rad/s: another unit).
RunData PrepareRun(runs::MeasuredRun run, const model::Parameters& model);

// Sets the run's start and start_free from its first samples; the rest of `data` must be filled in.
void SetStart(const model::Parameters& model, RunData* data);

// Standard deviations of its noise: a signal that moves by no more, up and down, hardly moves.
inline constexpr double kHardlyMoves = 5;

// Makes the runs' names unique.
void MakeNamesUnique(std::vector<RunData>* runs);

// The standard deviation of what no smooth signal explains: white noise and rounding. It comes from the quietest of several bands of the
// upper spectrum, so that neither the motion nor a ripple of one frequency counts, or, where these have surely less, from the quietest
// samples; and is at least that of rounding to the resolution. `values` may contain NaN.
double EstimateNoise(const std::vector<double>& values);

// The smallest step between values that differ; 0 when most steps are not multiples of it.
double EstimateResolution(const std::vector<double>& values);

}  // namespace hydro::diagnose
