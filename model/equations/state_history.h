// The states that a simulation has passed, for sensors that read late (sensor.skew). A template, for .cc
// files of model/ only.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "model/terms/state.h"
#include "model/terms/terms.h"

namespace hydro::model {

// Between the recorded times, states follow the cubic through both ends with their rates. T is double, or a
// scalar with derivatives. The derivatives of the states are at fixed time; a requested time may carry
// derivatives too.
template <class T>
class StateHistory {
 public:
  // Keeps what is needed for times up to `reach` seconds before the last recorded time.
  StateHistory(int states, double reach) : states_(states), reach_(reach) {}

  // Adds the next accepted state, in order of time. Where the state or its rate jumps (a switch, a new
  // voltage), add two states for the same time, one from before the jump and one from after it.
  void Add(double time, const T* state, const T* rate) {
    if (!times_.empty() && time < times_.back()) Forget();
    times_.push_back(time);
    numbers_.insert(numbers_.end(), state, state + states_);
    numbers_.insert(numbers_.end(), rate, rate + states_);
    while (first_ + 1 < times_.size() && times_[first_ + 1] <= time - reach_) ++first_;
    if (first_ > 1000) Drop();
  }

  void Forget() {
    times_.clear();
    numbers_.clear();
    first_ = 0;
  }

  bool empty() const { return times_.empty(); }

  // The state at `*time`. Before the first recorded state, it returns that state and sets `*time` to its
  // time. After the last one, it continues at the last rate. The history must not be empty.
  void At(T* time, T* state) const {
    if (*time < T(times_[first_])) *time = T(times_[first_]);
    const auto after = std::upper_bound(times_.begin() + static_cast<std::ptrdiff_t>(first_), times_.end(),
                                        *time, [](const T& t, double node) { return t < T(node); });
    const size_t i = static_cast<size_t>(after - times_.begin()) - 1;
    const T* y_0 = numbers_.data() + 2 * i * static_cast<size_t>(states_);
    const T* rate_0 = y_0 + states_;
    const T since = *time - times_[i];
    if (after == times_.end()) {
      for (int k = 0; k < states_; ++k) state[k] = y_0[k] + since * rate_0[k];
      return;
    }
    const T* y_1 = rate_0 + states_;
    const T* rate_1 = y_1 + states_;
    const double h = *after - times_[i];
    const T s = since / h;
    for (int k = 0; k < states_; ++k) {  // Hermite
      const T rise = y_1[k] - y_0[k];
      const T a = h * rate_0[k] - rise;
      const T b = rise - h * rate_1[k];
      state[k] = y_0[k] + s * (rise + (1.0 - s) * (a + s * (b - a)));
    }
  }

 private:
  void Drop() {
    times_.erase(times_.begin(), times_.begin() + static_cast<std::ptrdiff_t>(first_));
    numbers_.erase(numbers_.begin(),
                   numbers_.begin() + static_cast<std::ptrdiff_t>(2 * first_ * static_cast<size_t>(states_)));
    first_ = 0;
  }

  int states_;
  double reach_;
  std::vector<double> times_;
  std::vector<T> numbers_;  // at each time the states, then the rates
  size_t first_ = 0;        // entries before this are no longer needed
};

}  // namespace hydro::model
