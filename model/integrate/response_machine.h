// The simulation behind Respond, for one scalar. A template, for .cc files of model/ only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>

#include "model/equations/evaluate.h"
#include "model/integrate/event_search.h"
#include "model/integrate/simulation.h"

namespace hydro::model {

// T is double, or Jet: then all that is seeded in the numbers and the start is carried along. Decisions
// (steps, events) are taken on the values alone.
template <class T>
class ResponseMachine {
 public:
  ResponseMachine(Equations* equations, const NumbersOf<T>& numbers, double relative_tolerance)
      : equations_(*equations),
        data_(equations->data()),
        numbers_(numbers),
        n_(equations->states()),
        history_(n_, data_.reach) {
    for (int i = 0; i < n_; ++i) {
      relative_[i] = relative_tolerance * (i == kMotorAngle || i == kMotorSpeed ? 1 : kOtherStates);
      floor_[i] = relative_[i] * equations->scales()[i];
    }
  }

  // `base`: the base states; `time` is the first sample's.
  void Start(double time, const T* base) {
    time_ = time;
    mode_ = Mode{};
    const int given = data_.shaft == Shaft::kFree ? 6 : 4;
    for (int i = 0; i < n_; ++i) state_[i] = i < given ? base[i] : T(0.0);
    voltage_ = 0;
    equations_.PassStop(time_);
    Evaluate(state_, rate_, margin_);
    // Whether an effect has valves of its own shows in the margins: an ideal one's is p - p_3.
    for (const int side : {kP1, kP2}) {
      const int which = side == kP1 ? kValve1Switch : kValve2Switch;
      if (ValueOf(margin_[which]) < 0) state_[side] = terms_.p_3;
    }
    Evaluate(state_, rate_, margin_);
    for (const auto& effect : data_.effects) {
      terms_.own = numbers_.own.data() + effect->first_parameter();
      effect->Start(terms_, state_);
      effect->StartMode(terms_, &mode_);
    }
    const double speed = ValueOf(state_[kMotorSpeed]);
    mode_.pump = static_cast<int8_t>(speed > 0 ? 1 : (speed < 0 ? -1 : 0));
    known_stop_ = equations_.NextStop(time_);
    Evaluate(state_, rate_, margin_);
    Remember();
  }

  // So many steps are taken in all, then ModelError: a model far too stiff must not take hours.
  void AllowSteps(int64_t steps) { steps_left_ = steps; }

  void Advance(double voltage, double until) {
    if (voltage != voltage_ || !started_) {
      const bool at_start = !started_;
      voltage_ = voltage;
      started_ = true;
      fresh_ = true;
      equations_.Command(time_, voltage);
      equations_.PassStop(time_);
      known_stop_ = equations_.NextStop(time_);
      Evaluate(state_, rate_, margin_);
      Settle();
      if (at_start && mode_.pump == 0) {  // it stands still, and would soon if it did not
        state_[kMotorSpeed] = T(0.0);
        Evaluate(state_, rate_, margin_);
      }
      Remember();
    }
    int events = 0;
    while (time_ < until) {
      double stop = std::min(until, known_stop_);
      if (data_.reads_late) stop = std::min(stop, time_ + kLongestStepToRead);
      if (fresh_ && OnBoundary()) stop = std::min(stop, time_ + kMoment);
      fresh_ = false;
      Step(stop);
      const double trouble = FirstTrouble();
      if (trouble <= next_time_) {
        if (++events > kMostEvents) throw ModelError("the switches chatter at t = " + std::to_string(time_));
        ToEvent(trouble);
      } else {
        Accept();
        if (time_ >= known_stop_) ToKnownStop();
      }
    }
  }

  double time() const { return time_; }
  MeasurementOf<T> Measure() const {
    return ReadSensors<T>(data_, numbers_, time_, state_, data_.reads_late ? &history_ : nullptr);
  }

