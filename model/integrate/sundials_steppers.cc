#include "model/integrate/sundials_steppers.h"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>

namespace hydro::model {
namespace {

// Backward differences accumulate more of the local errors than the other methods do. With this share of the
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
    : SundialsStepper("CVODE", mode, voltage, equations) {
  const int n = equations->states();
  matrix_ = SUNDenseMatrix(n, n, context_.get());
  solver_ = SUNLinSol_Dense(state_.get(), matrix_, context_.get());
  memory_ = CVodeCreate(CV_BDF, context_.get());
  const double local_tolerance = kErrorShare * relative_tolerance;
  const NVector floor = Floor(local_tolerance);
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
  CopyToSolver(now);
  CheckFlag(CVodeReInit(memory_, now.time, state_.get()), now);
}

void CvodeStepper::Step(const Point& now, double stop, Point* next) {
  if (StepsByEuler(now, stop, next)) {
    Restart(*next);
    return;
  }
  double time = now.time;
  int flag = Evolve(stop, &time);
  if (flag == CV_ERR_FAILURE || flag == CV_CONV_FAILURE) {  // after a jump the history may be useless
    Restart(now);
    flag = Evolve(stop, &time);
  }
  CheckFlag(flag, now);
  next->time = flag == CV_TSTOP_RETURN ? stop : time;
  TakeState(now, next);
  FillPoint(next);
}

int CvodeStepper::Evolve(double stop, double* time) {
  const int flag = CVodeSetStopTime(memory_, stop);
  return flag == CV_SUCCESS ? CVode(memory_, stop, state_.get(), time, CV_ONE_STEP) : flag;
}

void CvodeStepper::Interpolate(const Point& now, const Point& /*next*/, double time, Point* at) {
  if (InterpolatesByEuler(now, time, at)) return;
  CheckFlag(CVodeGetDky(memory_, time, 0, state_.get()), now);
  at->time = time;
  TakeState(now, at);
}

void CvodeStepper::TakeState(const Point& now, Point* at) const {
  CopyFromSolver(at);
  // Whatever the mode keeps constant must stay constant to the last bit, regardless of the linear solver's
  // rounding.
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
