// A driver under test on a network of its own, with the two loops that it obeys, and the messages that it
// sends.
#pragma once

#include <sys/types.h>

#include <functional>
#include <hydro/fault_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/output_left_t.hpp>
#include <hydro/state_t.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/udpm/udpm_bus.h"
#include "process/participant.h"
#include "process/process_end.h"
#include "settings/stack_config.h"

namespace hydro::plant {

class CheckedStack {
 public:
  // Starts the configuration's driver, which has the bus of `config` to itself. `overrides` are those with
  // which `config` was loaded. With `verbose` the driver's output is shown.
  CheckedStack(const settings::StackConfig& config, const std::vector<std::string>& overrides, bool verbose);
  ~CheckedStack();
  CheckedStack(const CheckedStack&) = delete;
  CheckedStack& operator=(const CheckedStack&) = delete;

  // From now on the loops take part and command a voltage that alternates its sign, so that the machine stays
  // where it is.
  void StartLoops();
  void set_silent(bool silent) { silent_ = silent; }
  // Sets the voltage that is commanded instead of the alternating one.
  void set_voltage(std::optional<double> voltage) { voltage_ = voltage; }
  double amplitude() const { return amplitude_; }  // V

  // Handles messages until `done` returns true, for `limit_s` at most. Returns whether `done` came true.
  bool Await(const std::function<bool()>& done, double limit_s);
  double Now() const;  // s

  bool ready() const { return driver_pid_ > 0; }
  pid_t driver() const { return driver_pid_; }  // from its announcement: `command` may be a script
  pid_t guardian() const;                       // the driver's child hydro-zero; 0: none
  bool Ended();
  const process::ProcessEnd& end() const { return *end_; }
  std::string LastLine() const;  // that it has printed; empty where it is shown

  int64_t states() const { return states_; }
  const state_t& state() const { return state_; }
  const std::optional<output_left_t>& left() const { return left_; }
  // Whether a fault with this code was heard since Forget().
  bool Heard(const std::string& code) const;
  // The first fault that zeroes the voltage and does not come from the loops; empty: none.
  std::string HeardFault() const;
  void Forget() { faults_.clear(); }
  void SendStop();

 private:
  void Start(const std::vector<std::string>& overrides, bool verbose);
  void OnState(const state_t& state);

  settings::StackConfig config_;
  std::unique_ptr<bus::UdpmBus> bus_;
  bus::WallClock clock_;
  std::unique_ptr<process::Participant> pressure_, position_;
  double amplitude_;
  bool silent_ = false;
  std::optional<double> voltage_;
  int64_t sequence_ = 0;
  pid_t started_ = -1, driver_pid_ = -1;
  int said_ = -1;  // a file in memory: what it prints where that is not shown
  std::optional<process::ProcessEnd> end_;
  int64_t states_ = 0;
  state_t state_{};
  std::vector<std::string> faults_;
  std::optional<output_left_t> left_;
};

}  // namespace hydro::plant