 private:
  static constexpr double kMoment = 1e-6;       // s; a switch on its boundary shows to which side it goes
  static constexpr double kEventWidth = 1e-10;  // s
  static constexpr int kMostEvents = 1000;      // between two samples
  static constexpr double kLongest = 1e-2;      // s
  // The motor's speed needs a fine step where friction is a narrow curve of it. A wave in a line or a stiff
  // valve, with the same, is followed by ten steps a sample whose errors nobody would see.
  static constexpr double kOtherStates = 30;  // times the tolerance
  static constexpr double kStable = 2.0;      // h |eigenvalue|; the method is stable up to 2.78
  static constexpr int kFastestEvery = 10;    // steps
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  void Evaluate(const T* y, T* rate, T* margin) { EvaluateAt(time_, y, rate, margin); }
  void EvaluateAt(double time, const T* y, T* rate, T* margin) {
    EvaluateTerms<Form::kGeneral, T>(data_, numbers_, time, T(voltage_), mode_, y, rate, terms_);
    if (margin != nullptr) FindMargins<Form::kGeneral, T>(data_, numbers_, mode_, terms_, margin);
  }

  // One step of the classical method from here, to next_.
  template <class S, class Rates>
  static void Stages(int n, double time, double h, const S* y, const S* k1, S* k2, S* k3, S* k4, S* next,
                     S* stage, const Rates& rates) {
    for (int i = 0; i < n; ++i) stage[i] = y[i] + 0.5 * h * k1[i];
    rates(time + 0.5 * h, stage, k2);
    for (int i = 0; i < n; ++i) stage[i] = y[i] + 0.5 * h * k2[i];
    rates(time + 0.5 * h, stage, k3);
    for (int i = 0; i < n; ++i) stage[i] = y[i] + h * k3[i];
    rates(time + h, stage, k4);
    for (int i = 0; i < n; ++i) next[i] = y[i] + h / 6 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
  }

  void StepTo(double time) {
    Stages(n_, time_, time - time_, state_, rate_, k2_, k3_, k4_, next_state_, stage_,
           [this](double t, const T* y, T* rate) { EvaluateAt(t, y, rate, nullptr); });
    next_time_ = time;
    EvaluateAt(time, next_state_, next_rate_, next_margin_);
  }

  void Step(double stop) {
    for (;;) {
      if (--steps_left_ < 0) throw ModelError("too stiff for an explicit method");
      if (++since_fastest_ >= kFastestEvery) FindFastest();
      const double longest = std::min(good_step_, kStable / fastest_);
      const bool limited = stop - time_ > longest;
      const double h = limited ? longest : stop - time_;
      StepTo(limited ? time_ + h : stop);
      double excess = 0;
      for (int i = 0; i < n_; ++i) {
        const double allowed = floor_[i] + relative_[i] * std::abs(ValueOf(next_state_[i]));
        const double error = std::abs(h / 6 * (ValueOf(k4_[i]) - ValueOf(next_rate_[i]))) / allowed;
        excess = std::isfinite(error) ? std::max(excess, error) : 1e30;
      }
      if (excess <= 1 && !limited) return;
      const double factor =
          std::clamp(0.9 * std::pow(std::max(excess, 1e-9), -0.25), 0.1, excess <= 1 ? 3.0 : 0.8);
      good_step_ = std::min(h * factor, kLongest);
      if (excess <= 1) return;
      if (good_step_ < 1e-9) {
        throw ModelError("the step failed at t = " + std::to_string(time_) + " s");
      }
    }
  }

  // The largest |eigenvalue| by power iteration. The error of the values keeps steps near the limit of
  // stability, and beyond it derivatives grow without limit where the values do not show it.
  void FindFastest() {
    double y[kMaxStates], moved[kMaxStates], rate[kMaxStates];
    Terms<double> x;
    const auto rates = [&](const double* at, double* to) {
      EvaluateTerms<Form::kGeneral, double>(data_, data_, time_, voltage_, mode_, at, to, x);
    };
    const double* scale = equations_.scales().data();
    for (int i = 0; i < n_; ++i) y[i] = ValueOf(state_[i]);
    rates(y, rate);
    since_fastest_ = 0;
    double found = 0;
    for (int round = 0; round < 2; ++round) {
      double size = 0;
      for (int i = 0; i < n_; ++i) size += direction_[i] * direction_[i];
      size = std::sqrt(size);
      if (!(size > 0) || !std::isfinite(size)) {  // a start that has something of every state
        for (int i = 0; i < n_; ++i) direction_[i] = i % 2 == 0 ? 1 : -0.7;
        continue;
      }
      constexpr double kSmall = 1e-5;
      double stage[kMaxStates];
      for (int i = 0; i < n_; ++i) stage[i] = y[i] + kSmall * direction_[i] / size * scale[i];
      rates(stage, moved);
      double grown = 0;
      for (int i = 0; i < n_; ++i) {
        direction_[i] = (moved[i] - rate[i]) / (kSmall * scale[i]);
        grown += direction_[i] * direction_[i];
      }
      found = std::sqrt(grown);
    }
    fastest_ = std::isfinite(found) ? std::max(found, 0.9 * fastest_) : fastest_;
  }

