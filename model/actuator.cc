#include "model/actuator.h"

#include "model/equations/equations.h"
#include "model/integrate/simulation.h"
#include "model/start_from.h"

namespace hydro::model {
namespace {

ActuatorOptions At(ActuatorOptions options, const StartState& start) {
  if (options.shaft == Shaft::kFree) options.arm_angle = start[kArmAngle];
  return options;
}

}  // namespace

class Actuator::Impl {
 public:
  Impl(const ModelDescription& description, const ActuatorOptions& options)
      : equations(description, options) {
    simulation =
        MakeSimulation(&equations, options.integrator, options.initial_pressure, options.relative_tolerance);
  }

  Impl(const ModelDescription& description, const ActuatorOptions& options, const StartState& start,
       double time)
      : equations(description, At(options, start)), turn(start[kTurn]) {
    StartState base = start;
    if (options.bypass) base[kP2] = base[kP1];
    double state[kMaxStates];
    const Mode mode = StartFrom<double>(&equations, equations.data(), time, base.data(), state);
    simulation =
        MakeSimulationFrom(&equations, options.integrator, time, state, mode, options.relative_tolerance);
  }

  Equations equations;
  double turn = 0;  // of kTurn: the angle sensor does not see it
  std::unique_ptr<Simulation> simulation;
};

Actuator::Actuator(const ModelDescription& description, const ActuatorOptions& options)
    : impl_(std::make_unique<Impl>(description, options)) {}
Actuator::Actuator(const ModelDescription& description, const ActuatorOptions& options,
                   const StartState& start, double time)
    : impl_(std::make_unique<Impl>(description, options, start, time)) {}
Actuator::~Actuator() = default;
Actuator::Actuator(Actuator&&) noexcept = default;
Actuator& Actuator::operator=(Actuator&&) noexcept = default;

void Actuator::Advance(double voltage, double until) { impl_->simulation->Advance(voltage, until); }

double Actuator::time() const { return impl_->simulation->now().time; }

Measurement Actuator::Measure() const {
  Measurement measured =
      impl_->equations.Measure(time(), impl_->simulation->now().state, impl_->simulation->history());
  measured.motor_angle -= impl_->turn;
  return measured;
}

}  // namespace hydro::model
