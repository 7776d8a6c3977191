// Integrator::kFast: Runge-Kutta steps held to a tolerance, inlined for the plain forms. A template, for .cc
// files of model/ only.
#pragma once

#include <algorithm>
#include <cmath>

#include "model/integrate/mode_machine.h"
#include "model/integrate/runge_kutta.h"

namespace hydro::model {

template <Form kForm>
class FastStepper {
 public:
  FastStepper(const Mode* mode, const double* voltage, Equations* equations, double relative_tolerance)
      : mode_(*mode),
        voltage_(*voltage),
        equations_(*equations),
        tolerance_(kErrorShare * relative_tolerance) {
    for (int i = 0; i < n(); ++i) floor_[i] = tolerance_ * equations_.scales()[i];
  }

  void Restart(const Point&) { unstable_steps_ = 0; }
  void NewVoltage(const Point&) { unstable_steps_ = 0; }
  Integrator in_use() const { return Integrator::kFast; }

  void Step(const Point& now, double stop, Point* next) {
    for (;;) {
      const bool limited = stop - now.time > good_step_;
      const double h = limited ? good_step_ : stop - now.time;
      double k2[kMaxStates];
      double k3[kMaxStates];
      double k4[kMaxStates];
      next->time = limited ? now.time + h : stop;
      Stages(now, h, next->state, k2, k3, k4);
      EvaluatePoint<kForm>(data(), next->time, voltage_, mode_, next->state, next->rate, next->margin);
      bool good = true;
      for (int i = 0; i < n(); ++i) {
        const double allowed = floor_[i] + tolerance_ * std::abs(next->state[i]);
        good &= std::abs(h / 6 * (k4[i] - next->rate[i])) <= allowed;  // false for NaN too
        if constexpr (kMayBend) {
          good &= Bend(i, h, now.rate, k2, k3, k4) <= allowed * Largest(i, now.rate, k2, k4);
        }
      }
      if (good && !limited) return;
      const double excess = Excess(now, *next, h, k2, k3, k4);
      good = excess <= 1;
      if (good && !limited) return;
      const double factor = std::clamp(0.9 * std::pow(std::max(excess, 1e-12), -0.2), 0.1, good ? 4.0 : 0.8);
      good_step_ = std::min(h * factor, kLongestStep);
      if (good) {
        CountUnstable(now.rate, k2, k3);
        return;
      }
      if (good_step_ < 1e-14 * std::max(1.0, std::abs(now.time))) {
        throw ModelError("the step failed" + Where(equations_, now));
      }
    }
  }

  // Whether one step from `now` to `at`, where everything is known, is accurate enough. Step checks only the
  // whole step, and an event may lie just where the step bends.
  bool Trusts(const Point& now, const Point& at) const {
    if constexpr (!kMayBend) return true;
    double k2[kMaxStates];
    double k3[kMaxStates];
    double k4[kMaxStates];
    double state[kMaxStates];
    const double h = at.time - now.time;
    Stages(now, h, state, k2, k3, k4);
    return Excess(now, at, h, k2, k3, k4) <= 1;
  }

  // True when stability rather than accuracy has limited so many steps under one voltage that an implicit
  // method is cheaper.
  bool stiff() const { return unstable_steps_ >= kStiffAfter; }

  void Interpolate(const Point& now, const Point&, double time, Point* at) {
    double k2[kMaxStates];
    double k3[kMaxStates];
    double k4[kMaxStates];
    at->time = time;
    Stages(now, time - now.time, at->state, k2, k3, k4);
  }

 private:
  const EquationData& data() const { return equations_.data(); }
  int n() const { return FormSize<kForm>::states(data()); }

  // The plain forms are smooth on the scale of their steps; effects may not be.
  static constexpr bool kMayBend = kForm == Form::kGeneral;
  // The share of the tolerance for one step, because the errors of the steps add up.
  static constexpr double kErrorShare = 0.1;
  static constexpr int kStiffAfter = 50;
  static constexpr double kNearlyUnstable = 2.0;  // h |lambda|; the method is stable up to 2.78

