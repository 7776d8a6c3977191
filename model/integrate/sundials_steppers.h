// SUNDIALS' integrators as steppers: CVODE for stiff modes, ERKStep for the others.
#pragma once

#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "model/integrate/simulation.h"
#include "model/integrate/sundials.h"

namespace hydro::model {

// Integrator::kCvode: CVODE's backward differences with the exact Jacobian, for stiff modes.
class CvodeStepper : SundialsStepper {
 public:
  CvodeStepper(const Mode* mode, const double* voltage, Equations* equations, double relative_tolerance);
  ~CvodeStepper();

  using SundialsStepper::Trusts;
  Integrator in_use() const { return Integrator::kCvode; }
  void Restart(const Point& now);
  // Keeping the history over a jump of the voltage was measured to be cheaper than a fresh start at order 1.
  // It is no less accurate, because the error test sees the jump.
  void NewVoltage(const Point&) {}
  void Step(const Point& now, double stop, Point* next);
  void Interpolate(const Point& now, const Point& next, double time, Point* at);

 private:
  void Free();
  int Evolve(double stop, double* time);
  void TakeState(const Point& now, Point* at) const;

  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
};

// Integrator::kErk: ARKODE's ERKStep with the Dormand-Prince pair of orders 5 and 4.
class ErkStepper : SundialsStepper {
 public:
  ErkStepper(const Mode* mode, const double* voltage, Equations* equations, double relative_tolerance);
  ~ErkStepper();

  using SundialsStepper::Trusts;
  Integrator in_use() const { return Integrator::kErk; }
  void Restart(const Point& now);
  // An explicit pair gains no more from earlier steps than from a fresh start.
  void NewVoltage(const Point& now) { Restart(now); }
  void Step(const Point& now, double stop, Point* next);
  void Interpolate(const Point& now, const Point& next, double time, Point* at);
};

}  // namespace hydro::model
