// Watch the processes that answer no state, but that a run should not be without: whether its loggers record
// it, and whether its launcher is in charge.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/log_progress_t.hpp>
#include <hydro/process_status_t.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "plant/output_safety.h"
#include "process/participant.h"

namespace hydro::plant {

// Real time: watches whether the run is being recorded. Control does not need a logger, so losing one is only
// a warning.
class LoggerWatch {
 public:
  // A logger counts as gone when it has been silent for longer than `limit` or has announced that it leaves.
  // `channels` are those on which loggers may report.
  LoggerWatch(process::Participant& participant, const std::vector<bus::Channels>& channels,
              bus::Clock::Duration limit);

  // Call it often during the run. It raises logger_gone when a known logger is gone, and clears the fault
  // when another one is heard twice. Time in which it was not called does not count as silence.
  void Poll(bus::Clock::TimePoint now);

 private:
  void OnStatus(const process_status_t& status);
  void Heard(int64_t session);
  void Gone(int64_t session, const std::string& text, double silence);

  process::Participant& participant_;
  const bus::Clock::Duration limit_;
  struct Logger {
    bus::Clock::TimePoint heard;  // when it was last heard
    bool again = false;           // heard more than once
  };
  std::map<int64_t, Logger> loggers_;  // by session
  std::optional<bus::Clock::TimePoint> polled_;
};

// Lockstep: how far the loggers have come, so that none of them falls so far behind that it loses messages.
class LoggerWindow {
 public:
  // The ticks by which one rig may run ahead of a logger: its states and commands fill about half of Linux's
  // default receive buffer (208 KiB). A logger reports four times as often (logger_app.cc).
  static constexpr int64_t kTicks = 64;

  // Subscribes on these channels.
  LoggerWindow(bus::Bus& bus, const std::vector<bus::Channels>& channels);

  // Only loggers that were present when the run began count, so that a flood of made-up ones is not stored.
  void Await(const std::vector<int64_t>& sessions) {
    for (const int64_t session : sessions) progress_.emplace(session, -1);
  }

  // Whether each logger has recorded `tick`.
  bool HasTaken(int64_t tick) const {
    for (const auto& [session, taken] : progress_) {
      if (taken < tick) return false;
    }
    return true;
  }

 private:
  std::map<int64_t, int64_t> progress_;  // tick by session
};

// Watches whether the launcher lives. A person at the terminal believes that the launcher is in charge; while
// the launcher is stopped, it is not.
class LauncherWatch {
 public:
  // `heartbeat` returns whether the launcher has sent a heartbeat since the last call
  // (process/stop_signal.h); once one has come, their absence is a fault. Empty: there is no launcher.
  LauncherWatch(std::function<bool()> heartbeat, double allowed_silence_s, OutputSafety& safety)
      : heartbeat_(std::move(heartbeat)), allowed_(allowed_silence_s), safety_(safety) {}

  void Check(int64_t tick, bus::Clock::TimePoint now) {
    if (heartbeat_ && now >= next_check_) CheckDue(tick, now);
  }

 private:
  void CheckDue(int64_t tick, bus::Clock::TimePoint now);

  const std::function<bool()> heartbeat_;
  const double allowed_;  // s
  OutputSafety& safety_;
  std::optional<bus::Clock::TimePoint> newest_;
  bus::Clock::TimePoint next_check_;
};

}  // namespace hydro::plant
