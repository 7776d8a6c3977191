#include "model/integrate/sundials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/integrate/point.h"

namespace hydro::model {
namespace {

SundialsContext MakeSundialsContext() {
  SUNContext context = nullptr;
  if (SUNContext_Create(nullptr, &context) != 0) throw ModelError("SUNDIALS has no context to give");
  return SundialsContext(context);
}

NVector MakeNVector(int size, SUNContext context) {
  N_Vector vector = N_VNew_Serial(size, context);
  if (vector == nullptr) throw ModelError("SUNDIALS has no vector to give");
  N_VConst(0, vector);
  return NVector(vector);
}

bool TooShort(double from, double to) {
  return to - from < std::max(1e-11, 64 * std::numeric_limits<double>::epsilon() * std::abs(to));
}

void EulerStep(const Equations& equations, const Point& now, double stop, Point* next) {
  next->time = stop;
  for (int i = 0; i < equations.states(); ++i)
    next->state[i] = now.state[i] + (stop - now.time) * now.rate[i];
}

}  // namespace

int SundialsRates(double time, N_Vector state, N_Vector rate, void* data) {
  const auto& problem = *static_cast<const SundialsProblem*>(data);
  double* out = N_VGetArrayPointer(rate);
  problem.equations->Rates(time, *problem.voltage, *problem.mode, N_VGetArrayPointer(state), out);
  double sum = 0;
  for (int i = 0; i < problem.equations->states(); ++i) sum += out[i];
  return std::isfinite(sum) ? 0 : 1;
}

void KeepComplaint(int code, const char* /*module*/, const char* /*function*/, char* message, void* data) {
  if (code < 0) static_cast<SundialsProblem*>(data)->complaint = message;
}

SundialsStepper::SundialsStepper(const char* name, const Mode* mode, const double* voltage,
                                 const Equations* equations)
    : problem_{equations, mode, voltage, {}},
      context_(MakeSundialsContext()),
      state_(MakeNVector(equations->states(), context_.get())),
      name_(name) {}

NVector SundialsStepper::Floor(double relative_tolerance) const {
  const Equations& equations = *problem_.equations;
  NVector floor = MakeNVector(equations.states(), context_.get());
  for (int i = 0; i < equations.states(); ++i) {
    N_VGetArrayPointer(floor.get())[i] = relative_tolerance * equations.scales()[i];
  }
  return floor;
}

void SundialsStepper::CopyToSolver(const Point& now) {
  std::copy_n(now.state, problem_.equations->states(), N_VGetArrayPointer(state_.get()));
}

void SundialsStepper::CopyFromSolver(Point* at) const {
  std::copy_n(N_VGetArrayPointer(state_.get()), problem_.equations->states(), at->state);
}

bool SundialsStepper::StepsByEuler(const Point& now, double stop, Point* next) {
  stepped_by_euler_ = TooShort(now.time, stop);
  if (!stepped_by_euler_) return false;
  EulerStep(*problem_.equations, now, stop, next);
  FillPoint(next);
  return true;
}

bool SundialsStepper::InterpolatesByEuler(const Point& now, double time, Point* at) const {
  if (stepped_by_euler_) EulerStep(*problem_.equations, now, time, at);
  return stepped_by_euler_;
}

void SundialsStepper::FillPoint(Point* at) const {
  problem_.equations->Rates(at->time, *problem_.voltage, *problem_.mode, at->state, at->rate, at->margin);
}

void SundialsStepper::CheckFlag(int flag, const Point& now) const {
  if (flag >= 0) return;
  std::string complaint = problem_.complaint;
  std::replace(complaint.begin(), complaint.end(), '\n', ' ');
  throw ModelError(std::string("the step of ") + name_ + " failed (" + std::to_string(flag) + ": " +
                   complaint + ")" + Where(*problem_.equations, now));
}

}  // namespace hydro::model
