// Sensors and recorder: filters, coloured noise, hum, drift, steps, jitter, spikes, dropouts.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "draw.h"
#include "machine.h"

namespace foreign_rig {

inline constexpr int kChannels = 5;  // motor speed, motor angle, arm angle, p1, p2
enum { kSpeed, kShaft, kArmAngle, kSide1, kSide2 };

struct Channel {
  double noise = 0;            // standard deviation in all, in our units
  double coloured = 0;         // part of its variance that is coloured
  double colour_time = 0.005;  // s
  double hum = 0;              // amplitude, at 50 Hz
  double wander = 0;           // drift by the end of a run, standard deviation
  double step = 0;             // resolution
  double filter = 0;           // s, first order
};

struct Recorder {
  double rate = 1000;
  std::array<Channel, kChannels> channels;
  bool averages = false;      // each sample is the mean since the last
  double jitter = 0;          // of an interval, standard deviation
  bool jitter_known = false;  // the time column has it
  double spikes = 0;          // per second and channel
  double dropouts = 0;        // per second, all channels
  enum class Dropout { kMissing, kHeld } dropout = Dropout::kMissing;
  bool motor_speed = true, motor_angle = false;
  double stated = 0;  // of each noise unit, what the sidecars state; 0: no word
};

// Of ordinary quality: all of the above in some measure. Rates from `slowest` to 2 kHz.
Recorder DrawRecorder(uint64_t seed, double slowest);

// Root of the mean square of what the recorder adds to a signal, apart from spikes.
double NoiseUnit(const Channel& channel);

using Sample = std::array<double, kChannels>;

// The sensors during one run.
class Sensing {
 public:
  Sensing(const Recorder& recorder, uint64_t seed, double seconds);

  // Follows the signals, once a step.
  void Follow(const Reading& reading);
  // Takes a sample at t.
  Sample Take(double t);

 private:
  const Recorder& recorder_;
  Draw draw_;
  Sample filtered_{}, sum_{}, colour_{}, slope_{}, held_{};
  double hum_phase_;
  int count_ = 0;
  bool started_ = false;
  int lost_ = 0;  // samples still to be lost
};

}  // namespace foreign_rig
