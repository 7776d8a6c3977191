// Integrator::kErk: ARKODE's ERKStep with the Dormand-Prince pair of orders 5 and 4.
#pragma once

#include "model/integrate/simulation.h"
#include "model/integrate/sundials.h"

namespace hydro::model {

class ErkStepper {
 public:
  ErkStepper(const Mode* mode, const double* voltage, Equations* equations, double relative_tolerance);
  ~ErkStepper();
  ErkStepper(const ErkStepper&) = delete;
  ErkStepper& operator=(const ErkStepper&) = delete;

  Integrator in_use() const { return Integrator::kErk; }
  void Restart(const Point& now);
  // An explicit pair keeps nothing from earlier steps that is worth more than a fresh start.
  void NewVoltage(const Point& now) { Restart(now); }
  void Step(const Point& now, double stop, Point* next);
  bool Trusts(const Point& /*now*/, const Point& /*at*/) const { return true; }  // as accurate as its steps
  void Interpolate(const Point& now, const Point& next, double time, Point* at);

 private:
  SundialsProblem problem_;
  SundialsContext context_;
  NVector state_;
  void* memory_ = nullptr;
  bool stepped_by_euler_ = false;
};

}  // namespace hydro::model
