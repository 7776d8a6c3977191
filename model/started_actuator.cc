#include "model/started_actuator.h"

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

class StartedActuator::Impl {
 public:
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
  double turn;
  std::unique_ptr<Simulation> simulation;
};

StartedActuator::StartedActuator(const ModelDescription& description, const ActuatorOptions& options,
                                 const StartState& start, double time)
    : impl_(std::make_unique<Impl>(description, options, start, time)) {}
StartedActuator::~StartedActuator() = default;
StartedActuator::StartedActuator(StartedActuator&&) noexcept = default;
StartedActuator& StartedActuator::operator=(StartedActuator&&) noexcept = default;

void StartedActuator::Advance(double voltage, double until) { impl_->simulation->Advance(voltage, until); }

double StartedActuator::time() const { return impl_->simulation->now().time; }

Measurement StartedActuator::Measure() const {
  Measurement measured =
      impl_->equations.Measure(time(), impl_->simulation->now().state, impl_->simulation->history());
  measured.motor_angle -= impl_->turn;
  return measured;
}

}  // namespace hydro::model
