// Integrator::kAuto: Runge-Kutta until stability limits its steps, then CVODE until the mode changes. A
// template, for .cc files of model/ only.
#pragma once

#include <memory>

#include "model/integrate/cvode_stepper.h"
#include "model/integrate/fast_stepper.h"

namespace hydro::model {

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

}  // namespace hydro::model
