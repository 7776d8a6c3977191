// A measured run made ready for comparing with simulations: what was done to the actuator, what was measured
// and how noisy that is.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "model/response.h"
#include "runs/measured_run.h"
#include "trajectory/trajectory.h"

namespace hydro::diagnose {

struct SignalData {
  model::Channel channel = model::Channel::kP1;
  std::vector<double> values;  // a sample each; NaN: missing
  double noise = 0;            // standard deviation, in the signal's unit: estimated from the data
  double stated_noise = std::numeric_limits<double>::quiet_NaN();  // what the run says of it
  double resolution = 0;  // smallest step between values, 0 where none shows
  size_t valid = 0;       // samples that are not missing
  // Samples at the end of the sensor's range: they say only that it was exceeded, and count as missing.
  size_t saturated = 0;
};

struct RunData {
  std::string name;  // unique among the runs
  runs::MeasuredRun measured;
  model::Stimulus stimulus;  // `motion` points to the one below
  std::unique_ptr<trajectory::Trajectory> motion;
  model::StartState start{};  // the base states at the first sample, from its neighbours
  // Which of them are unknown: measured badly or not at all. Others are held (the angle of a motor whose
  // angle is not measured).
  std::array<bool, 6> start_free{};
  // The start at rest, where the first sample of the motor's speed allows that and `start` moves: what
  // accelerates from rest has its speed extrapolated.
  std::optional<model::StartState> at_rest;
  std::vector<SignalData> signals;  // those that a simulation is compared with

  size_t samples() const { return stimulus.time.size(); }
  double duration() const { return stimulus.time.back() - stimulus.time.front(); }
  const SignalData* Find(model::Channel channel) const;
};

// "motor_speed", as in sidecars and reports.
const std::string& ChannelName(model::Channel channel);
// "rad/s"
const std::string& ChannelUnit(model::Channel channel);

// Throws InputError, with run, signal and row, for data that nothing can be learnt from: fewer than 100
// samples, a signal that never changes or is not there at all, none that a model could be compared with,
// values that are impossible (speeds of 1e5 rad/s: another unit).
RunData PrepareRun(runs::MeasuredRun run, const model::Parameters& model);

// Between the smallest and the largest value, NaN left out; low is above high when there is none.
struct ValueRange {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double size() const { return high - low; }
};
ValueRange RangeOfValues(const std::vector<double>& values);

// Makes the runs' names unique.
void NameApart(std::vector<RunData>* runs);

// The standard deviation of what no smooth signal explains: white noise and rounding. From the quietest of
// several bands of the upper spectrum, so that neither the motion nor a ripple of one frequency counts; at
// least that of rounding to the resolution. `values` may have NaN.
double EstimateNoise(const std::vector<double>& values);

// The smallest step between values that differ; 0 when most steps are no multiples of it.
double EstimateResolution(const std::vector<double>& values);

}  // namespace hydro::diagnose
