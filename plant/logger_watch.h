// Watches whether the run is being recorded. Control does not need a logger, so losing one is only a warning.
#pragma once

#include <hydro/log_progress_t.hpp>
#include <hydro/process_status_t.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "process/participant.h"

namespace hydro::plant {

// It serves runs in real time; in lockstep the plant waits for its logger.
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

}  // namespace hydro::plant
