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
#include "bus/udpm/reserved_port.h"
#include "process/process_end.h"
#include "settings/stack_config.h"

namespace hydro::hydro_log {

// The words of a command line, as a shell cuts them: quotes, ~ and $NAME. Throws InputError for what is no command.
std::vector<std::string> CommandWords(const std::string& text);

class OwnController {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // Starts `command` (a path in it counts from here) in the place of `role`. It is told of a free port on this machine and of
  // the recorded configuration in files (process/own_program.h); there it is in real time, as it is fed what was heard then, and has no key and no suffix of
  // channels. What it prints goes to stderr. Throws InputError, process::StartError, bus::BusError.
  OwnController(const settings::StackConfig& recorded, const run_description_t& description,
                const std::vector<std::string>& command, const std::string& role);
  // Ends it, whatever its state.
  ~OwnController();
  OwnController(const OwnController&) = delete;
  OwnController& operator=(const OwnController&) = delete;

  bus::Bus& bus() { return *bus_; }
  const std::string& name() const { return name_; }

  // Handles messages until `done`, and calls `again` whenever that takes long, since a message may be lost. Nothing when it came to
  // that, else why not: it ended, this program shall end, or `limit` has passed, then "did not <what> within 5 s".
  std::optional<std::string> Await(const std::function<bool()>& done, const std::function<void()>& again,
                                   Duration limit, const std::string& what);

  // Waits until it is ready; why not otherwise.
  std::optional<std::string> AwaitReady(Duration limit);

  // Tells it that the run is over and waits for its end; what is wrong with that, if anything.
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
  std::optional<process_status_t> status_;  // what it said last
  std::string other_role_;                  // that it has announced itself under
};

}  // namespace hydro::hydro_log