  // (2/15) h d^2/k equals h z^4/120 k, where d is k3 - k2 or the second difference k1 - k2 - k3 + k4, both
  // z^2/4 k. It detects what k4 and k5 miss when they both lie beyond it or both before it, such as friction
  // that rises within a small part of the step. To avoid the division, the callers multiply the other side by
  // k.
  static double Bend(int i, double h, const double* k1, const double* k2, const double* k3,
                     const double* k4) {
    const double d = std::max(std::abs(k3[i] - k2[i]), std::abs((k1[i] - k2[i]) + (k4[i] - k3[i])));
    return 2.0 / 15 * h * d * d;
  }
  static double Largest(int i, const double* k1, const double* k2, const double* k4) {
    return std::max(std::max(std::abs(k1[i]), std::abs(k2[i])), std::abs(k4[i]));
  }

  // Error over allowed error. For a mode with z = lambda h, the embedded result has an error of h z^3/72 k1,
  // and the result that is kept has an error of h z^4/120 k1. The difference of the two results is therefore
  // multiplied by 0.6 z, where z is the largest that any component shows.
  double Excess(const Point& now, const Point& next, double h, const double* k2, const double* k3,
                const double* k4) const {
    double z = 0;
    double excess = 0;
    double bend = 0;
    for (int i = 0; i < n(); ++i) {
      const double change = 2 * std::abs(k3[i] - k2[i]);
      const double cause = std::abs(k2[i] - now.rate[i]);
      if (change > 0) z = std::max(z, change / cause);
      const double allowed = floor_[i] + tolerance_ * std::abs(next.state[i]);
      const double ratio = std::abs(h / 6 * (k4[i] - next.rate[i])) / allowed;
      if (!std::isfinite(ratio)) return 1e30;
      excess = std::max(excess, ratio);
      if (kMayBend && Largest(i, now.rate, k2, k4) > 0) {
        bend = std::max(bend, Bend(i, h, now.rate, k2, k3, k4) / (allowed * Largest(i, now.rate, k2, k4)));
      }
    }
    return std::max(bend, std::min(1.0, 0.6 * z) * excess);
  }

  // k3 - k2 = lambda h/2 (k2 - k1) along the fastest direction.
  void CountUnstable(const double* k1, const double* k2, const double* k3) {
    double change = 0;
    double cause = 0;
    for (int i = 0; i < n(); ++i) {
      const double scale = equations_.scales()[i];
      change += std::abs(k3[i] - k2[i]) / scale;
      cause += std::abs(k2[i] - k1[i]) / scale;
    }
    if (2 * change > kNearlyUnstable * cause) {
      ++unstable_steps_;
    } else if (unstable_steps_ > 0 && !stiff()) {
      --unstable_steps_;
    }
  }

  void Rates(double time, const double* y, double* rate) const {
    EvaluatePoint<kForm>(data(), time, voltage_, mode_, y, rate, nullptr);
  }

  void Stages(const Point& now, double h, double* y, double* k2, double* k3, double* k4) const {
    double stage[kMaxStates];
    if constexpr (kMayBend) stage[0] = 0;  // GCC 12 does not see that it is written first
    RungeKuttaStep(
        n(), now.time, h, now.state, now.rate, k2, k3, k4, stage, y,
        // Measured with a free arm: 0.24 us a tick. As a function call, which GCC would otherwise make of it:
        // 0.27 us.
        [this](double time, const double* at, double* rate) __attribute__((always_inline)) {
          if constexpr (kForm == Form::kGeneral) {
            Rates(time, at, rate);
          } else {
            EvaluatePoint<kForm>(data(), time, voltage_, mode_, at, rate, nullptr);
          }
        });
  }

  const Mode& mode_;
  const double& voltage_;
  Equations& equations_;
  double tolerance_;
  double floor_[kMaxStates] = {};
  int unstable_steps_ = 0;
  double good_step_ = kLongestStep;  // remembered between calls
};

}  // namespace hydro::model
