// Whether a device still answers, and whether its output is what was put out.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "bus/clock.h"
#include "plant/driver/device.h"

namespace hydro::plant {

class DeviceWatch {
 public:
  // `patience`: how old a device's newest reading may become, and how long its output may take
  // (limits.stale_input_s).
  DeviceWatch(const DeviceDescription& description, bus::Clock::Duration patience, bus::Clock::TimePoint now);

  bus::Clock::Duration patience() const { return patience_; }

  // An output was put out.
  void OnDriven(double output, bus::Clock::TimePoint now);

  // Adds what is wrong: "device_silent" while no reading is newer than the patience, "device_fault" while the
  // device reports one, "output_differs" while the output that it reads back is none that was put out within
  // the patience. Returns whether it is silent.
  bool Look(const DeviceReadings& readings, bus::Clock::TimePoint now, std::vector<RigFault>* faults);

 private:
  void LookAtOutput(const Reading& output, bus::Clock::TimePoint now, std::vector<RigFault>* faults);

  std::string name_;
  DeviceOutput output_;
  bus::Clock::Duration patience_;
  bus::Clock::TimePoint heard_;
  std::deque<std::pair<bus::Clock::TimePoint, double>>
      driven_;  // those within the patience, and the one before
};

}  // namespace hydro::plant
