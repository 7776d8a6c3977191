// What an experimenter does with the rig: drawn from the seed, open loop and closed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "machine.h"

namespace foreign_rig {

inline constexpr double kLargestVoltage = 11.5;  // V, of either sign

enum class Goal { kVoltage, kSpeed, kPressure, kAngle };

// From `start` until the next stretch begins; about `mean`, in V, rad/s, psi or rad.
struct Stretch {
  enum class Form { kHold, kRamp, kSine, kSquare, kChirp } form = Form::kHold;
  Goal goal = Goal::kVoltage;
  double start = 0, end = 0;  // s
  double mean = 0, swing = 0;
  double hz = 0, hz_end = 0;
};

struct Plan {
  std::string name;  // of the files; says nothing of what is in the rig
  bool held_out = false;
  Day day;
  std::vector<Stretch> stretches;  // the first begins before the recording, at -day.prelude
};

double Wanted(const Stretch& stretch, double t);

// Five runs to fit and three to hold out.
std::vector<Plan> DrawPlans(uint64_t seed, double seconds, double arm_reach);

// What differs from run to run without anyone's doing, as drawn for each run: of size 1.
struct Daily {
  double friction = 0;  // relative standard deviation of the dry torque
  double celsius = 0;   // standard deviation of the oil's temperature
  double payload = 0;   // largest part of the arm's weight that is added, free runs only
  double offset = 0;    // psi, standard deviation
  double supply = 0;    // psi, standard deviation
};
void ApplyDaily(const Daily& daily, uint64_t seed, std::vector<Plan>* plans);

}  // namespace foreign_rig
