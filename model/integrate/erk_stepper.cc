#include "model/integrate/erk_stepper.h"

#include <arkode/arkode_erkstep.h>

#include <algorithm>

namespace hydro::model {

ErkStepper::ErkStepper(const Mode* mode, const double* voltage, Equations* equations,
                       double relative_tolerance)
    : problem_{equations, mode, voltage, {}},
      context_(MakeSundialsContext()),
      state_(MakeNVector(equations->states(), context_.get())) {
  memory_ = ERKStepCreate(SundialsRates, 0, state_.get(), context_.get());
  if (memory_ == nullptr) throw ModelError("ARKODE could not be set up");
  NVector floor = MakeNVector(equations->states(), context_.get());
  for (int i = 0; i < equations->states(); ++i) {
    N_VGetArrayPointer(floor.get())[i] = relative_tolerance * equations->scales()[i];
  }
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
  std::copy_n(now.state, problem_.equations->states(), N_VGetArrayPointer(state_.get()));
  const int flag = ERKStepReset(memory_, now.time, state_.get());
  if (flag != ARK_SUCCESS) ThrowStepFailed("ARKODE", problem_, flag, now);
}

void ErkStepper::Step(const Point& now, double stop, Point* next) {
  stepped_by_euler_ = TooShort(now.time, stop);
  if (stepped_by_euler_) {
    EulerStep(*problem_.equations, now, stop, next);
    FillPoint(problem_, next);
    Restart(*next);
    return;
  }
  double time = now.time;
  int flag = ERKStepSetStopTime(memory_, stop);
  if (flag == ARK_SUCCESS) flag = ERKStepEvolve(memory_, stop, state_.get(), &time, ARK_ONE_STEP);
  if (flag < 0) ThrowStepFailed("ARKODE", problem_, flag, now);
  next->time = flag == ARK_TSTOP_RETURN ? stop : time;
  std::copy_n(N_VGetArrayPointer(state_.get()), problem_.equations->states(), next->state);
  FillPoint(problem_, next);
}

void ErkStepper::Interpolate(const Point& now, const Point& /*next*/, double time, Point* at) {
  if (stepped_by_euler_) {
    EulerStep(*problem_.equations, now, time, at);
    return;
  }
  const int flag = ERKStepGetDky(memory_, time, 0, state_.get());
  if (flag != ARK_SUCCESS) ThrowStepFailed("ARKODE", problem_, flag, now);
  at->time = time;
  std::copy_n(N_VGetArrayPointer(state_.get()), problem_.equations->states(), at->state);
}

}  // namespace hydro::model
