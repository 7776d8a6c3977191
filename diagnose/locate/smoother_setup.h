// What the smoother works with on one run: the sensors that it reads, the states that it estimates, and how
// much each balance's disturbance may wander. Only for the smoother's own files: it exposes Eigen's types.
#pragma once

#include <array>
#include <vector>

#include "diagnose/data/observed_mode.h"
#include "diagnose/data/run_data.h"
#include "diagnose/locate/disturbance_smoother.h"
#include "diagnose/locate/smoother_record.h"
#include "model/equations/equations.h"

namespace hydro::diagnose::smoother {

struct Sensor {
  model::Channel channel = model::Channel::kP1;
  const std::vector<double>* values = nullptr;
  double offset = 0, variance = 0;
  // How many samples each reading stays the same; empty where noise hides the steps.
  std::vector<float> repeats;
  Vector row;  // d reading/d state
  std::array<std::vector<float>, kNoiseDraws> noise;
};

// Keeps references to the model and the run.
struct Setup {
  const model::ModelDescription& model;
  const RunData& run;
  const std::vector<double>& time;
  double interval = 0;  // s, the median
  model::ActuatorOptions options;
  ObservedMode observed;  // pressures as the valves feel them
  std::vector<Sensor> sensors;
  int states = 0;                      // of the model
  int size = 0;                        // with the disturbances
  std::array<int, kBalances> place{};  // index of each disturbance among the states; -1: none
  std::array<double, kBalances> wander{};

  bool free_arm() const { return run.stimulus.shaft == model::Shaft::kFree; }
  // 0 where the channel is not measured.
  double Variance(model::Channel channel) const;
  // Sets the state that the run begins with.
  void Begin(const model::Equations& equations, double* state, model::Mode* mode) const;
};

// The conditions of a run.
model::ActuatorOptions OptionsOf(const RunData& run);

Setup MakeSetup(const model::ModelDescription& model, const RunData& run, const PressureOffsets& offsets);

}  // namespace hydro::diagnose::smoother
