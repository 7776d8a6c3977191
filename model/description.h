// A model as data: the paper's base parameters and the effects added to its equations.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace hydro {

// Base parameters of eqs. (1) to (15), Table 1. Units need only be coherent; those of the paper are given.
struct Parameters {
  double k_1 = 0;     // in-lbf/V, torque per volt, eq. (1)
  double T_pmax = 0;  // in-lbf, limit of |T_p| set by the amplifier's current limit
  double D = 0;       // in^3/rad, pump displacement, eq. (3)
  double J = 0;       // lbf-in-s^2, inertia of motor and pump, eq. (4)
  double b = 0;       // in-lbf-s, viscous friction, eq. (4)
  double T_s = 0;     // in-lbf, Coulomb friction, eq. (4)
  double f = 0;       // in-lbf/psi, Coulomb friction per pressure, eq. (4)
  double beta = 0;    // psi, bulk modulus, eq. (5)
  double V_ms = 0;    // in^3, volume of one side at mid-stroke, eqs. (6), (7)
  double c = 0;       // in^3/rad, displacement of the actuator, r^2 d/2 in eqs. (6), (7)
  double c_E = 0;     // in^3/(s psi), external leakage to the accumulator, eqs. (11), (12)
  double c_I = 0;     // in^3/(s psi), internal leakage across the ports, eqs. (11), (12)
  double p_3 = 0;     // psi, accumulator pressure
  double k_2 = 0;     // in-lbf/psi, arm torque per pressure difference, eq. (15)
  double J_a = 0;     // lbf-in-s^2, inertia of the arm, eq. (15)
  double mgl = 0;     // in-lbf, gravity torque of the arm at alpha = 0, eq. (15)
};

// An effect that a model has, as written in its file: [effects."id"].
struct EffectDescription {
  std::string id;                            // as in docs/effects.md
  std::map<std::string, double> parameters;  // name -> value
  std::map<std::string, std::string> names;  // parameters that are names (a signal)
};

struct ModelDescription {
  std::string name;
  Parameters parameters;
  std::vector<EffectDescription> effects;  // in the file's order
};

// What holds the actuator's shaft.
enum class Shaft { kFree, kClamped, kDriven };

// What integrates the equations between events.
enum class Integrator {
  kAuto,   // kFast while the mode is not stiff, else kCvode
  kFast,   // classical Runge-Kutta with an error estimate, this project's own
  kErk,    // SUNDIALS ARKODE ERKStep, an explicit embedded pair
  kCvode,  // SUNDIALS CVODE, BDF with the exact Jacobian
};

}  // namespace hydro
