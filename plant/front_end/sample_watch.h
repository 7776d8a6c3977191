// Finds what cannot be true in the samples of a front end: numbers that no field has, fields that contradict
// each other, and a clock that does not go on. output_watch.h judges the voltage.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "firmware/frames.h"
#include "plant/credible_ends.h"
#include "plant/rig.h"

namespace hydro::plant {

// Of each sensor of a front end, in the order of its settings.
using SensorEnds = std::array<CredibleEnds, HYDRO_SENSORS>;

// A sample, and when it arrived as which one of the run.
struct ArrivedSample {
  const hydro_sample& sample;
  bus::Clock::TimePoint at;
  int64_t number;
};

class SampleWatch {
 public:
  explicit SampleWatch(const SensorEnds& ends) : ends_(ends) {}

  // Adds "device_fault" for what the device says of itself and of its clock, and "sensor_NAME" for counts
  // that differ from their angle or have moved faster than the shaft can. The same sample may be looked at
  // again.
  void Look(const ArrivedSample& arrived, const hydro_settings& settings, uint32_t tick_rate_hz,
            std::vector<RigFault>* faults);

  // Whether the counts of the motor's and the arm's angle in the newest sample can be.
  bool MotorCountIsWrong() const { return !wrong_counts_[0].empty(); }
  bool ArmCountIsWrong() const { return !wrong_counts_[1].empty(); }

  // The device's clock and counters may begin anew: it has reset itself, or the link was cut.
  void Forget();

 private:
  void LookAtClock(const ArrivedSample& arrived, uint32_t tick_rate_hz, std::vector<RigFault>* faults);
  std::string WrongTick(const ArrivedSample& arrived, uint32_t tick_rate_hz) const;
  void MeasureRate(const ArrivedSample& arrived, uint32_t tick_rate_hz);
  void LookAtCounts(const ArrivedSample& arrived, const hydro_settings& settings, uint32_t tick_rate_hz,
                    std::vector<RigFault>* faults);
  std::string WrongMove(const ArrivedSample& arrived, size_t i, const hydro_sensor_settings& sensor,
                        uint32_t tick_rate_hz) const;

  struct Seen {
    uint64_t tick;
    bus::Clock::TimePoint at;
    int64_t number;
    std::array<int32_t, 2> counts;  // of the motor and of the arm
    uint8_t state;
    uint32_t trips;
  };
  struct Begin {
    uint64_t tick;
    bus::Clock::TimePoint at;
  };

  const SensorEnds& ends_;
  std::optional<Seen> before_;
  std::optional<Begin> window_;  // in which the rate of the device's clock is measured
  int wrong_windows_ = 0;        // in a row
  double rate_ = 1;              // of the device's clock, as measured in the last window
  std::string wrong_tick_;       // of the newest sample
  bool left_uncounted_ = false;  // the newest sample is not armed any more, and counts no trip
  std::array<std::string, 2> wrong_counts_;
};

}  // namespace hydro::plant
