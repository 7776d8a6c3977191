// What the two SUNDIALS steppers share. For .cc files of model/ only.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <memory>
#include <string>

#include "model/equations/equations.h"
#include "model/integrate/simulation.h"

namespace hydro::model {

// User data of SUNDIALS' callbacks, and its last complaint.
struct SundialsProblem {
  const Equations* equations;
  const Mode* mode;
  const double* voltage;
  std::string complaint;
};

struct SundialsContextDeleter {
  void operator()(SUNContext context) const { SUNContext_Free(&context); }
};
using SundialsContext = std::unique_ptr<_SUNContext, SundialsContextDeleter>;
SundialsContext MakeSundialsContext();

struct NVectorDeleter {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
using NVector = std::unique_ptr<_generic_N_Vector, NVectorDeleter>;
NVector MakeNVector(int size, SUNContext context);

// Callbacks: the right-hand side of the present mode (returns 1, "try a smaller step", when it is not
// finite), and the messages.
int SundialsRates(double time, N_Vector state, N_Vector rate, void* problem);
void KeepComplaint(int code, const char* module, const char* function, char* message, void* problem);

// Euler's rule takes the steps that are too short for SUNDIALS to start with; its error, of the order of
// their square, is below rounding.
bool TooShort(double from, double to);
void EulerStep(const Equations& equations, const Point& now, double stop, Point* next);

// Fills rate and margin of `at` from its time and state.
void FillPoint(const SundialsProblem& problem, Point* at);

[[noreturn]] void ThrowStepFailed(const char* integrator, const SundialsProblem& problem, int flag,
                                  const Point& now);

}  // namespace hydro::model
