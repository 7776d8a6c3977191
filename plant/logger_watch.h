// Is somebody recording? Control does not need a logger, so that it is gone is a warning only.
#pragma once

#include <hydro/log_progress_t.hpp>
#include <hydro/process_status_t.hpp>
#include <map>
#include <optional>
#include <string>

#include "process/participant.h"

namespace hydro::plant {

// For a run in real time: in lockstep the plant waits for its logger.
class LoggerWatch {
 public:
  // A logger counts as gone when it has been silent for longer than `limit`, or has said that it leaves.
  LoggerWatch(process::Participant& participant, bus::Clock::Duration limit);

  // To be called often while the run goes on: raises logger_gone when a logger that was there is gone, and
  // ends it when one is heard that was not there. Time in which it was not called does not count as silence.
  void Poll();

 private:
  void OnStatus(const process_status_t& status);
  void Heard(int64_t session);
  void Gone(int64_t session, const std::string& text, double silence);

  process::Participant& participant_;
  const bus::Clock::Duration limit_;
  std::map<int64_t, bus::Clock::TimePoint> heard_;  // the loggers that are there, by session
  std::optional<bus::Clock::TimePoint> polled_;
};

}  // namespace hydro::plant
