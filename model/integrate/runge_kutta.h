// The classical Runge-Kutta method. It is implemented only here; each stepper adds its own error control. A
// template, for .cc files only.
#pragma once

namespace hydro::model {

// One step of length h from y at `time`, with rates k1, to `next`. `rates(time, y, rate)` is the right-hand
// side. T is double or Jet.
//
// The rate at the end of the step, k5, starts the next step and also gives an embedded third-order result.
// The difference of the two results, h/6 (k4 - k5), overestimates the error of the fourth-order result, which
// is kept.
template <class T, class Rates>
[[gnu::always_inline]] inline void RungeKuttaStep(int n, double time, double h, const T* y, const T* k1,
                                                  T* k2, T* k3, T* k4, T* stage, T* next,
                                                  const Rates& rates) {
  for (int i = 0; i < n; ++i) stage[i] = y[i] + 0.5 * h * k1[i];
  rates(time + 0.5 * h, stage, k2);
  for (int i = 0; i < n; ++i) stage[i] = y[i] + 0.5 * h * k2[i];
  rates(time + 0.5 * h, stage, k3);
  for (int i = 0; i < n; ++i) stage[i] = y[i] + h * k3[i];
  rates(time + h, stage, k4);
  for (int i = 0; i < n; ++i) next[i] = y[i] + h / 6 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
}

}  // namespace hydro::model
