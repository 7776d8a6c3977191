// What Actuator holds: one model in motion, whatever integrates it.
#pragma once

#include <cstdint>
#include <memory>

#include "model/equations/equations.h"

namespace hydro::model {

// A state with all that is known at it.
struct Point {
  double time = 0;
  alignas(16) double state[kMaxStates] = {};
  alignas(16) double rate[kMaxStates] = {};
  double margin[kMaxSwitches] = {};
};

// No step is longer, so that a switch which changes and changes back is not stepped over.
inline constexpr double kLongestStep = 1e-2;  // s

// The same where states between the steps are read.
inline constexpr double kLongestStepToRead = 2e-3;  // s

class Simulation {
 public:
  virtual ~Simulation() = default;

  // As Actuator::Advance.
  virtual void Advance(double voltage, double until) = 0;

  virtual const Point& now() const = 0;
  virtual const Mode& mode() const = 0;

  // The states that channels which read late need; null when there are none.
  virtual const StateHistory<double>* history() const = 0;

  // Switches that have changed since the start.
  virtual int64_t mode_changes() const = 0;

  // What integrates at present: kFast, kErk or kCvode.
  virtual Integrator in_use() const = 0;
};

// `equations` must outlive it, and belongs to it while it runs (SetMotionLimit). Throws ModelError.

std::unique_ptr<Simulation> MakeSimulation(Equations* equations, Integrator integrator,
                                           double initial_pressure, double relative_tolerance);

}  // namespace hydro::model
