// The mode machine: runs any stepper from event to event, for the simulated plant and for Respond. A
// template, for .cc files of model/ only.
//
// A stepper integrates one smooth mode. Its constructor takes pointers to the mode and the voltage, which the
// machine changes:
//   void Restart(const PointOf<T>& now)     the state or the mode has changed
//   void NewVoltage(const PointOf<T>& now)  only the voltage has changed
//   void Step(const PointOf<T>& now, double stop, PointOf<T>* next)
//       one step, to no later than `stop`; fills all of next; throws ModelError
//   void Interpolate(const PointOf<T>& now, const PointOf<T>& next, double time, PointOf<T>* at)
//       time and state within the last step; for Jet also with Point* at, the values alone
//   bool Trusts(const PointOf<T>& now, const PointOf<T>& at) const
//       the interpolation to `at` is accurate enough
//   Integrator in_use() const
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>

#include "model/equations/evaluate.h"
#include "model/equations/state_history.h"
#include "model/integrate/event_search.h"
#include "model/integrate/point.h"

namespace hydro::model {

template <Form kForm>
struct FormSize {
  static int states(const EquationData& m) {
    if constexpr (kForm == Form::kPlainClamped) return 4;
    if constexpr (kForm == Form::kPlainFree || kForm == Form::kPlainLoaded) return 6;
    return m.states;
  }
  static int switches(const EquationData& m) {
    if constexpr (kForm != Form::kGeneral) return kFirstEffectSwitch;
    return m.switches;
  }
};

// T is double or Jet. A Jet carries all derivatives seeded in the numbers and in the start, also past events
// whose times depend on them. Only the values determine steps and events, so both types compute the same
// bits.
template <class T, Form kForm, class Stepper>
class ModeMachine {
  static constexpr bool kDerivatives = !std::is_same_v<T, double>;
  static_assert(!kDerivatives || kForm == Form::kGeneral);

 public:
  // `numbers` are those of the equations, seeded when T is Jet. All arguments must outlive the machine, and
  // nothing else may use the equations while it runs (Equations::Command, PassStop). `options` go to the
  // stepper.
  template <class... StepperOptions>
  ModeMachine(Equations* equations, const NumbersOf<T>* numbers, const StepperOptions&... options)
      : equations_(*equations),
        numbers_(numbers),
        history_(equations->states(), equations->data().reach),
        stepper_(&mode_, &voltage_, equations, options...) {}
  ModeMachine(const ModeMachine&) = delete;  // the stepper has pointers into it
  ModeMachine& operator=(const ModeMachine&) = delete;

  // Call this once, before anything else. `state` has all states; `mode` settles when the first voltage is
  // known.
  void Start(double time, const T* state, const Mode& mode) {
    now_->time = time;
    std::copy_n(state, equations_.states(), now_->state);
    mode_ = mode;
    PassStop();
  }

  const PointOf<T>& now() const { return *now_; }
  const Mode& mode() const { return mode_; }
  double voltage() const { return voltage_; }
  const StateHistory<T>* history() const { return remembers() ? &history_ : nullptr; }
  int64_t mode_changes() const { return mode_changes_; }
  Integrator in_use() const { return stepper_.in_use(); }

  // As Simulation::MoveArm. The next Advance starts afresh.
  void MoveArm(double angle, double speed) requires(!kDerivatives) {
    equations_.MoveArm(now_->time, voltage_, mode_, angle, speed, now_->state);
    started_ = false;
  }
  void NewLoad() { started_ = false; }

  // Sets the outside influences until the next call.
  void Surround(const Surroundings& around) {
    if (around == data().around) return;
    equations_.Surround(around);
    surrounded_ = true;
  }

  // As Actuator::Advance.
  void Advance(double voltage, double until) {
    if (!std::isfinite(voltage)) throw ModelError("the voltage is not finite" + Where(equations_, *now_));
    if (!(until >= now_->time) || std::isinf(until)) {
      throw ModelError("cannot advance to t = " + std::to_string(until) + " s" + Where(equations_, *now_));
    }
    if (voltage != voltage_ || !started_ || surrounded_) Command(voltage);
    while (now_->time < until) {
      double stop = std::min(until, known_stop_);
      if (remembers()) stop = std::min(stop, now_->time + kLongestStepToRead);
      CountStep();
      // Gives a switch on its boundary a moment to show which way it goes.
      if (fresh_ && OnBoundary()) stop = std::min(stop, now_->time + kMoment);
      fresh_ = false;
      stepper_.Step(*now_, stop, next_);
      CheckFinite(*next_);
      if constexpr (kForm != Form::kPlainClamped) {
        if (data().shaft == Shaft::kFree) {
          CheckArm(ValueOf(next_->state[kForm == Form::kGeneral ? data().actuator_angle_state : kArmAngle]));
        }
      }
      const double last = FirstTrouble();
      if (last <= next_->time) {
        CountEvent();
        ToEvent(last);
      } else {
        GoTo(&next_);
        if (now_->time >= known_stop_) ToKnownStop();
      }
    }
  }

