// What a front end was told to put out, what it says that it does, and what its output reads back.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "bus/clock.h"
#include "firmware/frames.h"
#include "plant/rig.h"
#include "settings/driver_section.h"

namespace hydro::plant {

class OutputWatch {
 public:
  // `patience`: how long the output may take to follow (limits.stale_input_s).
  OutputWatch(const settings::DriverSection& driver, bus::Clock::Duration patience);

  // The frame `sequence` has told it a voltage, which came from the motor command for `command_tick` (-1:
  // from none).
  void OnTold(uint32_t sequence, double voltage, int64_t command_tick, bus::Clock::TimePoint now);

  // Adds "output_differs" while the voltage that a sample reports is not what the command that it names has
  // told, or not zero though the device is not armed or no command of late can have made it so, or while the
  // output reads back a voltage that was not put out within the patience: twice in a row where it is known what
  // it held, else for as long as the patience. `interval`: ticks of the device from one sample to the next.
  void Look(const hydro_sample& sample, uint32_t interval, bus::Clock::TimePoint now,
            std::vector<RigFault>* faults);

  double tolerance() const { return tolerance_; }  // V of eq. (1), of what is read back

  // Of the voltage that a sample reports as that of a command, the tick of the motor command; -1: it came
  // from none.
  int64_t CommandTick(const hydro_sample& sample) const;

 private:
  struct Told {
    uint32_t sequence;
    double voltage;
    int64_t command_tick;
    bus::Clock::TimePoint at;
  };
  struct PutOut {
    double voltage;
    bus::Clock::TimePoint at;
  };

  const Told* Find(const hydro_sample& sample) const;
  void LookAtReport(const hydro_sample& sample, std::vector<RigFault>* faults) const;
  void LookAtReadBack(const hydro_sample& sample, uint32_t interval, bus::Clock::TimePoint now,
                      std::vector<RigFault>* faults);
  bool Differs(double read_back, double nearest, bool held_is_known, bus::Clock::TimePoint now);

  // Whether the device may put out a voltage that no command of the driver's of late told it.
  bool MayPutOut(const hydro_sample& sample) const;

  const bool own_loop_;  // on the device
  const bus::Clock::Duration patience_;
  const double tolerance_;             // V of eq. (1)
  std::deque<Told> told_;              // within the patience, and the one before
  std::deque<PutOut> reported_;        // the same, by the device
  std::optional<uint64_t> last_tick_;  // of the sample before
  int differing_ = 0;                  // readings in a row, of those where it is known what the output held
  std::optional<bus::Clock::TimePoint> differs_since_;
};

}  // namespace hydro::plant
