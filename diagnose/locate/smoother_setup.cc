#include "diagnose/locate/smoother_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "diagnose/data/sample_interval.h"
#include "model/linearise.h"

namespace hydro::diagnose::smoother {
namespace {

// 1/s. The smoother follows a disturbance this fast, so that it does not take friction at a reversal for
// flow.
constexpr double kBandwidth = 500;
constexpr double kBandwidthPerSample = 0.35;

double ChannelNoise(const SignalData& signal) {
  double noise = std::max(signal.noise, signal.resolution / std::sqrt(12.0));
  if (noise > 0) return noise;
  double low = 0, high = 0;
  for (const double value : signal.values) {
    if (std::isnan(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return std::max(1e-6 * (high - low), 1e-12);
}

// For each sample, the length of the run of equal values that contains it.
std::vector<float> Repeats(const std::vector<double>& values) {
  std::vector<float> repeats(values.size());
  for (size_t i = 0; i < values.size();) {
    size_t end = i + 1;
    while (end < values.size() && values[end] == values[i]) ++end;
    std::fill(repeats.begin() + static_cast<std::ptrdiff_t>(i),
              repeats.begin() + static_cast<std::ptrdiff_t>(end), static_cast<float>(end - i));
    i = end;
  }
  return repeats;
}

Sensor MakeSensor(const SignalData& signal, const PressureOffsets& offsets, std::mt19937_64* random) {
  Sensor sensor;
  sensor.channel = signal.channel;
  sensor.values = &signal.values;
  if (signal.channel == model::Channel::kP1) sensor.offset = offsets.p1;
  if (signal.channel == model::Channel::kP2) sensor.offset = offsets.p2;
  const double noise = ChannelNoise(signal);
  // While a coarse reading stays the same, so does its error: it counts once.
  const bool coarse = signal.resolution > 0 && noise < 0.6 * signal.resolution;
  sensor.variance = noise * noise;
  if (coarse) sensor.repeats = Repeats(signal.values);
  std::normal_distribution<double> normal(0, noise);
  for (auto& draw : sensor.noise) {
    draw.resize(signal.values.size());
    for (size_t k = 0; k < draw.size(); ++k) {
      const bool same = coarse && k > 0 && signal.values[k] == signal.values[k - 1];
      draw[k] = same ? draw[k - 1] : static_cast<float>(normal(*random));
    }
  }
  return sensor;
}

void ChooseSensors(const PressureOffsets& offsets, Setup* setup) {
  std::mt19937_64 random(20240229);
  for (const SignalData& signal : setup->run.signals) {
    const bool arm =
        signal.channel == model::Channel::kArmAngle || signal.channel == model::Channel::kArmSpeed;
    if (arm && !setup->free_arm()) continue;
    setup->sensors.push_back(MakeSensor(signal, offsets, &random));
  }
}

// How much a disturbance may wander: enough for the smoother to follow it with the bandwidth above if the
// only sensor were that of the quantity that the balance moves. `gain` is that quantity's rate per
// disturbance.
double Wander(const Setup& setup, double gain, double rate_variance, double integral_variance) {
  const double step = setup.interval;
  const double bandwidth = std::min(kBandwidth, kBandwidthPerSample / step);
  double wander = std::numeric_limits<double>::infinity();
  if (rate_variance > 0) wander = std::pow(bandwidth, 4) * rate_variance * step / (gain * gain);
  if (integral_variance > 0) {
    wander = std::min(wander, std::pow(bandwidth, 6) * integral_variance * step / (gain * gain));
  }
  return wander;
}

// Gives each balance whose quantity is measured a disturbance among the states.
void ChooseBalances(Setup* setup) {
  const Setup& s = *setup;
  const model::Parameters& p = s.model.parameters;
  const double volume = p.beta / p.V_ms;
  const bool bypass = s.run.stimulus.bypass;
  const std::array<double, kBalances> wander = {
      Wander(s, 1 / p.J, s.Variance(model::Channel::kMotorSpeed), s.Variance(model::Channel::kMotorAngle)),
      bypass ? INFINITY : Wander(s, volume, s.Variance(model::Channel::kP1), 0),
      bypass ? INFINITY : Wander(s, volume, s.Variance(model::Channel::kP2), 0),
      s.free_arm()
          ? Wander(s, 1 / p.J_a, s.Variance(model::Channel::kArmSpeed), s.Variance(model::Channel::kArmAngle))
          : INFINITY};
  setup->size = setup->states;
  for (size_t b = 0; b < kBalances; ++b) {
    setup->place[b] = -1;
    setup->wander[b] = 0;
    if (!std::isfinite(wander[b])) continue;
    setup->place[b] = setup->size++;
    setup->wander[b] = wander[b];
  }
}

// Makes each sensor's reading a linear function of the states. A valve feels the pressure, not the reading,
// so observed pressures are scaled back to the pressure.
void LineariseSensors(const model::Equations& equations, Setup* setup) {
  double state[model::kMaxStates];
  model::Mode mode;
  setup->Begin(equations, state, &mode);
  const model::LinearModel linear = model::Linearise(equations, setup->time[0], 0, mode, state);
  for (Sensor& sensor : setup->sensors) {
    const size_t channel = static_cast<size_t>(sensor.channel);
    sensor.row = Vector::Zero(setup->size);
    for (int j = 0; j < setup->states; ++j) sensor.row[j] = linear.C[channel + j * model::kChannels];
    if (sensor.channel != model::Channel::kP1 && sensor.channel != model::Channel::kP2) continue;
    const bool first = sensor.channel == model::Channel::kP1;
    const int at = first ? model::kP1 : model::kP2;
    const double gain = sensor.row[at];
    std::vector<double>& observed = first ? setup->observed.p1 : setup->observed.p2;
    if (gain == 0) {
      observed.clear();  // it reads the pressure through a state of its own
      continue;
    }
    for (size_t k = 0; k < observed.size();
         ++k) {  // a drifting sensor's offset differs from sample to sample
      const model::Measurement reading = equations.Measure(setup->time[k], state);
      const double offset = model::ChannelOf(reading, channel) - gain * state[at];
      observed[k] = (observed[k] - offset) / gain;
    }
  }
}

}  // namespace

model::ActuatorOptions OptionsOf(const RunData& run) {
  model::ActuatorOptions options;
  options.shaft = run.stimulus.shaft;
  options.arm_angle =
      run.stimulus.shaft == model::Shaft::kFree ? run.start[model::kArmAngle] : run.stimulus.arm_angle;
  options.motion = run.stimulus.motion;
  options.bypass = run.stimulus.bypass;
  options.begin = run.stimulus.begin;
  return options;
}

double Setup::Variance(model::Channel channel) const {
  for (const Sensor& sensor : sensors) {
    if (sensor.channel == channel) return sensor.variance;
  }
  return 0;
}

void Setup::Begin(const model::Equations& equations, double* state, model::Mode* mode) const {
  const double pressure = std::max({run.start[model::kP1], run.start[model::kP2], model.parameters.p_3});
  equations.Start(pressure, state, mode);
  const int base = free_arm() ? 6 : 4;
  for (int i = 0; i < base; ++i) state[i] = run.start[i];
}

Setup MakeSetup(const model::ModelDescription& model, const RunData& run, const PressureOffsets& offsets) {
  Setup setup{.model = model,
              .run = run,
              .time = run.stimulus.time,
              .interval = MedianInterval(run.stimulus.time),
              .options = OptionsOf(run),
              .observed = ObserveMode(run),
              .sensors = {}};
  const model::Equations equations(model, setup.options);
  setup.states = equations.states();
  for (double& p : setup.observed.p1) p -= offsets.p1;
  for (double& p : setup.observed.p2) p -= offsets.p2;
  ChooseSensors(offsets, &setup);
  ChooseBalances(&setup);
  LineariseSensors(equations, &setup);
  return setup;
}

}  // namespace hydro::diagnose::smoother
