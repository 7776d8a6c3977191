#include "model/integrate/simulation.h"

#include <memory>

#include "model/integrate/fast_stepper.h"
#include "model/integrate/mode_machine.h"
#include "model/integrate/sundials_steppers.h"

namespace hydro::model {
namespace {

// Integrator::kAuto: Runge-Kutta until stability limits its steps, then CVODE until the mode changes. A
// template, for .cc files of model/ only.

// A stepper as ModeMachine expects it.
template <Form kForm>
class AutoStepper {
 public:
  AutoStepper(const Mode* mode, const double* voltage, Equations* equations, double relative_tolerance)
      : mode_(mode),
        voltage_(voltage),
        equations_(equations),
        tolerance_(relative_tolerance),
        fast_(mode, voltage, equations, relative_tolerance) {}

  void Restart(const Point& now) {
    stiff_ = false;
    fast_.Restart(now);
  }
  void NewVoltage(const Point& now) {
    if (stiff_) {
      cvode_->NewVoltage(now);
    } else {
      fast_.NewVoltage(now);
    }
  }
  Integrator in_use() const { return stiff_ ? Integrator::kCvode : Integrator::kFast; }
  void Step(const Point& now, double stop, Point* next) {
    if (!stiff_ && fast_.stiff()) [[unlikely]] {
      stiff_ = true;
      if (!cvode_) cvode_ = std::make_unique<CvodeStepper>(mode_, voltage_, equations_, tolerance_);
      cvode_->Restart(now);
    }
    if (stiff_) [[unlikely]] {
      cvode_->Step(now, stop, next);
    } else {
      fast_.Step(now, stop, next);
    }
  }
  bool Trusts(const Point& now, const Point& at) const { return stiff_ || fast_.Trusts(now, at); }
  void Interpolate(const Point& now, const Point& next, double time, Point* at) {
    if (stiff_) {
      cvode_->Interpolate(now, next, time, at);
    } else {
      fast_.Interpolate(now, next, time, at);
    }
  }

 private:
  const Mode* mode_;
  const double* voltage_;
  Equations* equations_;
  double tolerance_;
  bool stiff_ = false;
  FastStepper<kForm> fast_;
  std::unique_ptr<CvodeStepper> cvode_;
};

template <Form kForm, class Stepper>
class SimulationOf final : public Simulation {
 public:
  SimulationOf(Equations* equations, double time, const double* state, const Mode& mode,
               double relative_tolerance)
      : machine_(equations, &equations->data(), relative_tolerance) {
    machine_.Start(time, state, mode);
  }

  void Advance(double voltage, double until) override { machine_.Advance(voltage, until); }
  void MoveArm(double angle, double speed) override { machine_.MoveArm(angle, speed); }
  void NewLoad() override { machine_.NewLoad(); }
  const Point& now() const override { return machine_.now(); }
  const Mode& mode() const override { return machine_.mode(); }
  double voltage() const override { return machine_.voltage(); }
  const StateHistory<double>* history() const override { return machine_.history(); }
  int64_t mode_changes() const override { return machine_.mode_changes(); }
  Integrator in_use() const override { return machine_.in_use(); }

 private:
  ModeMachine<double, kForm, Stepper> machine_;
};

template <template <Form> class Stepper>
std::unique_ptr<Simulation> MakeForForm(Equations* equations, double time, const double* state,
                                        const Mode& mode, double relative_tolerance) {
  const auto make = [&]<Form kForm>() -> std::unique_ptr<Simulation> {
    return std::make_unique<SimulationOf<kForm, Stepper<kForm>>>(equations, time, state, mode,
                                                                 relative_tolerance);
  };
  if (!equations->plain()) return make.template operator()<Form::kGeneral>();
  if (equations->data().loaded) return make.template operator()<Form::kPlainLoaded>();
  if (equations->data().shaft == Shaft::kFree) return make.template operator()<Form::kPlainFree>();
  return make.template operator()<Form::kPlainClamped>();
}

}  // namespace

std::unique_ptr<Simulation> MakeSimulationFrom(Equations* equations, Integrator integrator, double time,
                                               const double* state, const Mode& mode,
                                               double relative_tolerance) {
  if (!(relative_tolerance > 0 && relative_tolerance < 1)) {
    throw ModelError("relative tolerance " + std::to_string(relative_tolerance) +
                     "; allowed is above 0 and below 1");
  }
  switch (integrator) {
    case Integrator::kErk:
      return std::make_unique<SimulationOf<Form::kGeneral, ErkStepper>>(equations, time, state, mode,
                                                                        relative_tolerance);
    case Integrator::kCvode:
      return std::make_unique<SimulationOf<Form::kGeneral, CvodeStepper>>(equations, time, state, mode,
                                                                          relative_tolerance);
    case Integrator::kFast:
      return MakeForForm<FastStepper>(equations, time, state, mode, relative_tolerance);
    case Integrator::kAuto:
      break;
  }
  return MakeForForm<AutoStepper>(equations, time, state, mode, relative_tolerance);
}

std::unique_ptr<Simulation> MakeSimulation(Equations* equations, Integrator integrator,
                                           double initial_pressure, double relative_tolerance) {
  double state[kMaxStates];
  Mode mode;
  equations->Start(initial_pressure, state, &mode);
  return MakeSimulationFrom(equations, integrator, 0, state, mode, relative_tolerance);
}

}  // namespace hydro::model
