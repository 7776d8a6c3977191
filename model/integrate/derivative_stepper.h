// Runge-Kutta steps for Respond. They are short enough to keep derivatives finite, and they are counted, so
// that a fit of a far too stiff model ends. A template, for .cc files of model/ only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "model/integrate/mode_machine.h"
#include "model/integrate/runge_kutta.h"

namespace hydro::model {

// T is double or Jet. Only the values determine the length of a step.
template <class T>
class DerivativeStepper {
 public:
  DerivativeStepper(const Mode* mode, const double* voltage, Equations* equations,
                    const NumbersOf<T>* numbers, double relative_tolerance, int64_t most_steps)
      : mode_(*mode),
        voltage_(*voltage),
        equations_(*equations),
        numbers_(*numbers),
        steps_left_(most_steps) {
    for (int i = 0; i < n(); ++i) {
      relative_[i] = relative_tolerance * (i == kMotorAngle || i == kMotorSpeed ? 1 : kOtherStates);
      floor_[i] = relative_[i] * equations->scales()[i];
    }
  }

  void Restart(const PointOf<T>&) {}
  void NewVoltage(const PointOf<T>&) {}
  Integrator in_use() const { return Integrator::kFast; }
  bool Trusts(const PointOf<T>& /*now*/, const PointOf<T>& /*at*/) const { return true; }

  void Step(const PointOf<T>& now, double stop, PointOf<T>* next) {
    for (;;) {
      if (--steps_left_ < 0) throw ModelError("too stiff for an explicit method");
      if (++since_fastest_ >= kFastestEvery) FindFastest(now);
      const double longest = std::min(good_step_, kStable / fastest_);
      const bool limited = stop - now.time > longest;
      const double h = limited ? longest : stop - now.time;
      Interpolate(now, *next, limited ? now.time + h : stop, next);
      EvaluateTerms<Form::kGeneral, T>(data(), numbers_, next->time, T(voltage_), mode_, next->state,
                                       next->rate, terms_);
      FindMargins<Form::kGeneral, T>(data(), numbers_, mode_, terms_, next->margin);
      const double excess = Excess(*next, h);
      if (excess <= 1 && !limited) return;
      const double factor =
          std::clamp(0.9 * std::pow(std::max(excess, 1e-9), -0.25), 0.1, excess <= 1 ? 3.0 : 0.8);
      good_step_ = std::min(h * factor, kLongestStep);
      if (excess <= 1) return;
      if (good_step_ < kShortestStep) throw ModelError("the step failed" + Where(equations_, now));
    }
  }

  // Steps from `now` to `time`, with derivatives or, for the event search, with the values alone.
  void Interpolate(const PointOf<T>& now, const PointOf<T>& /*next*/, double time, PointOf<T>* at) {
    at->time = time;
    RungeKuttaStep(n(), now.time, time - now.time, now.state, now.rate, k2_, k3_, k4_, stage_, at->state,
                   [this](double t, const T* y, T* rate) {
                     EvaluateTerms<Form::kGeneral, T>(data(), numbers_, t, T(voltage_), mode_, y, rate,
                                                      terms_);
                   });
  }
  void Interpolate(const PointOf<T>& now, const PointOf<T>& /*next*/, double time,
                   Point* at) requires(!std::is_same_v<T, double>) {
    double y[kMaxStates], k1[kMaxStates], k2[kMaxStates], k3[kMaxStates], k4[kMaxStates];
    double stage[kMaxStates] = {};  // GCC 12 does not see that it is written first
    for (int i = 0; i < n(); ++i) {
      y[i] = ValueOf(now.state[i]);
      k1[i] = ValueOf(now.rate[i]);
    }
    Terms<double> x;
    at->time = time;
    RungeKuttaStep(n(), now.time, time - now.time, y, k1, k2, k3, k4, stage, at->state,
                   [&](double t, const double* from, double* rate) { ValueRates(t, from, rate, x); });
  }

 private:
  // The motor's speed needs a fine step where friction is a narrow curve over it. At the same tolerance, a
  // wave in a line or a stiff valve would take ten steps per sample to avoid invisible errors.
  static constexpr double kOtherStates = 30;     // times the tolerance
  static constexpr double kStable = 2.0;         // h |eigenvalue|; the method is stable up to 2.78
  static constexpr int kFastestEvery = 10;       // steps
  static constexpr double kShortestStep = 1e-9;  // s

  const EquationData& data() const { return equations_.data(); }
  int n() const { return data().states; }

  void ValueRates(double time, const double* y, double* rate, Terms<double>& x) const {
    EvaluateTerms<Form::kGeneral, double>(data(), data(), time, voltage_, mode_, y, rate, x);
  }

  // Error over allowed error.
  double Excess(const PointOf<T>& next, double h) const {
    double excess = 0;
    for (int i = 0; i < n(); ++i) {
      const double allowed = floor_[i] + relative_[i] * std::abs(ValueOf(next.state[i]));
      const double error = std::abs(h / 6 * (ValueOf(k4_[i]) - ValueOf(next.rate[i]))) / allowed;
      excess = std::isfinite(error) ? std::max(excess, error) : 1e30;
    }
    return excess;
  }

  // The largest |eigenvalue|, by power iteration. The error control of the values keeps steps near the limit
  // of stability. Beyond that limit derivatives grow without bound, although the values do not show it.
  void FindFastest(const PointOf<T>& now) {
    constexpr double kSmall = 1e-5;
    double y[kMaxStates], stage[kMaxStates], moved[kMaxStates], rate[kMaxStates];
    Terms<double> x;
    const double* scale = equations_.scales().data();
    for (int i = 0; i < n(); ++i) y[i] = ValueOf(now.state[i]);
    ValueRates(now.time, y, rate, x);
    since_fastest_ = 0;
    double found = 0;
    for (int round = 0; round < 2; ++round) {
      const double size = Length(direction_);
      if (!(size > 0) || !std::isfinite(size)) {  // start with a component along every state
        for (int i = 0; i < n(); ++i) direction_[i] = i % 2 == 0 ? 1 : -0.7;
        continue;
      }
      for (int i = 0; i < n(); ++i) stage[i] = y[i] + kSmall * direction_[i] / size * scale[i];
      ValueRates(now.time, stage, moved, x);
      for (int i = 0; i < n(); ++i) direction_[i] = (moved[i] - rate[i]) / (kSmall * scale[i]);
      found = Length(direction_);
    }
    fastest_ = std::isfinite(found) ? std::max(found, 0.9 * fastest_) : fastest_;
  }

  double Length(const double* vector) const {
    double sum = 0;
    for (int i = 0; i < n(); ++i) sum += vector[i] * vector[i];
    return std::sqrt(sum);
  }

  const Mode& mode_;
  const double& voltage_;
  Equations& equations_;
  const NumbersOf<T>& numbers_;
  int64_t steps_left_;
  double relative_[kMaxStates] = {};
  double floor_[kMaxStates] = {};
  double good_step_ = kLongestStep;
  double fastest_ = 1;  // 1/s
  int since_fastest_ = kFastestEvery;
  double direction_[kMaxStates] = {};
  Terms<T> terms_;
  T k2_[kMaxStates] = {}, k3_[kMaxStates] = {}, k4_[kMaxStates] = {}, stage_[kMaxStates] = {};
};

}  // namespace hydro::model
