// What a simulated device is made of: this project's model moves behind it in its own time, and
// hydro-driver-check tells it on standard input what goes wrong. A simulated device stands for a real one
// while its driver is written (driver.simulated_device). It is a program of its own, so that it shows what a
// driver that was killed has left.
#pragma once

#include <chrono>
#include <string>

#include "model/actuator.h"

namespace hydro::plant {

// What goes wrong with the device.
enum class DeviceTrouble {
  kNone,
  kSilent,     // it answers no more
  kNoNumbers,  // its readings are NaN, or beyond what its inputs can measure
  kLies,       // it puts out what it is told and reads back something else
  kSlow,       // it answers once in kSlowAnswer only
};
inline constexpr std::chrono::milliseconds kSlowAnswer{20};

class SimulatedDevice {
 public:
  // `model_file`: the machine's parameters, e.g. config/models/table1.toml. Throws InputError.
  explicit SimulatedDevice(const std::string& model_file);

  // Says "ready" on standard output, for which the driver and hydro-driver-check wait.
  static void SayReady();

  // Waits until there is something to read from `file` (-1: nothing to wait for), for as long as `patience`
  // at most, and does what is asked on standard input meanwhile, a word a line: "none", "silent", "nan",
  // "lies" and "slow" are answered with "ok", "output" with the voltage at the machine, "output 1.5". Returns
  // whether there is something to read.
  bool Wait(int file, std::chrono::milliseconds patience);
  DeviceTrouble trouble() const { return trouble_; }

  // Lets the machine move until now, since the last call under the voltage of that one, and from now on under
  // `voltage` (V of eq. (1)). Returns what its sensors measure. Throws model::ModelError, e.g. when the arm
  // leaves its cylinder.
  model::Measurement Move(double voltage);

 private:
  void Obey(const std::string& line);

  model::Actuator actuator_;
  std::chrono::steady_clock::time_point start_;
  double voltage_ = 0;
  DeviceTrouble trouble_ = DeviceTrouble::kNone;
  bool orders_ = true;  // standard input is open
  std::string line_;    // of it, as far as it has come
};

}  // namespace hydro::plant
