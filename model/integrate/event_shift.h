// How the time of an event depends on the unknowns. For .cc files of model/ only.
#pragma once

#include "model/equations/evaluate.h"
#include "model/integrate/point.h"

namespace hydro::model {

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
