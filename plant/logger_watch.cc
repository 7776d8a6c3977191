#include "plant/logger_watch.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "process/status.h"

namespace hydro::plant {
namespace {

constexpr char kCode[] = "logger_gone";
constexpr size_t kMostLoggers = 64;  // entries; more would only come from a flood of made-up loggers

}  // namespace

LoggerWatch::LoggerWatch(process::Participant& participant, const std::vector<bus::Channels>& channels,
                         bus::Clock::Duration limit)
    : participant_(participant), limit_(limit) {
  bus::Bus& bus = participant_.bus();
  for (const bus::Channels& each : channels) {
    bus.Subscribe<log_progress_t>(each.Of<log_progress_t>(),
                                  [this](const log_progress_t& progress) { Heard(progress.session); });
    bus.Subscribe<process_status_t>(each.Of<process_status_t>(), [this](const process_status_t& status) {
      if (status.role == "logger") OnStatus(status);
    });
  }
}

void LoggerWatch::OnStatus(const process_status_t& status) {
  if (!process::HasLeft(status)) {
    Heard(status.session);
  } else if (loggers_.contains(status.session)) {
    Gone(status.session, status.text.empty() ? "it has left" : status.text, NAN);
  }
}

void LoggerWatch::Heard(int64_t session) {
  const auto now = participant_.clock().Now();
  const auto known = loggers_.find(session);
  if (known == loggers_.end()) {
    if (loggers_.size() < kMostLoggers) loggers_[session] = {.heard = now};
    return;
  }
  Logger& logger = known->second;
  if (!logger.again && participant_.any_fault()) participant_.Clear(kCode);
  logger = {.heard = now, .again = true};
}

void LoggerWatch::Gone(int64_t session, const std::string& text, double silence) {
  loggers_.erase(session);
  // The end of a run is announced before its logger leaves, so its leaving is no fault then.
  if (participant_.stop()) return;
  participant_.Raise(kCode, fmt::format("{} no longer records: {}", participant_.NameOf(session), text),
                     silence, bus::ToSeconds(limit_), false);
}

void LoggerWatch::Poll(bus::Clock::TimePoint now) {
  const auto away = now - polled_.value_or(now);
  polled_ = now;
  if (away > limit_ / 4) {  // no state was sent, so loggers had nothing to report
    for (auto& [session, logger] : loggers_) logger.heard += away;
  }
  // A logger that was heard only once, for example one of a flood of made-up ones, has recorded nothing.
  std::erase_if(loggers_,
                [&](const auto& entry) { return !entry.second.again && now - entry.second.heard > limit_; });
  for (const auto& [session, logger] : loggers_) {
    if (now - logger.heard <= limit_) continue;
    const double silence = bus::ToSeconds(now - logger.heard);
    Gone(session,
         fmt::format("silent for {:.3g} s, allowed are {} s (limits.stale_logger_s)", silence,
                     bus::ToSeconds(limit_)),
         silence);
    return;  // the map has changed; the next call sees the rest
  }
}

}  // namespace hydro::plant
