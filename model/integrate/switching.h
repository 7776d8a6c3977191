// The mode machine: runs any stepper from event to event. A template, for .cc files of model/ only.
//
// A stepper integrates one smooth mode. It is made from pointers to the mode and the voltage, which the
// machine changes:
//   void Restart(const Point& now)     the state or the mode has changed
//   void NewVoltage(const Point& now)  only the voltage has changed
//   void Step(const Point& now, double stop, Point* next)  one step, to no later than `stop`; fills all of
//   next; throws
//                                      ModelError
//   bool Trusts(const Point& now, const Point& at) const  the interpolation to `at` is accurate enough
//   Integrator in_use() const
//   void Interpolate(const Point& now, const Point& next, double time, Point* at)  time and state within the
//   last step
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "model/equations/evaluate.h"
#include "model/integrate/event_search.h"
#include "model/integrate/simulation.h"

namespace hydro::model {

// "…at t = 0.25 s, state (0, 1.5, …)".
inline std::string Where(const Equations& equations, const Point& at) {
  std::ostringstream out;
  out.precision(10);
  out << " at t = " << at.time << " s, state";
  const auto names = equations.StateNames();
  for (int i = 0; i < equations.states(); ++i)
    out << (i == 0 ? " " : ", ") << names[i] << " = " << at.state[i];
  return out.str();
}

template <Form kForm>
struct FormSize {
  static int states(const EquationData& m) {
    if constexpr (kForm == Form::kPlainClamped) return 4;
    if constexpr (kForm == Form::kPlainFree) return 6;
    return m.states;
  }
  static int switches(const EquationData& m) {
    if constexpr (kForm != Form::kGeneral) return kFirstEffectSwitch;
    return m.switches;
  }
};

template <Form kForm, class Stepper>
class SwitchingSimulation final : public Simulation {
 public:
  SwitchingSimulation(Equations* equations, double initial_pressure, double relative_tolerance)
      : equations_(*equations),
        history_(equations->states(), equations->data().reach),
        stepper_(&mode_, &voltage_, equations, relative_tolerance) {
    equations_.Start(initial_pressure, now_->state, &mode_);
    PassStop();
  }

  const Point& now() const override { return *now_; }
  const Mode& mode() const override { return mode_; }
  const StateHistory<double>* history() const override { return remembers() ? &history_ : nullptr; }
  int64_t mode_changes() const override { return mode_changes_; }
  Integrator in_use() const override { return stepper_.in_use(); }

  void Advance(double voltage, double until) override {
    if (!std::isfinite(voltage)) throw ModelError("the voltage is not finite" + Where(equations_, *now_));
    if (!(until >= now_->time) || std::isinf(until)) {
      throw ModelError("cannot advance to t = " + std::to_string(until) + " s" + Where(equations_, *now_));
    }
    if (voltage != voltage_ || !started_) {
      voltage_ = voltage;
      fresh_ = true;
      if constexpr (kForm == Form::kGeneral) {
        equations_.Command(now_->time, voltage);
        PassStop();
      }
      EvaluateHere();
      if (Settle() || !started_) {
        stepper_.Restart(*now_);
      } else {
        stepper_.NewVoltage(*now_);
      }
      started_ = true;
      Remember();
    }
    int events = 0;
    while (now_->time < until) {
      double stop = std::min(until, known_stop_);
      if (remembers()) stop = std::min(stop, now_->time + kLongestStepToRead);
      // A switch on its boundary is given a moment to show to which side it goes.
      if (fresh_ && OnBoundary()) stop = std::min(stop, now_->time + kMoment);
      fresh_ = false;
      stepper_.Step(*now_, stop, next_);
      CheckFinite(*next_);
      if constexpr (kForm != Form::kPlainClamped) {
        if (data().shaft == Shaft::kFree) {
          CheckArm(next_->state[kForm == Form::kGeneral ? data().actuator_angle_state : kArmAngle]);
        }
      }
      const double last = FirstTrouble();
      if (last <= next_->time) {
        if (++events > kMostEvents) throw ModelError("the switches chatter" + Where(equations_, *now_));
        ToEvent(last);
      } else {
        GoTo(&next_);
        if (now_->time >= known_stop_) {
          PassStop();
          fresh_ = true;
          EvaluateHere();
          Settle();
          stepper_.Restart(*now_);
          Remember();
        }
      }
    }
  }

 private:
  static constexpr double kMoment = 1e-6;       // s
  static constexpr double kEventWidth = 1e-11;  // s, within which an event is located
  static constexpr int kMostEvents = 1000000;   // in one call
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  const EquationData& data() const { return equations_.data(); }
  int switches() const { return FormSize<kForm>::switches(data()); }

  void Evaluate(Point* at) {
    EvaluatePoint<kForm>(data(), at->time, voltage_, mode_, at->state, at->rate, at->margin);
  }
  void EvaluateHere() { Evaluate(now_); }

