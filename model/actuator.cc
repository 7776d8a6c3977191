#include "model/actuator.h"

#include "model/equations/equations.h"
#include "model/integrate/simulation.h"

namespace hydro::model {

class Actuator::Impl {
 public:
  Impl(const ModelDescription& description, const ActuatorOptions& options)
      : equations(description, options) {
    simulation =
        MakeSimulation(&equations, options.integrator, options.initial_pressure, options.relative_tolerance);
    history = simulation->history();
  }

  Equations equations;
  std::unique_ptr<Simulation> simulation;
  const StateHistory<double>* history = nullptr;
};

Actuator::Actuator(const ModelDescription& description, const ActuatorOptions& options)
    : impl_(std::make_unique<Impl>(description, options)) {}
Actuator::~Actuator() = default;
Actuator::Actuator(Actuator&&) noexcept = default;
Actuator& Actuator::operator=(Actuator&&) noexcept = default;

void Actuator::Advance(double voltage, double until) { impl_->simulation->Advance(voltage, until); }

double Actuator::time() const { return impl_->simulation->now().time; }

Measurement Actuator::Measure() const {
  return impl_->equations.Measure(time(), impl_->simulation->now().state, impl_->history);
}

}  // namespace hydro::model
