// Compares what a front end was told to put out, what it reports that it puts out, and what its output reads
// back.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "bus/clock.h"
#include "firmware/law.h"
#include "firmware/settings.h"
#include "plant/rig.h"
#include "settings/driver_section.h"

namespace hydro::plant {

class OutputWatch {
 public:
  // `patience`: how long the output may take to follow (limits.stale_input_s). `transfer`: within what time a
  // change of gains passes on the device (limits.transfer_s).
  OutputWatch(const settings::DriverSection& driver, bus::Clock::Duration patience,
              bus::Clock::Duration transfer);

  // Records that the frame `sequence` has told the device a voltage, which came from the motor command for
  // `command_tick` (-1: from none).
  void OnTold(uint32_t sequence, double voltage, int64_t command_tick, bus::Clock::TimePoint now);

  // The frame `sequence` has told it to act by eq. (16).
  void OnTold(uint32_t sequence, float pressure_ref, const hydro_gains& gains, bus::Clock::TimePoint now);

  // Adds "output_differs" while the voltage that a sample reports is not what the command that it names has
  // told, of a loop on the device what eq. (16) gives for the readings of that very sample; or not zero
  // though the device is not armed or no command of late can have made it so; or that command was never sent;
  // or `saturated` is not what the limits make of it; or while the output reads back a voltage that was not
  // put out within the patience: twice in a row where it is known what it held, else for as long as the
  // patience. `range`: what the device can put out. `interval`: ticks of the device from one sample to the
  // next.
  void Look(const hydro_sample& sample, const hydro_voltage_range& range, uint32_t interval,
            bus::Clock::TimePoint now, std::vector<RigFault>* faults);

  double tolerance() const { return tolerance_; }  // V of eq. (1), for the voltage that is read back

  // The tick of the motor command from which the voltage of a sample came, if a command told it; -1: it came
  // from none.
  int64_t CommandTick(const hydro_sample& sample) const;
  // Whether the sample names a command that was sent before all that are kept, and puts out a voltage.
  bool ActsByAnOldCommand(const hydro_sample& sample) const;
  // Whether the sample's voltage comes from eq. (16) by a command of late.
  bool ActsByLaw(const hydro_sample& sample) const;

 private:
  struct ByLaw {
    float pressure_ref;
    hydro_gains gains;
  };
  struct Told {
    uint32_t sequence;
    double voltage;
    int64_t command_tick;
    bus::Clock::TimePoint at;
    std::optional<ByLaw> by_law = {};  // what it computes the voltage from
  };
  struct PutOut {
    double voltage;
    bus::Clock::TimePoint at;
  };

  void Keep(const Told& told);
  const Told* Find(const hydro_sample& sample) const;
  void LookAtReport(const hydro_sample& sample, const hydro_voltage_range& range,
                    std::vector<RigFault>* faults) const;
  void LookAtUnsent(const hydro_sample& sample, std::vector<RigFault>* faults) const;
  void LookAtLaw(const hydro_sample& sample, const ByLaw& told, const hydro_voltage_range& range,
                 bus::Clock::TimePoint now, std::vector<RigFault>* faults);
  // Whether a change of gains may still be passing.
  bool AChangePasses(bus::Clock::TimePoint now) const;
  // The largest voltage that a change of gains may add to eq. (16) now.
  double MostTransfer(const hydro_sample& sample, const ByLaw& told, bus::Clock::TimePoint now);
  void LookAtReadBack(const hydro_sample& sample, uint32_t interval, bus::Clock::TimePoint now,
                      std::vector<RigFault>* faults);
  bool Differs(double read_back, double nearest, bool held_is_known, bus::Clock::TimePoint now);

  // Whether the device may put out a voltage that no recent command of the driver told it.
  bool MayPutOut(const hydro_sample& sample) const;
  bool IsOld(const hydro_sample& sample) const;

  const bool own_loop_;  // on the device
  const bus::Clock::Duration patience_, transfer_;
  const double tolerance_;            // V of eq. (1)
  std::deque<Told> told_;             // within the patience, and the one before
  std::optional<uint32_t> first_;     // the first number that was told, or the oldest that counts as older
  std::optional<hydro_gains> gains_;  // told last
  std::optional<bus::Clock::TimePoint> gains_changed_at_;
  // The gains before the change, by how much it may move the voltage, and what changes before it have left.
  hydro_gains former_gains_{};
  double moved_ = 0, left_ = 0;        // V
  std::deque<PutOut> reported_;        // the same, by the device
  std::optional<uint64_t> last_tick_;  // of the sample before
  int differing_ = 0;  // readings in a row, among those for which the earlier voltage is known
  std::optional<bus::Clock::TimePoint> differs_since_;
};

}  // namespace hydro::plant
