// A fresh device and a fresh driver, for one case.
#pragma once

#include <optional>
#include <stdexcept>
#include <string>

#include "bus/udpm/udpm_url.h"
#include "plant/check/checked_device.h"
#include "plant/check/checked_stack.h"
#include "plant/check/driver_cases.h"

namespace hydro::plant {

// The driver has ended before it was ready, or never was.
class NotBegun : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class DriverTrial {
 public:
  explicit DriverTrial(const TrialSettings& settings);

  CheckedDevice& device() { return *device_; }
  CheckedStack& stack() { return *stack_; }
  double stale_s() const { return stale_s_; }
  double tick_s() const { return tick_s_; }

  // Waits until the driver has announced that it is ready. Throws NotBegun, with what the driver said, when
  // it does not.
  void AwaitReady();
  // Does the same, then lets the loops begin and waits for a voltage at the machine.
  void Drive();
  bool AwaitVoltage(double limit_s);

  // Waits until the machine has had zero volts for longer than the alternating voltage holds a value. Returns
  // the time in seconds from the call until that zero began, or nothing when it did not begin within the
  // limit.
  std::optional<double> AwaitZero(double limit_s);
  // Waits in the same way for the end of the driver.
  bool AwaitEnd(double limit_s) {
    return stack_->Await([this] { return stack_->Ended(); }, limit_s);
  }

  static bool IsZero(double voltage);

 private:
  std::string WhatItSaid() const;  // "; it said: ...", or nothing

  bus::ReservedPort port_;
  double stale_s_, tick_s_, ready_s_;
  std::optional<CheckedDevice> device_;
  std::optional<CheckedStack> stack_;
};

}  // namespace hydro::plant
