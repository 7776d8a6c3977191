// The paper's linear design model of the position loop, Figure 8: PD, closed pressure loop, arm.
#pragma once

#include <complex>
#include <vector>

#include "model/terms/description.h"

namespace hydro::design {

using Complex = std::complex<double>;

// dp/dp_ref = omega^2/(s^2 + 2 zeta omega s + omega^2), alpha/dp = k_2/(J_a s^2), dp_ref = -g (s + zero) e.
// Figure 9 varies g, with c_1 = zero g and c_2 = g.
struct DesignModel {
  double natural_frequency = 150;  // rad/s, omega_n of the pressure loop
  double damping_ratio = 0.5;      // zeta of the pressure loop
  double k_2 = 0;                  // in-lbf/psi
  double J_a = 0;                  // lbf-in-s^2
  double zero = 30;                // 1/s, c_1/c_2
};

// Figure 8's omega_n and zeta with the arm of `parameters`.
DesignModel Figure8Model(const model::Parameters& parameters);

// Where the derivative of eq. (17) acts: on the error, as printed, or on the measured angle alone.
enum class DerivativeForm { kError, kMeasurement };

// Coefficients of the closed loop's characteristic polynomial, [i] that of s^i; the same in both forms.
std::vector<double> CharacteristicPolynomial(const DesignModel& model, double gain);

// Its roots, from left to right, the upper one of a pair first.
std::vector<Complex> Poles(const DesignModel& model, double gain);

// Roots of a polynomial with real coefficients, [i] that of s^i, the highest not 0; sorted as above.
std::vector<Complex> PolynomialRoots(const std::vector<double>& coefficients);

// From left to right, the upper one of a pair first.
void SortPoles(std::vector<Complex>* poles);

// The gain at which a pair of poles lies on the imaginary axis.
struct StabilityLimit {
  double gain = 0;       // g, psi s/rad
  double frequency = 0;  // rad/s
};

// By Routh's criterion in closed form: g = 2 zeta J_a (omega - 2 zeta zero)/k_2 at omega_c^2 = omega (omega -
// 2 zeta zero). A gain of 0 or less means that there is no limit.
StabilityLimit RouthLimit(const DesignModel& model);

// The same gain, found independently by bisection on the poles' real parts.
double CriticalGainOfPoles(const DesignModel& model);

// Frequency responses at s = j frequency: e to alpha, and alpha_ref to alpha.
Complex OpenLoop(const DesignModel& model, double gain, double frequency);
Complex ClosedLoop(const DesignModel& model, double gain, DerivativeForm form, double frequency);

struct Margins {
  double gain = 0;             // gain margin, a factor
  double phase_crossover = 0;  // rad/s, where the phase is -180 degrees
  double phase_deg = 0;        // phase margin, at the gain crossover
  double gain_crossover = 0;   // rad/s, the highest frequency at which the open loop's magnitude is 1
  double bandwidth = 0;        // rad/s, closed loop 3 dB below static gain (derivative on measurement)
};
// Throws std::domain_error when the loop is unstable at this gain.
Margins StabilityMargins(const DesignModel& model, double gain);

}  // namespace hydro::design