  void Accept() {
    std::swap_ranges(state_, state_ + n_, next_state_);
    std::swap_ranges(rate_, rate_ + n_, next_rate_);
    std::swap_ranges(margin_, margin_ + data_.switches, next_margin_);
    time_ = next_time_;
    Remember();
    if (data_.shaft == Shaft::kFree) {
      const double angle = ValueOf(state_[data_.actuator_angle_state]);
      if (!(std::abs(angle) * data_.parameters.c < data_.parameters.V_ms - data_.fixed_volume)) {
        equations_.CheckVolumes(angle);
      }
    }
  }

  void Remember() {
    if (data_.reads_late) history_.Add(time_, state_, rate_);
  }

  bool OnBoundary() const {
    for (int i = 0; i < data_.switches; ++i) {
      if (ValueOf(margin_[i]) == 0) return true;
    }
    return false;
  }

  double MarginRate(int i, const T* rate) const {
    return hydro::model::MarginRate<Form::kGeneral>(data_, mode_, i, rate);
  }

  void Settle() {
    for (int round = 0; round < 4 * kMaxSwitches; ++round) {
      int wrong = -1;
      for (int i = 0; i < data_.switches && wrong < 0; ++i) {
        const double margin = ValueOf(margin_[i]);
        if (margin < 0 || (margin == 0 && MarginRate(i, rate_) < 0)) wrong = i;
      }
      if (wrong < 0) return;
      fresh_ = true;
      CrossSwitch<T>(data_, numbers_, wrong, time_, T(voltage_), state_, &mode_);
      Evaluate(state_, rate_, margin_);
    }
    throw ModelError("no mode fits at t = " + std::to_string(time_) + " s");
  }

  double FirstTrouble() const {
    for (int i = 0; i < data_.switches; ++i) {
      if (ValueOf(next_margin_[i]) < 0) return next_time_;
    }
    double trouble = kNever;
    for (int i = 0; i < kFirstEffectSwitch; ++i) {
      const MarginEnds ends = {ValueOf(margin_[i]), MarginRate(i, rate_), ValueOf(next_margin_[i]),
                               MarginRate(i, next_rate_)};
      trouble = std::min(trouble, time_ + DipWithin(next_time_ - time_, ends));
    }
    return trouble;
  }

  // The least margin at `time` within the step that starts here, on the values alone.
  double LeastMargin(double time) {
    double y[kMaxStates], k1[kMaxStates], k2[kMaxStates], k3[kMaxStates], k4[kMaxStates], next[kMaxStates];
    double stage[kMaxStates] = {};  // GCC 12 does not see that it is written first
    double margin[kMaxSwitches];
    for (int i = 0; i < n_; ++i) {
      y[i] = ValueOf(state_[i]);
      k1[i] = ValueOf(rate_[i]);
    }
    Terms<double> x;
    const auto rates = [&](double t, const double* at, double* rate) {
      EvaluateTerms<Form::kGeneral, double>(data_, data_, t, voltage_, mode_, at, rate, x);
    };
    Stages(n_, time_, time - time_, y, k1, k2, k3, k4, next, stage, rates);
    rates(time, next, k4);
    FindMargins<Form::kGeneral, double>(data_, data_, mode_, x, margin);
    return *std::min_element(margin, margin + data_.switches);
  }

