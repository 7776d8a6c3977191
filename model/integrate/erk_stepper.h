// Integrator::kErk: ARKODE's ERKStep with the Dormand-Prince pair of orders 5 and 4.
#pragma once

#include "model/integrate/simulation.h"
#include "model/integrate/sundials.h"

namespace hydro::model {

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
