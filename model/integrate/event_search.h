// Finds where in a step a switch reaches its boundary. Pure functions of numbers and of a margin g(t), which
// is not negative while the switch may keep its position.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/equations/evaluate.h"
#include "model/integrate/point.h"

namespace hydro::model {

// A margin at both ends of a step of length h.
struct MarginEnds {
  double g_0, slope_0;
  double g_1, slope_1;
};

// For a margin that falls at the start and rises at the end: the time from the start at which the cubic
// through both ends has its minimum, if the minimum is below 0; otherwise infinity.
inline double DipWithin(double h, const MarginEnds& ends) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  if (!(ends.slope_0 < 0 && ends.slope_1 > 0)) return kNever;
  // g(s) = g_0 + a s + b s^2 + c s^3 over s = t/h.
  const double a = h * ends.slope_0;
  const double c = 2 * (ends.g_0 - ends.g_1) + a + h * ends.slope_1;
  const double b = (ends.g_1 - ends.g_0) - a - c;
  const double root = std::sqrt(std::max(0.0, b * b - 3 * a * c));
  const double s = -a / (b + root);  // where g' = 0 while rising, without cancellation
  if (!(s > 0 && s < 1)) return kNever;
  return ends.g_0 + s * (a + s * (b + s * c)) < 0 ? s * h : kNever;
}

// Given g(start) = g_start >= 0 and g(end) = g_end < 0, finds a time t in (start, end] with g(t) < 0 and with
// g >= 0 within `width` before it (or within the resolution of floating-point times). It uses the Illinois
// method, a regula falsi that halves the value at an end that stays, and a bisection whenever two steps have
// not halved the interval.
template <class Margin>
double TimeJustPast(double start, double g_start, double end, double g_end, double width, Margin g) {
  width = std::max(width, 8 * std::numeric_limits<double>::epsilon() * std::abs(end));
  int kept = 0;
  double wide = end - start;
  for (int i = 1; end - start > width; ++i) {
    double time = end - g_end * (end - start) / (g_end - g_start);
    if (i % 3 == 0) {
      if (end - start > 0.5 * wide) time = 0.5 * (start + end);
      wide = end - start;
    }
    time = std::clamp(time, start + 0.4 * width, end - 0.4 * width);
    const double value = g(time);
    if (value < 0) {
      end = time;
      g_end = value;
      if (kept == 1) g_start *= 0.5;
      kept = 1;
    } else {
      start = time;
      g_start = value;
      if (kept == -1) g_end *= 0.5;
      kept = -1;
    }
  }
  return end;
}

// How the time of an event depends on the unknowns. For .cc files of model/ only.

// How much later switch `which`, whose margin has just passed 0 at `at`, would reach its boundary with other
// numbers. The result has only derivatives; its value is 0. From margin(t, numbers) = 0 follows dt = -d
// margin / (d margin/dt).
inline Jet EventShift(const EquationData& m, double voltage, const Mode& mode, const PointOf<Jet>& at,
                      int which, Terms<Jet>& terms) {
  // d margin/dt along the motion: one direction of the Jet is the motion itself.
  Jet moving[kMaxStates], rate[kMaxStates], margin[kMaxSwitches];
  const NumbersOf<Jet>& constants = *m.constants;
  for (int i = 0; i < m.states; ++i) {
    moving[i] = Jet(at.state[i].a);
    moving[i].SetDerivative(0, at.rate[i].a);
  }
  EvaluateTerms<Form::kGeneral, Jet>(m, constants, at.time, Jet(voltage), mode, moving, rate, terms);
  FindMargins<Form::kGeneral, Jet>(m, constants, mode, terms, margin);
  double slope = margin[which].v[0];
  if (m.shaft == Shaft::kDriven || !m.effects.empty()) {  // the margins also depend on time
    constexpr double kShort = 1e-7;                       // s
    for (int i = 0; i < m.states; ++i) moving[i].SetDerivative(0, 0);
    EvaluateTerms<Form::kGeneral, Jet>(m, constants, at.time - kShort, Jet(voltage), mode, moving, rate,
                                       terms);
    const double now = margin[which].a;
    FindMargins<Form::kGeneral, Jet>(m, constants, mode, terms, margin);
    slope += (now - margin[which].a) / kShort;
  }
  if (!(slope < 0)) return Jet(0.0);  // the margin only touches 0: no first-order shift
  Jet later = -at.margin[which] / slope;
  later.a = 0;
  return later;
}

}  // namespace hydro::model
