#include "model/integrate/sundials.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/integrate/where.h"

namespace hydro::model {

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

bool TooShort(double from, double to) {
  return to - from < std::max(1e-11, 64 * std::numeric_limits<double>::epsilon() * std::abs(to));
}

void EulerStep(const Equations& equations, const Point& now, double stop, Point* next) {
  next->time = stop;
  for (int i = 0; i < equations.states(); ++i)
    next->state[i] = now.state[i] + (stop - now.time) * now.rate[i];
}

void FillPoint(const SundialsProblem& problem, Point* at) {
  problem.equations->Rates(at->time, *problem.voltage, *problem.mode, at->state, at->rate, at->margin);
}

void ThrowStepFailed(const char* integrator, const SundialsProblem& problem, int flag, const Point& now) {
  std::string complaint = problem.complaint;
  std::replace(complaint.begin(), complaint.end(), '\n', ' ');
  throw ModelError(std::string("the step of ") + integrator + " failed (" + std::to_string(flag) + ": " +
                   complaint + ")" + Where(*problem.equations, now));
}

}  // namespace hydro::model
