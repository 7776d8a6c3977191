// What Actuator holds: one model in motion, with any integrator.
#pragma once

#include <cstdint>
#include <memory>

#include "model/equations/equations.h"
#include "model/integrate/point.h"

namespace hydro::model {

class Simulation {
 public:
  virtual ~Simulation() = default;

  // As Actuator::Advance.
  virtual void Advance(double voltage, double until) = 0;

  // For a free shaft. MoveArm moves the arm to a nearby position (Equations::MoveArm). NewLoad makes the
  // simulation use the load that the equations have received (SetLoad).
  virtual void MoveArm(double angle, double speed) = 0;
  virtual void NewLoad() = 0;

  virtual const Point& now() const = 0;
  virtual const Mode& mode() const = 0;
  virtual double voltage() const = 0;  // the voltage that is held

  // The states that late channels need; null when no channel is late.
  virtual const StateHistory<double>* history() const = 0;

  // The number of switch changes since the start.
  virtual int64_t mode_changes() const = 0;

  // The integrator in use: kFast, kErk or kCvode.
  virtual Integrator in_use() const = 0;
};

// `equations` must outlive the simulation. While the simulation runs, only it may use the equations: it calls
// Equations::Command and PassStop. Throws ModelError.
std::unique_ptr<Simulation> MakeSimulation(Equations* equations, Integrator integrator,
                                           double initial_pressure, double relative_tolerance);

// The same from any state: `state` has all of the equations' states, and `mode` settles with the first
// voltage.
std::unique_ptr<Simulation> MakeSimulationFrom(Equations* equations, Integrator integrator, double time,
                                               const double* state, const Mode& mode,
                                               double relative_tolerance);

}  // namespace hydro::model