 private:
  static constexpr double kMoment = 1e-6;       // s
  static constexpr double kEventWidth = 1e-11;  // s, within which an event is located
  static constexpr int kMostEvents = 10000;     // within kLongestStep of time
  static constexpr int kMostSteps = 200000;     // within kLongestStep too: twenty times slower than real time
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  struct Nothing {};

  const EquationData& data() const { return equations_.data(); }
  // Without derivatives these are the equations' own numbers, so the compiler knows them.
  const NumbersOf<T>& numbers() const {
    if constexpr (kDerivatives) {
      return *numbers_;
    } else {
      return data();
    }
  }
  int switches() const { return FormSize<kForm>::switches(data()); }

  void Evaluate(Point* at) {
    EvaluatePoint<kForm>(data(), at->time, voltage_, mode_, at->state, at->rate, at->margin);
  }
  void Evaluate(PointOf<Jet>* at) requires kDerivatives {
    EvaluateTerms<kForm, Jet>(data(), *numbers_, at->time, Jet(voltage_), mode_, at->state, at->rate, terms_);
    FindMargins<kForm, Jet>(data(), *numbers_, mode_, terms_, at->margin);
  }
  void EvaluateHere() { Evaluate(now_); }

  void Command(double voltage) {
    fresh_ = true;
    surrounded_ = false;
    if constexpr (kForm == Form::kGeneral) {
      if (voltage != voltage_ || !commanded_) {
        equations_.Command(now_->time, voltage);
        PassStop();
      }
      commanded_ = true;
    }
    voltage_ = voltage;
    EvaluateHere();
    const bool settled = Settle();
    if constexpr (kDerivatives) {
      if (!started_ && mode_.pump == 0) {  // at rest, or about to be at rest
        now_->state[kMotorSpeed] = T(0.0);
        EvaluateHere();
      }
    }
    if (settled || !started_) {
      stepper_.Restart(*now_);
    } else {
      stepper_.NewVoltage(*now_);
    }
    started_ = true;
    Remember();
  }

  void PassStop() {
    equations_.PassStop(now_->time);
    known_stop_ = equations_.NextStop(now_->time);
  }

  void CheckFinite(const PointOf<T>& at) const {
    double sum = 0;
    for (int i = 0; i < FormSize<kForm>::states(data()); ++i) sum += ValueOf(at.state[i]);
    if (!std::isfinite(sum)) throw ModelError("a state is not finite" + Where(equations_, at));
    CheckMargins(at);
  }

  // A load that is not a number would hold the pump for ever: it never exceeds the friction, and nothing that
  // moves would reveal it. Only an effect's formula can produce one.
  void CheckMargins(const PointOf<T>& at) const {
    if constexpr (kForm == Form::kGeneral) {
      for (int i = 0; i < switches(); ++i) {
        if (!std::isnan(ValueOf(at.margin[i]))) continue;
        throw ModelError("an effect gives what is not a number" + Where(equations_, at));
      }
    }
  }

  void CheckArm(double arm_angle) const {
    if (!equations_.HasVolumes(arm_angle)) [[unlikely]] {
      try {
        equations_.CheckVolumes(arm_angle);
      } catch (const ModelError& error) {
        throw ModelError(error.what() + Where(equations_, *now_));
      }
    }
  }

  bool OnBoundary() const {
    bool on = false;
    for (int i = 0; i < switches(); ++i) on |= ValueOf(now_->margin[i]) == 0;
    return on;
  }

  double MarginRate(int i, const PointOf<T>& at) const {
    return hydro::model::MarginRate<kForm>(data(), mode_, i, at.rate);
  }

  void Cross(int which) {
    CrossSwitch<T>(data(), numbers(), which, now_->time, T(voltage_), now_->state, &mode_);
    ++mode_changes_;
  }

  // Changes the switches that contradict the current state. Returns true when any changed.
  bool Settle() {
    bool changed = false;
    CheckMargins(*now_);
    for (int round = 0; round < 4 * kMaxSwitches; ++round) {
      int wrong = -1;
      for (int i = 0; i < switches() && wrong < 0; ++i) {
        const double margin = ValueOf(now_->margin[i]);
        if (margin < 0 || (margin == 0 && MarginRate(i, *now_) < 0)) wrong = i;
      }
      if (wrong < 0) return changed;
      fresh_ = true;
      Cross(wrong);
      EvaluateHere();
      changed = true;
    }
    throw ModelError("no mode fits" + Where(equations_, *now_));
  }

  // A time in the step at which some switch is past its boundary; kNever if there is none. Also checks
  // margins that fall and rise again within the step.
  double FirstTrouble() const {
    double trouble = kNever;
    for (int i = 0; i < switches(); ++i) {
      if (ValueOf(next_->margin[i]) < 0) trouble = std::min(trouble, next_->time);
    }
    if (trouble < kNever) return trouble;
    for (int i = 0; i < kFirstEffectSwitch; ++i) {
      const MarginEnds ends = {ValueOf(now_->margin[i]), MarginRate(i, *now_), ValueOf(next_->margin[i]),
                               MarginRate(i, *next_)};
      trouble = std::min(trouble, now_->time + DipWithin(next_->time - now_->time, ends));
    }
    return trouble;
  }

