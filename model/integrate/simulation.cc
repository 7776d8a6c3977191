#include "model/integrate/simulation.h"

#include "model/integrate/cvode_stepper.h"
#include "model/integrate/erk_stepper.h"
#include "model/integrate/runge_kutta.h"

namespace hydro::model {

namespace {

// Runge-Kutta until its steps are held back by stability, then CVODE until the mode changes.
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
  RungeKutta<kForm> fast_;
  std::unique_ptr<CvodeStepper> cvode_;
};

template <template <Form> class Stepper>
std::unique_ptr<Simulation> MakeForForm(Equations* equations, double initial_pressure,
                                        double relative_tolerance) {
  const auto make = [&]<Form kForm>() -> std::unique_ptr<Simulation> {
    return std::make_unique<SwitchingSimulation<kForm, Stepper<kForm>>>(equations, initial_pressure,
                                                                        relative_tolerance);
  };
  if (!equations->plain()) return make.template operator()<Form::kGeneral>();
  if (equations->data().shaft == Shaft::kFree) return make.template operator()<Form::kPlainFree>();
  return make.template operator()<Form::kPlainClamped>();
}

}  // namespace

std::unique_ptr<Simulation> MakeSimulation(Equations* equations, Integrator integrator,
                                           double initial_pressure, double relative_tolerance) {
  if (!(relative_tolerance > 0 && relative_tolerance < 1)) {
    throw ModelError("relative tolerance " + std::to_string(relative_tolerance) +
                     "; allowed is above 0 and below 1");
  }
  switch (integrator) {
    case Integrator::kErk:
      return std::make_unique<SwitchingSimulation<Form::kGeneral, ErkStepper>>(equations, initial_pressure,
                                                                               relative_tolerance);
    case Integrator::kCvode:
      return std::make_unique<SwitchingSimulation<Form::kGeneral, CvodeStepper>>(equations, initial_pressure,
                                                                                 relative_tolerance);
    case Integrator::kFast:
      return MakeForForm<RungeKutta>(equations, initial_pressure, relative_tolerance);
    case Integrator::kAuto:
      break;
  }
  return MakeForForm<AutoStepper>(equations, initial_pressure, relative_tolerance);
}

}  // namespace hydro::model
