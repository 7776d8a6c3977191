// How far a rig is from one that lacks what is hidden in it, in noise units.
//
// Predictions start from the true state every kWindow, so that small differences do not grow without end.
// What other values of the plain model's parameters could explain is taken off (to first order), since no one
// would miss an effect that they explain.
#pragma once

#include <vector>

#include "plan.h"
#include "recorder.h"

namespace foreign_rig {

// Of the order of the machine's own time constants (J/b is 2 s): effects that act slowly show, and chance does
// not grow.
inline constexpr double kWindow = 1.2;  // s

class GapMeter {
 public:
  // Judges on these plans; `noise` is that of each channel.
  GapMeter(std::vector<Plan> plans, const std::array<double, kChannels>& noise, double seconds);

  // Root of the mean square over all samples of all measured signals, of the difference between the two.
  // Infinite where the machine breaks.
  double Between(const Rig& with, const Rig& without) const;

  // The same, and what is left of it beyond what other values of `without` explain. Takes some ten times as
  // long.
  struct Parts {
    double gap, beyond;
  };
  Parts BeyondValues(const Rig& with, const Rig& without) const;

 private:
  // Differences of each of `others`, noise units, of all windows.
  std::vector<std::vector<double>> AllDifferences(const Rig& with, const std::vector<Rig>& others) const;
  void Append(const Reading& a, const Reading& b, const Plan& plan, std::vector<double>* to) const;

  std::vector<Plan> plans_;
  std::array<double, kChannels> noise_;
  double seconds_;
};

}  // namespace foreign_rig
