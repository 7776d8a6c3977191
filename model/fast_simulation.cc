// Integrator::kFast: the classical Runge-Kutta method with its own event location, inlined for the plain
// forms.
//
// The rate at the end of each step, which the next step starts with, also gives an embedded third-order
// result: their difference h/6 (k4 - k5) overestimates the error of the fourth-order result that is kept.
#include <algorithm>
#include <cmath>

#include "model/switching.h"

namespace hydro {

namespace {

template <Form kForm>
class RungeKutta {
 public:
  static constexpr bool kFillsPoint = true;

  RungeKutta(const Mode* mode, const double* voltage, Equations* equations, double relative_tolerance)
      : mode_(*mode), voltage_(*voltage), equations_(*equations), tolerance_(relative_tolerance) {
    for (int i = 0; i < n(); ++i) floor_[i] = relative_tolerance * equations_.scales()[i];
  }

  void Restart(const Point&) {}
  void NewVoltage(const Point&) {}

  void Step(const Point& now, double stop, Point* next) {
    for (;;) {
      const bool limited = stop - now.time > good_step_;
      const double h = limited ? good_step_ : stop - now.time;
      double k4[kMaxStates];
      next->time = limited ? now.time + h : stop;
      Stages(now, h, next->state, k4);
      EvaluatePoint<kForm>(data(), next->time, voltage_, mode_, next->state, next->rate, next->margin);
      double excess = 0;
      bool good = true;
      for (int i = 0; i < n(); ++i) {
        const double error = std::abs(h / 6 * (k4[i] - next->rate[i]));
        const double allowed = floor_[i] + tolerance_ * std::abs(next->state[i]);
        good &= error <= allowed;  // false for NaN too
      }
      if (good && !limited) return;
      for (int i = 0; i < n(); ++i) {
        const double error = std::abs(h / 6 * (k4[i] - next->rate[i]));
        const double ratio = error / (floor_[i] + tolerance_ * std::abs(next->state[i]));
        excess = std::isnan(ratio) ? 1e30 : std::max(excess, ratio);
      }
      const double factor = std::clamp(0.9 * std::pow(std::max(excess, 1e-12), -0.25), 0.1, good ? 4.0 : 0.8);
      good_step_ = h * factor;
      if (good) return;
      if (good_step_ < 1e-14 * std::max(1.0, std::abs(now.time))) {
        throw ModelError("the step failed" + Where(equations_, now));
      }
    }
  }

  void Interpolate(const Point& now, const Point&, double time, Point* at) {
    double k4[kMaxStates];
    at->time = time;
    Stages(now, time - now.time, at->state, k4);
  }

 private:
  const EquationData& data() const { return equations_.data(); }
  int n() const { return FormSize<kForm>::states(data()); }

  void Rates(double time, const double* y, double* rate) const {
    EvaluatePoint<kForm>(data(), time, voltage_, mode_, y, rate, nullptr);
  }

  void Stages(const Point& now, double h, double* y, double* k4) const {
    double k2[kMaxStates];
    double k3[kMaxStates];
    double stage[kMaxStates];
    const double* k1 = now.rate;
    for (int i = 0; i < n(); ++i) stage[i] = now.state[i] + 0.5 * h * k1[i];
    Rates(now.time + 0.5 * h, stage, k2);
    for (int i = 0; i < n(); ++i) stage[i] = now.state[i] + 0.5 * h * k2[i];
    Rates(now.time + 0.5 * h, stage, k3);
    for (int i = 0; i < n(); ++i) stage[i] = now.state[i] + h * k3[i];
    Rates(now.time + h, stage, k4);
    for (int i = 0; i < n(); ++i) y[i] = now.state[i] + h / 6 * (k1[i] + 2 * (k2[i] + k3[i]) + k4[i]);
  }

  const Mode& mode_;
  const double& voltage_;
  Equations& equations_;
  double tolerance_;
  double floor_[kMaxStates] = {};
  double good_step_ = 1e-2;  // s, remembered between calls
};

template <Form kForm>
using FastSimulation = SwitchingSimulation<kForm, RungeKutta<kForm>>;

}  // namespace

std::unique_ptr<Simulation> MakeFastSimulation(Equations* equations, double initial_pressure,
                                               double relative_tolerance) {
  if (!equations->plain()) {
    return std::make_unique<FastSimulation<Form::kGeneral>>(equations, initial_pressure, relative_tolerance);
  }
  if (equations->data().shaft == Shaft::kFree) {
    return std::make_unique<FastSimulation<Form::kPlainFree>>(equations, initial_pressure,
                                                              relative_tolerance);
  }
  return std::make_unique<FastSimulation<Form::kPlainClamped>>(equations, initial_pressure,
                                                               relative_tolerance);
}

}  // namespace hydro
