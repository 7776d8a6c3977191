// How far a rig is from one that lacks what is hidden in it, in noise units.
//
// Predictions start from the true state every kWindow, so that small differences do not grow without end.
// What other values of the plain model's parameters, or another start of each window, could explain is taken
// off (to first order), since no one would miss an effect that they explain: an offset of both pressures is
// another supply pressure and other starts. Values are as far off as a model file may have them: with any
// values at all a gain of the pressures would be nothing, since the equations are the same for scaled
// pressures.
#pragma once

#include <vector>

#include "directions.h"
#include "plan.h"
#include "recorder.h"

namespace foreign_rig {

// Of the order of the machine's own time constants (J/b is 2 s): effects that act slowly show, and chance
// does not grow.
inline constexpr double kWindow = 1.2;  // s

class GapMeter {
 public:
  // Judges on these plans; `noise` is that of each channel.
  GapMeter(std::vector<Plan> plans, const std::array<double, kChannels>& noise, double seconds);

  // Root of the mean square over all samples of all measured signals, of the difference between the two.
  // Infinite where the machine breaks.
  double Between(const Rig& with, const Rig& without) const;

  // The same, and what is left of it beyond what other values of `without`, within twice their uncertainty,
  // and other starts of its windows explain. Takes some ten times as long.
  struct Parts {
    double gap, beyond;
  };
  Parts Beyond(const Rig& with, const Rig& without) const;

 private:
  // Differences to a rig in one window, noise units, from the true start of the window and from others.
  struct Window {
    std::vector<Series> rigs;    // of each rig
    std::vector<Series> starts;  // of the first rig, from each other start
  };
  std::vector<Window> Windows(const Rig& with, const std::vector<Rig>& others, bool other_starts) const;
  void AddWindows(const Rig& with, const std::vector<Rig>& others, bool other_starts, const Plan& plan,
                  std::vector<Window>* windows) const;
  double ShiftOf(Machine::Start start) const;
  void Append(const Reading& a, const Reading& b, const Plan& plan, Series* to) const;

  std::vector<Plan> plans_;
  std::array<double, kChannels> noise_;
  double seconds_;
};

}  // namespace foreign_rig
