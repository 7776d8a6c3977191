// The simulated device of a driver under test. The check tells it what goes wrong and asks it for the voltage
// that it puts out (plant/driver/simulated_device.h).
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "process/child_lines.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class CheckedDevice {
 public:
  // Starts driver.simulated_device in the configuration's folder and waits for its line "ready". Throws
  // InputError when there is no such program, or when it does not become ready.
  explicit CheckedDevice(const settings::StackConfig& config);
  // Kills the device and every process that it has started.
  ~CheckedDevice();
  CheckedDevice(const CheckedDevice&) = delete;
  CheckedDevice& operator=(const CheckedDevice&) = delete;

  // Orders a trouble: "silent", "nan", "lies", "slow" or "none". Returns whether the device can do that.
  bool Order(const std::string& trouble);
  // The voltage of eq. (1) at the machine. Throws std::runtime_error when the device has ended or does not
  // answer.
  double Output();

 private:
  // The device's next line; empty when none has come in time. Throws std::runtime_error for a line without an
  // end.
  std::string Answer();
  void Say(const std::string& line) const;
  void End();

  std::string name_;
  pid_t pid_ = -1;
  int in_ = -1, out_ = -1;  // our ends of its standard input and output
  std::optional<process::ChildLines> lines_;
};

}  // namespace hydro::plant
