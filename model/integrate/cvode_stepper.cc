#include "model/integrate/cvode_stepper.h"

#include <cvode/cvode.h>

#include <algorithm>

namespace hydro::model {

namespace {

// Backward differences accumulate more of the local errors than the other paths do. With this share of the
// tolerance all three agree equally well.
constexpr double kErrorShare = 0.03;

int SundialsJacobian(double time, N_Vector state, N_Vector, SUNMatrix jacobian, void* data, N_Vector,
                     N_Vector, N_Vector) {
  const auto& problem = *static_cast<const SundialsProblem*>(data);
  problem.equations->Jacobian(time, *problem.voltage, *problem.mode, N_VGetArrayPointer(state),
                              SUNDenseMatrix_Data(jacobian));
  return 0;
}

}  // namespace

CvodeStepper::CvodeStepper(const Mode* mode, const double* voltage, Equations* equations,
                           double relative_tolerance)
    : problem_{equations, mode, voltage, {}},
      context_(MakeSundialsContext()),
      state_(MakeNVector(equations->states(), context_.get())) {
  const int n = equations->states();
  matrix_ = SUNDenseMatrix(n, n, context_.get());
  solver_ = SUNLinSol_Dense(state_.get(), matrix_, context_.get());
  memory_ = CVodeCreate(CV_BDF, context_.get());
  NVector floor = MakeNVector(n, context_.get());
  const double local_tolerance = kErrorShare * relative_tolerance;
  for (int i = 0; i < n; ++i) {
    N_VGetArrayPointer(floor.get())[i] = local_tolerance * equations->scales()[i];
  }
  int flags = memory_ == nullptr || solver_ == nullptr ? -1 : 0;
  if (flags == 0) {
    flags |= CVodeSetErrHandlerFn(memory_, KeepComplaint, &problem_);
    flags |= CVodeSetUserData(memory_, &problem_);
    flags |= CVodeInit(memory_, SundialsRates, 0, state_.get());
    flags |= CVodeSetMaxStep(memory_, kLongestStep);
    flags |= CVodeSVtolerances(memory_, local_tolerance, floor.get());
    flags |= CVodeSetLinearSolver(memory_, solver_, matrix_);
    flags |= CVodeSetJacFn(memory_, SundialsJacobian);
  }
  if (flags != 0) {
    Free();
    throw ModelError("CVODE could not be set up: " + problem_.complaint);
  }
}

CvodeStepper::~CvodeStepper() { Free(); }

void CvodeStepper::Free() {
  if (memory_ != nullptr) CVodeFree(&memory_);
  if (solver_ != nullptr) SUNLinSolFree(solver_);
  if (matrix_ != nullptr) SUNMatDestroy(matrix_);
}

void CvodeStepper::Restart(const Point& now) {
  std::copy_n(now.state, problem_.equations->states(), N_VGetArrayPointer(state_.get()));
  const int flag = CVodeReInit(memory_, now.time, state_.get());
  if (flag != CV_SUCCESS) ThrowStepFailed("CVODE", problem_, flag, now);
}

void CvodeStepper::Step(const Point& now, double stop, Point* next) {
  stepped_by_euler_ = TooShort(now.time, stop);
  if (stepped_by_euler_) {
    EulerStep(*problem_.equations, now, stop, next);
    FillPoint(problem_, next);
    Restart(*next);
    return;
  }
  double time = now.time;
  int flag = CVodeSetStopTime(memory_, stop);
  if (flag == CV_SUCCESS) flag = CVode(memory_, stop, state_.get(), &time, CV_ONE_STEP);
  if (flag == CV_ERR_FAILURE || flag == CV_CONV_FAILURE) {  // after a jump the history may be useless
    Restart(now);
    flag = CVodeSetStopTime(memory_, stop);
    if (flag == CV_SUCCESS) flag = CVode(memory_, stop, state_.get(), &time, CV_ONE_STEP);
  }
  if (flag < 0) ThrowStepFailed("CVODE", problem_, flag, now);
  next->time = flag == CV_TSTOP_RETURN ? stop : time;
  TakeState(now, next);
  FillPoint(problem_, next);
}

void CvodeStepper::Interpolate(const Point& now, const Point& /*next*/, double time, Point* at) {
  if (stepped_by_euler_) {
    EulerStep(*problem_.equations, now, time, at);
    return;
  }
  const int flag = CVodeGetDky(memory_, time, 0, state_.get());
  if (flag != CV_SUCCESS) ThrowStepFailed("CVODE", problem_, flag, now);
  at->time = time;
  TakeState(now, at);
}

void CvodeStepper::TakeState(const Point& now, Point* at) const {
  std::copy_n(N_VGetArrayPointer(state_.get()), problem_.equations->states(), at->state);
  // What the mode holds still stays still to the last bit, whatever the linear solver's rounding.
  const Mode& mode = *problem_.mode;
  if (mode.pump == 0) {
    at->state[kMotorAngle] = now.state[kMotorAngle];
    at->state[kMotorSpeed] = now.state[kMotorSpeed];
  }
  const EquationData& data = problem_.equations->data();
  // A pressure that an open valve holds at a moving p_3 is set to that p_3.
  const auto held = [&](int i) { return data.p_3_state < 0 ? now.state[i] : at->state[data.p_3_state]; };
  if (mode.valve_1) at->state[kP1] = held(kP1);
  if (mode.valve_2 || (data.bypass && mode.valve_1)) at->state[kP2] = held(kP2);
}

}  // namespace hydro::model
