// Runs of a rig with noisy sensors: what the model of the rig simulates, with noise and an encoder's steps.
#pragma once

#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/response.h"
#include "tests/diagnose/prepare_run.h"

namespace hydro::testing {

struct NoisyRig {
  model::ModelDescription model;
  double pressure_noise = 1.5, speed_noise = 0.3;
  int encoder_bits = 14;
  uint64_t seed = 1;
  double step = 1e-3;                                 // s between samples
  bool speed_measured = true, angle_measured = true;  // of the motor
  double turn = 0;  // rad: where the shaft starts, as the angle sensor does not see it

  // `voltage` as a function of time, held from sample to sample.
  template <class Voltage>
  diagnose::RunData Record(const std::string& name, model::Shaft shaft, double arm_angle, double duration,
                           bool bypass, const Voltage& voltage) const {
    runs::MeasuredRun run;
    run.name = run.file = name;
    run.shaft = shaft;
    run.arm_angle_rad = arm_angle;
    run.bypass = bypass;
    const size_t samples = static_cast<size_t>(std::lround(duration / step));
    // The simulation is as fine as the command; the recording may be coarser.
    model::Stimulus stimulus;
    stimulus.shaft = shaft;
    stimulus.arm_angle = arm_angle;
    stimulus.bypass = bypass;
    for (size_t k = 0; k < samples; ++k) {
      stimulus.time.push_back(step * static_cast<double>(k));
      stimulus.voltage.push_back(voltage(stimulus.time.back()));
    }
    const double p_3 = model.parameters.p_3;
    const model::Response response =
        model::Respond(model, stimulus, {0, 0, p_3, p_3, arm_angle, 0, turn}, {}, {});
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double count = 2 * std::numbers::pi / (1 << encoder_bits);
    run.time = stimulus.time;
    run.voltage.values = stimulus.voltage;
    const auto noisy = [&](model::Channel channel, double noise) {
      std::vector<double> values = response.values[static_cast<size_t>(channel)];
      for (double& value : values) value += noise * normal(random);
      return values;
    };
    const auto counted = [&](model::Channel channel) {
      std::vector<double> values = response.values[static_cast<size_t>(channel)];
      for (double& value : values) value = count * std::round(value / count);
      return values;
    };
    if (speed_measured) run.motor_speed.values = noisy(model::Channel::kMotorSpeed, speed_noise);
    if (angle_measured) run.motor_angle.values = counted(model::Channel::kMotorAngle);
    run.p1.values = noisy(model::Channel::kP1, pressure_noise);
    run.p2.values = noisy(model::Channel::kP2, pressure_noise);
    if (shaft == model::Shaft::kFree) run.arm_angle.values = counted(model::Channel::kArmAngle);
    return diagnose::PrepareRun(std::move(run), model.parameters);
  }

  // Levels and a chirp on a clamped shaft, a free arm that swings, and the bypass.
  std::vector<diagnose::RunData> RecordAll() const {
    std::vector<diagnose::RunData> runs;
    const auto levels = [](double t) {
      constexpr double kLevels[] = {0, 3, -2, 6, 1.5, -5, 4, -7, 0.5, -3, 8, 2, -1, 5, 0};
      return kLevels[std::min(14, static_cast<int>(t / 0.2))];
    };
    const auto chirp = [](double t) { return 1 + 5 * std::sin(2 * std::numbers::pi * (0.5 + 2 * t) * t); };
    const auto swing = [](double t) { return std::fmod(2 * t, 1.0) < 0.5 ? 3.0 : -3.0; };
    runs.push_back(Record("levels", model::Shaft::kClamped, 0.1, 3, false, levels));
    runs.push_back(Record("chirp", model::Shaft::kClamped, -0.3, 3, false, chirp));
    runs.push_back(Record("swing", model::Shaft::kFree, -0.2, 3, false, swing));
    runs.push_back(Record("bypass", model::Shaft::kClamped, 0, 2, true, swing));
    return runs;
  }
};

}  // namespace hydro::testing
