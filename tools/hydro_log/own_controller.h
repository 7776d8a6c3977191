// A controller of the user's own, started for a replay on a network of its own.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <functional>
#include <hydro/process_status_t.hpp>
#include <hydro/run_description_t.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
#include "bus/udpm/udpm_url.h"
#include "process/process_end.h"
#include "settings/stack_config.h"

namespace hydro::hydro_log {

// Splits a command line into words as a shell does: quotes, ~ and $NAME. Throws InputError for a text that is
// not a command.
std::vector<std::string> CommandWords(const std::string& text);

class OwnController {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // Starts `command` (a path in it is relative to this program's working folder) in the role `role`. The
  // controller learns of a free port on this machine and of the recorded configuration through files
  // (process/own_program.h). In these, the stack is in real time, because the controller is fed what was
  // heard then, and has no key and no channel suffix. The controller's output goes to stderr. Throws
  // InputError, process::StartError, bus::BusError.
  OwnController(const settings::StackConfig& recorded, const run_description_t& description,
                const std::vector<std::string>& command, const std::string& role);
  // Ends the controller, whatever its state.
  ~OwnController();
  OwnController(const OwnController&) = delete;
  OwnController& operator=(const OwnController&) = delete;

  bus::Bus& bus() { return *bus_; }
  const std::string& name() const { return name_; }

  // Handles messages until `done` returns true. Whenever that takes long, calls `again`, because a message
  // may be lost. Returns nothing on success. Otherwise returns the reason: the controller ended, this program
  // must end, or `limit` has passed, which gives "did not <what> within 5 s".
  std::optional<std::string> Await(const std::function<bool()>& done, const std::function<void()>& again,
                                   Duration limit, const std::string& what);

  // Waits until the controller is ready; returns the reason if it is not.
  std::optional<std::string> AwaitReady(Duration limit);

  // Tells the controller that the run is over and waits for its end; returns what went wrong, if anything.
  std::optional<std::string> End(int64_t plant_session, Duration limit);

 private:
  class Folder;
  bool Ended();
  void WriteConfiguration(const settings::StackConfig& recorded, const run_description_t& description);

  std::string name_, role_;
  std::unique_ptr<Folder> folder_;
  std::unique_ptr<bus::ReservedPort> port_;
  settings::StackConfig config_;
  std::unique_ptr<bus::Bus> bus_;
  bus::WallClock clock_;
  pid_t pid_ = -1;
  std::optional<process::ProcessEnd> end_;
  std::optional<process_status_t> status_;  // its last message
  std::string other_role_;                  // the role under which it announced itself, if that differs
};

}  // namespace hydro::hydro_log