  template <class S>
  int Least(const PointOf<S>& at) const {
    int least = 0;
    for (int i = 1; i < switches(); ++i) {
      if (ValueOf(at.margin[i]) < ValueOf(at.margin[least])) least = i;
    }
    return least;
  }
  template <class S>
  double LeastMargin(const PointOf<S>& at) const {
    return ValueOf(at.margin[Least(at)]);
  }

  template <class S>
  void At(double time, PointOf<S>* at) {
    stepper_.Interpolate(*now_, *next_, time, at);
    Evaluate(at);
  }

  // The point used to search for an event, where the values suffice.
  Point& probe() {
    if constexpr (kDerivatives) {
      return probe_;
    } else {
      return *spare_;
    }
  }

  // Limits the work by counts, not by the clock, so that no model's numbers can hang a simulation, and the
  // same model ends at the same step everywhere.
  void CountStep() {
    if (now_->time > counted_since_ + kLongestStep) [[unlikely]] {
      counted_since_ = now_->time;
      steps_ = events_ = 0;
    }
    static_assert(kMostSteps == 200000);  // as text it would be a copy of the library's (response_wide.cc)
    if (++steps_ > kMostSteps) [[unlikely]]
      throw TooManySteps("too fast to simulate: more than 200000 steps within 0.01 s" +
                         Where(equations_, *now_));
  }

  // Throws when there are more events than the switches of any machine produce: two of them undo each other.
  void CountEvent() {
    if (++events_ > kMostEvents) throw ModelError("the switches chatter" + Where(equations_, *now_));
  }

  // Moves to the first event before `last`, where a margin is below 0, and changes the mode there.
  void ToEvent(double last) {
    Point& at = probe();
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
    At(event, spare_);  // just past the boundary
    if (event - now_->time > kMoment && !stepper_.Trusts(*now_, *spare_)) {
      // Stops halfway first, so that a shorter step reaches the event.
      stepper_.Step(*now_, now_->time + 0.5 * (event - now_->time), next_);
      CheckFinite(*next_);
      if (LeastMargin(*next_) >= 0) {
        GoTo(&next_);
        return;
      }
    }
    GoTo(&spare_);
    CrossAll();
  }

  // Changes all switches whose margin is below 0 at this point.
  void CrossAll() {
    T later{};
    if constexpr (kDerivatives) {
      later = EventShift(data(), voltage_, mode_, *now_, Least(*now_), terms_);
      Shift(later);
    }
    for (int i = 0; i < switches(); ++i) {
      if (ValueOf(now_->margin[i]) < 0) Cross(i);
    }
    Resume(later);
  }

  void ToKnownStop() {
    T later{};
    if constexpr (kDerivatives) {
      for (const auto& effect : data().effects) {
        if (effect->NextStop(now_->time - kMoment) <= now_->time) {
          later += effect->StopShift(numbers_->own.data() + effect->first_parameter());
        }
      }
      Shift(later);
    }
    PassStop();
    Resume(later);
  }

  // Continues after the right-hand side has jumped.
  void Resume(const T& later) {
    fresh_ = true;
    EvaluateHere();
    Settle();
    if constexpr (kDerivatives) {
      Shift(-later);
      EvaluateHere();
    }
    stepper_.Restart(*now_);
    Remember();
  }

  // Shifts the state to the true time of an event, `later` than the current one. When it is shifted back in
  // the mode that follows, the state has gained what the event's time adds to the derivatives. The values do
  // not change.
  void Shift(const T& later) {
    for (int i = 0; i < data().states; ++i) now_->state[i] += now_->rate[i] * later;
  }

  // Accepts a point.
  void GoTo(PointOf<T>** point) {
    std::swap(now_, *point);
    Remember();
  }

  bool remembers() const { return kForm == Form::kGeneral && data().reads_late; }
  void Remember() {
    if (remembers()) history_.Add(now_->time, now_->state, now_->rate);
  }

  Equations& equations_;
  const NumbersOf<T>* numbers_;
  Mode mode_;
  double voltage_ = 0;
  bool started_ = false;
  bool commanded_ = false;   // the equations have received a voltage
  bool fresh_ = true;        // the mode or the voltage is new
  bool surrounded_ = false;  // the outside influences are new
  double known_stop_ = kNever;
  int64_t mode_changes_ = 0;
  int steps_ = 0;  // since counted_since_, s, as are the events
  int events_ = 0;
  double counted_since_ = -kNever;
  PointOf<T> points_[3];
  PointOf<T>* now_ = &points_[0];
  PointOf<T>* next_ = &points_[1];
  PointOf<T>* spare_ = &points_[2];
  [[no_unique_address]] std::conditional_t<kDerivatives, Point, Nothing> probe_;
  [[no_unique_address]] std::conditional_t<kDerivatives, Terms<T>, Nothing> terms_;
  StateHistory<T> history_;
  Stepper stepper_;
};

}  // namespace hydro::model
