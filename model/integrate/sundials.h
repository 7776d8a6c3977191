// The part of SUNDIALS that its two steppers use. For .cc files of model/ only.
#pragma once

#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <memory>
#include <string>

#include "model/equations/equations.h"
#include "model/integrate/simulation.h"

namespace hydro::model {

// User data of SUNDIALS' callbacks, and its last error message.
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

struct NVectorDeleter {
  void operator()(N_Vector vector) const { N_VDestroy(vector); }
};
using NVector = std::unique_ptr<_generic_N_Vector, NVectorDeleter>;

// Callbacks: the right-hand side of the current mode (returns 1, "try a smaller step", when it is not
// finite), and the handler of messages.
int SundialsRates(double time, N_Vector state, N_Vector rate, void* problem);
void KeepComplaint(int code, const char* module, const char* function, char* message, void* problem);

// What both steppers share: the solver's state vector, steps that are too short for the solver, and failures.
class SundialsStepper {
 public:
  SundialsStepper(const SundialsStepper&) = delete;
  SundialsStepper& operator=(const SundialsStepper&) = delete;

  bool Trusts(const Point& /*now*/, const Point& /*at*/) const { return true; }  // as accurate as the steps

 protected:
  // `name` is the solver's name, for errors.
  SundialsStepper(const char* name, const Mode* mode, const double* voltage, const Equations* equations);
  ~SundialsStepper() = default;

  // A vector of the absolute tolerances.
  NVector Floor(double relative_tolerance) const;

  void CopyToSolver(const Point& now);
  void CopyFromSolver(Point* at) const;

  // Takes the step by Euler's rule when it is too short for the solver to start with. The rule's error, of
  // the order of the step's square, is then below rounding. Returns false when the step is long enough, and
  // has then done nothing.
  bool StepsByEuler(const Point& now, double stop, Point* next);
  // The same for a time within the last step.
  bool InterpolatesByEuler(const Point& now, double time, Point* at) const;

  void FillPoint(Point* at) const;  // rate and margin, from its time and state

  // Throws when `flag`, returned by a function of the solver, is an error.
  void CheckFlag(int flag, const Point& now) const;

  SundialsProblem problem_;
  SundialsContext context_;
  NVector state_;
  void* memory_ = nullptr;  // owned by the solver

 private:
  const char* name_;
  bool stepped_by_euler_ = false;
};

}  // namespace hydro::model
