// Compares what a front end was told to put out, what it reports that it puts out, and what its output reads
// back.
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
  // `patience` is how long the output may take to follow (limits.stale_input_s).
  OutputWatch(const settings::DriverSection& driver, bus::Clock::Duration patience);

  // Records that the frame `sequence` has told the device a voltage, which came from the motor command for
  // `command_tick` (-1: from none).
  void OnTold(uint32_t sequence, double voltage, int64_t command_tick, bus::Clock::TimePoint now);

  // Adds "output_differs" in three cases. First, the voltage that a sample reports is not the one that the
  // command it names has told. Second, the voltage is not zero although the device is not armed or no recent
  // command can have caused it. Third, the output reads back a voltage that was not put out within the
  // patience: twice in a row when its earlier voltage is known, otherwise for as long as the patience.
  // `interval` is the number of the device's ticks from one sample to the next.
  void Look(const hydro_sample& sample, uint32_t interval, bus::Clock::TimePoint now,
            std::vector<RigFault>* faults);

  double tolerance() const { return tolerance_; }  // V of eq. (1), for the voltage that is read back

  // The tick of the motor command from which the voltage of a sample came, if a command told it; -1: it came
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

  // Whether the device may put out a voltage that no recent command of the driver told it.
  bool MayPutOut(const hydro_sample& sample) const;

  const bool own_loop_;  // on the device
  const bus::Clock::Duration patience_;
  const double tolerance_;             // V of eq. (1)
  std::deque<Told> told_;              // within the patience, and the one before
  std::deque<PutOut> reported_;        // reported by the device, likewise
  std::optional<uint64_t> last_tick_;  // of the sample before
  int differing_ = 0;  // readings in a row, among those for which the earlier voltage is known
  std::optional<bus::Clock::TimePoint> differs_since_;
};

}  // namespace hydro::plant
