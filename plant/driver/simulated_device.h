// The parts of a simulated device: this project's model moves behind it in its own time, and
// hydro-driver-check tells it on standard input what goes wrong. A simulated device stands for a real one
// while its driver is written (driver.simulated_device). It is a program of its own, so that it shows the
// output that a killed driver has left.
#pragma once

#include <chrono>
#include <string>

#include "model/actuator.h"

namespace hydro::plant {

// The ways in which the device can go wrong.
enum class DeviceTrouble {
  kNone,
  kSilent,     // it no longer answers
  kNoNumbers,  // its readings are NaN, or beyond what its inputs can measure
  kLies,       // puts out what it is told and reads back something else
  kSlow,       // answers only once in kSlowAnswer
};
inline constexpr std::chrono::milliseconds kSlowAnswer{20};

class SimulatedDevice {
 public:
  // `model_file` holds the machine's parameters, e.g. config/models/table1.toml. Throws InputError.
  explicit SimulatedDevice(const std::string& model_file);

  // Says "ready" on standard output; the driver and hydro-driver-check wait for that line.
  static void SayReady();

  // Waits until there is something to read from `file` (-1: nothing to wait for), for at most `patience`.
  // Meanwhile it does what standard input asks for, a word a line: it answers "none", "silent", "nan", "lies"
  // and "slow" with "ok", and "output" with the voltage at the machine, "output 1.5". Returns whether there
  // is something to read.
  bool Wait(int file, std::chrono::milliseconds patience);
  DeviceTrouble trouble() const { return trouble_; }

  // Lets the machine move until now under the voltage of the last call, and holds `voltage` (V of eq. (1))
  // from now on. Returns what its sensors measure. Throws model::ModelError, e.g. when the arm leaves its
  // cylinder.
  model::Measurement Move(double voltage);

 private:
  void Obey(const std::string& line);

  model::Actuator actuator_;
  std::chrono::steady_clock::time_point start_;
  double voltage_ = 0;
  DeviceTrouble trouble_ = DeviceTrouble::kNone;
  bool orders_ = true;  // standard input is open
  std::string line_;    // of standard input, as far as it has come
};

}  // namespace hydro::plant
