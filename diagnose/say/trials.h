// The experiments that the user may be asked for next, and the configuration of each.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/response.h"
#include "model/trajectory/trajectory.h"

namespace hydro::diagnose {

// The range that the rig has covered, and the precision of its sensors.
struct Rig {
  double voltage = 0, pressure = 0, speed = 0;
  double low_angle = std::numeric_limits<double>::infinity(), high_angle = -low_angle;
  bool free = false;                             // the arm, in some run
  std::array<double, model::kChannels> noise{};  // 0: not measured
};

Rig Inspect(const std::vector<const RunData*>& runs);

// One experiment on voltage, with the shaft free or clamped.
struct Trial {
  model::Shaft shaft = model::Shaft::kClamped;
  double arm_angle = 0;
  bool bypass = false;
  std::string reference;  // keys of the [reference] table
  std::shared_ptr<const trajectory::Trajectory> voltage;
  double separation = 0;
};

// Steps, sines and chirps of several sizes within the range that the rig has been driven, for each way to
// hold the shaft.
std::vector<Trial> Trials(const Rig& rig, const model::Parameters& p);

model::Stimulus StimulusOf(const Trial& trial);

// The stack configuration that runs the trial on the model of model.toml.
std::string Configuration(const Trial& trial, const Rig& rig);

}  // namespace hydro::diagnose
