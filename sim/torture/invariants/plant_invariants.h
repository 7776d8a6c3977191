// The invariants of the voltage, checked at each tick of a plant.
#pragma once

#include <cstdint>
#include <string>

#include "model/terms/measurement.h"
#include "sim/torture/invariants/observer.h"
#include "sim/torture/invariants/records.h"

namespace hydro::torture {

class PlantInvariants {
 public:
  PlantInvariants(Observer& observer, PlantRecord& plant) : observer_(observer), plant_(plant) {}

  // The sensors have been read at `tick`, under the voltage of the previous tick and with the faults that
  // were published with it. `suspended_ns` is the suspended time according to the machine's clocks.
  void OnRead(int64_t tick, const model::Measurement& measured, int64_t suspended_ns);
  void OnDrive(int64_t tick, double voltage);

 private:
  bool realtime() const { return observer_.config_.time.mode == settings::TimeMode::kRealtime; }
  int64_t stale_ticks() const;
  void Latch(int64_t tick, const std::string& why);
  // Whether a reading is beyond a limit that holds at this tick.
  bool IsOverLimit(int64_t tick, const model::Measurement& measured);
  void CheckRange(int64_t tick, double voltage);
  void CheckOrigin(int64_t tick, double voltage);
  void CheckLatched(int64_t tick);
  void CheckStopped(int64_t tick);
  void CheckSupervised(int64_t tick);
  void CheckSenders(int64_t tick, double voltage);
  void CheckOtherPlant(int64_t tick, double voltage);
  void CheckOtherConfiguration(int64_t tick);

  Observer& observer_;
  PlantRecord& plant_;
};

}  // namespace hydro::torture
