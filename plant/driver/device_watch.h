// Watches whether a device still answers, and whether its output is the one that was put out.
#pragma once

#include <deque>
#include <utility>
#include <vector>

#include "bus/clock.h"
#include "plant/driver/device.h"

namespace hydro::plant {

class DeviceWatch {
 public:
  // `patience` is how old a device's newest reading may become, and how long its output may take to follow
  // (limits.stale_input_s).
  DeviceWatch(const DeviceDescription& description, bus::Clock::Duration patience, bus::Clock::TimePoint now);

  bus::Clock::Duration patience() const { return patience_; }

  // Records that `output` was put out.
  void OnDriven(double output, bus::Clock::TimePoint now);

  // Adds the faults that it finds: "device_silent" while no reading is newer than the patience,
  // "device_fault" while the device reports one, "output_differs" while the output that the device reads back
  // is none of those put out within the patience. Returns whether the device is silent.
  bool Look(const DeviceReadings& readings, bus::Clock::TimePoint now, std::vector<RigFault>* faults);

 private:
  void LookAtOutput(const Reading& output, bus::Clock::TimePoint now, std::vector<RigFault>* faults);

  std::string name_;
  DeviceOutput output_;
  bus::Clock::Duration patience_;
  bus::Clock::TimePoint heard_;
  std::deque<std::pair<bus::Clock::TimePoint, double>>
      driven_;  // the outputs within the patience, and the one before
};

}  // namespace hydro::plant