  void PassStop() {
    equations_.PassStop(now_->time);
    known_stop_ = equations_.NextStop(now_->time);
  }

  void CheckFinite(const Point& at) const {
    double sum = 0;
    for (int i = 0; i < FormSize<kForm>::states(data()); ++i) sum += at.state[i];
    if (!std::isfinite(sum)) throw ModelError("a state is not finite" + Where(equations_, at));
  }

  void CheckArm(double arm_angle) const {
    const Parameters& p = data().parameters;
    if (!(std::abs(arm_angle) * p.c < p.V_ms - data().fixed_volume)) [[unlikely]] {
      try {
        equations_.CheckVolumes(arm_angle);
      } catch (const ModelError& error) {
        throw ModelError(error.what() + Where(equations_, *now_));
      }
    }
  }

  bool OnBoundary() const {
    bool on = false;
    for (int i = 0; i < switches(); ++i) on |= now_->margin[i] == 0;
    return on;
  }

  double MarginRate(int i, const Point& at) const {
    return hydro::model::MarginRate<kForm>(data(), mode_, i, at.rate);
  }

  // Changes the switches that contradict the present state. True when any did.
  bool Settle() {
    bool changed = false;
    for (int round = 0; round < 4 * kMaxSwitches; ++round) {
      int wrong = -1;
      for (int i = 0; i < switches() && wrong < 0; ++i) {
        const double margin = now_->margin[i];
        if (margin < 0 || (margin == 0 && MarginRate(i, *now_) < 0)) wrong = i;
      }
      if (wrong < 0) return changed;
      fresh_ = true;
      equations_.Cross(wrong, now_->time, voltage_, now_->state, &mode_);
      ++mode_changes_;
      EvaluateHere();
      changed = true;
    }
    throw ModelError("no mode fits" + Where(equations_, *now_));
  }

  // A time in the step at which some switch is past its boundary; kNever when there is none. Margins that
  // fall and rise again within the step are looked at too.
  double FirstTrouble() const {
    double trouble = kNever;
    for (int i = 0; i < switches(); ++i) {
      if (next_->margin[i] < 0) trouble = std::min(trouble, next_->time);
    }
    if (trouble < kNever) return trouble;
    for (int i = 0; i < kFirstEffectSwitch; ++i) {
      const MarginEnds ends = {now_->margin[i], MarginRate(i, *now_), next_->margin[i],
                               MarginRate(i, *next_)};
      trouble = std::min(trouble, now_->time + DipWithin(next_->time - now_->time, ends));
    }
    return trouble;
  }

  double LeastMargin(const Point& at) const { return *std::min_element(at.margin, at.margin + switches()); }

  void At(double time, Point* at) {
    stepper_.Interpolate(*now_, *next_, time, at);
    Evaluate(at);
  }

  // Moves to the first event before `last`, where a margin is below 0, and changes the mode there.
  void ToEvent(double last) {
    Point& at = *spare_;
    At(last, &at);
    const double g_last = LeastMargin(at);
    if (g_last >= 0) {  // the cubic saw a dip that is not there
      GoTo(&next_);
      return;
    }
    const double event = TimeJustPast(now_->time, std::max(0.0, LeastMargin(*now_)), last, g_last,
                                      kEventWidth, [&](double time) {
                                        At(time, &at);
                                        return LeastMargin(at);
                                      });
    At(event, &at);  // just past the boundary
    if (event - now_->time > kMoment && !stepper_.Trusts(*now_, at)) {
      // Half the way first, so that a shorter step goes to the event.
      stepper_.Step(*now_, now_->time + 0.5 * (event - now_->time), next_);
      CheckFinite(*next_);
      if (LeastMargin(*next_) >= 0) {
        GoTo(&next_);
        return;
      }
    }
    GoTo(&spare_);
    for (int i = 0; i < switches(); ++i) {
      if (now_->margin[i] < 0) {
        equations_.Cross(i, now_->time, voltage_, now_->state, &mode_);
        ++mode_changes_;
      }
    }
    fresh_ = true;
    EvaluateHere();
    Settle();
    stepper_.Restart(*now_);
    Remember();
  }

  // Accepts a point.
  void GoTo(Point** point) {
    std::swap(now_, *point);
    Remember();
  }

  bool remembers() const { return kForm == Form::kGeneral && data().reads_late; }
  void Remember() {
    if (remembers()) history_.Add(now_->time, now_->state, now_->rate);
  }

  Equations& equations_;
  Mode mode_;
  double voltage_ = 0;
  bool started_ = false;
  bool fresh_ = true;  // mode or voltage is new
  double known_stop_ = kNever;
  int64_t mode_changes_ = 0;
  Point points_[3];
  Point* now_ = &points_[0];
  Point* next_ = &points_[1];
  Point* spare_ = &points_[2];
  StateHistory<double> history_;
  Stepper stepper_;
};

}  // namespace hydro::model