  void ToEvent(double last) {
    const double g_last = LeastMargin(last);
    if (g_last >= 0) {  // a dip that is not there, or rounding between the scalars
      if (last < next_time_) StepTo(last);
      Accept();
      Settle();
      return;
    }
    const double event = TimeJustPast(time_, std::max(0.0, LeastMargin(time_)), last, g_last, kEventWidth,
                                      [&](double time) { return LeastMargin(time); });
    StepTo(event);
    Accept();
    int first = 0;
    for (int i = 1; i < data_.switches; ++i) {
      if (ValueOf(margin_[i]) < ValueOf(margin_[first])) first = i;
    }
    const T later = EventShift(first);
    for (int i = 0; i < n_; ++i) state_[i] += rate_[i] * later;
    CrossSwitch<T>(data_, numbers_, first, time_, T(voltage_), state_, &mode_);
    Evaluate(state_, rate_, margin_);
    fresh_ = true;
    Settle();
    MoveBack(later);
    Remember();
  }

  void ToKnownStop() {
    T later = T(0.0);
    if constexpr (!std::is_same_v<T, double>) {
      for (const auto& effect : data_.effects) {
        if (effect->NextStop(time_ - kMoment) <= time_) {
          later += effect->StopShift(numbers_.own.data() + effect->first_parameter());
        }
      }
    }
    for (int i = 0; i < n_; ++i) state_[i] += rate_[i] * later;
    equations_.PassStop(time_);
    known_stop_ = equations_.NextStop(time_);
    fresh_ = true;
    Evaluate(state_, rate_, margin_);
    Settle();
    MoveBack(later);
    Remember();
  }

  // The state at the event's true time, moved to time_ in the mode that follows. The value stays.
  void MoveBack(const T& later) {
    if constexpr (!std::is_same_v<T, double>) {
      for (int i = 0; i < n_; ++i) state_[i] -= rate_[i] * later;
      Evaluate(state_, rate_, margin_);
    }
  }

  // By how much switch `which` reaches its boundary later for other numbers: derivatives only.
  T EventShift(int which) {
    if constexpr (std::is_same_v<T, double>) {
      return 0;
    } else {
      // d margin/dt along the motion: one direction is that of the motion itself.
      Jet moving[kMaxStates], rate[kMaxStates], margin[kMaxSwitches];
      const NumbersOf<Jet>& constants = *data_.constants;
      for (int i = 0; i < n_; ++i) {
        moving[i] = Jet(state_[i].a);
        moving[i].v[0] = rate_[i].a;
      }
      EvaluateTerms<Form::kGeneral, Jet>(data_, constants, time_, Jet(voltage_), mode_, moving, rate, terms_);
      FindMargins<Form::kGeneral, Jet>(data_, constants, mode_, terms_, margin);
      double slope = margin[which].v[0];
      if (data_.shaft == Shaft::kDriven || !data_.effects.empty()) {  // they depend on time too
        constexpr double kShort = 1e-7;
        for (int i = 0; i < n_; ++i) moving[i].v[0] = 0;
        EvaluateTerms<Form::kGeneral, Jet>(data_, constants, time_ - kShort, Jet(voltage_), mode_, moving,
                                           rate, terms_);
        const double now = margin[which].a;
        FindMargins<Form::kGeneral, Jet>(data_, constants, mode_, terms_, margin);
        slope += (now - margin[which].a) / kShort;
      }
      if (!(slope < 0)) return T(0.0);  // it touches: no first order
      T later = -margin_[which] / slope;
      later.a = 0;
      return later;
    }
  }

  Equations& equations_;
  const EquationData& data_;
  const NumbersOf<T>& numbers_;
  double relative_[kMaxStates] = {};
  int n_;
  Mode mode_;
  double time_ = 0;
  double next_time_ = 0;
  double voltage_ = 0;
  bool started_ = false;
  bool fresh_ = true;
  double known_stop_ = kNever;
  int64_t steps_left_ = std::numeric_limits<int64_t>::max();
  double good_step_ = kLongest;
  double fastest_ = 1;  // 1/s
  int since_fastest_ = kFastestEvery;
  double direction_[kMaxStates] = {};
  StateHistory<T> history_;
  double floor_[kMaxStates] = {};
  Terms<T> terms_;
  T state_[kMaxStates] = {}, next_state_[kMaxStates] = {};
  T rate_[kMaxStates] = {}, next_rate_[kMaxStates] = {};
  T margin_[kMaxSwitches] = {}, next_margin_[kMaxSwitches] = {};
  T k2_[kMaxStates] = {}, k3_[kMaxStates] = {}, k4_[kMaxStates] = {}, stage_[kMaxStates] = {};
};

}  // namespace hydro::model
