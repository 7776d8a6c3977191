#include "model/integrate/erk_stepper.h"

#include <arkode/arkode_erkstep.h>

namespace hydro::model {

ErkStepper::ErkStepper(const Mode* mode, const double* voltage, Equations* equations,
                       double relative_tolerance)
    : SundialsStepper("ARKODE", mode, voltage, equations) {
  memory_ = ERKStepCreate(SundialsRates, 0, state_.get(), context_.get());
  if (memory_ == nullptr) throw ModelError("ARKODE could not be set up");
  const NVector floor = Floor(relative_tolerance);
  int flags = ERKStepSetErrHandlerFn(memory_, KeepComplaint, &problem_);
  flags |= ERKStepSetUserData(memory_, &problem_);
  flags |= ERKStepSetTableNum(memory_, ARKODE_DORMAND_PRINCE_7_4_5);
  flags |= ERKStepSetMaxStep(memory_, kLongestStep);
  flags |= ERKStepSVtolerances(memory_, relative_tolerance, floor.get());
  if (flags != 0) {
    ERKStepFree(&memory_);
    throw ModelError("ARKODE could not be set up: " + problem_.complaint);
  }
}

ErkStepper::~ErkStepper() { ERKStepFree(&memory_); }

void ErkStepper::Restart(const Point& now) {
  CopyToSolver(now);
  CheckFlag(ERKStepReset(memory_, now.time, state_.get()), now);
}

void ErkStepper::Step(const Point& now, double stop, Point* next) {
  if (StepsByEuler(now, stop, next)) {
    Restart(*next);
    return;
  }
  double time = now.time;
  int flag = ERKStepSetStopTime(memory_, stop);
  if (flag == ARK_SUCCESS) flag = ERKStepEvolve(memory_, stop, state_.get(), &time, ARK_ONE_STEP);
  CheckFlag(flag, now);
  next->time = flag == ARK_TSTOP_RETURN ? stop : time;
  CopyFromSolver(next);
  FillPoint(next);
}

void ErkStepper::Interpolate(const Point& now, const Point& /*next*/, double time, Point* at) {
  if (InterpolatesByEuler(now, time, at)) return;
  CheckFlag(ERKStepGetDky(memory_, time, 0, state_.get()), now);
  at->time = time;
  CopyFromSolver(at);
}

}  // namespace hydro::model
