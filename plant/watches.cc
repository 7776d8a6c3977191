#include "plant/watches.h"

#include <spdlog/fmt/fmt.h>

#include <cmath>

#include "process/status.h"

namespace hydro::plant {
namespace {

constexpr char kLoggerGone[] = "logger_gone";
constexpr size_t kMostLoggers = 64;  // entries; more would only come from a flood of made-up loggers
constexpr auto kHeartbeatCheck = std::chrono::milliseconds(10);

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
  if (!logger.again && participant_.any_fault()) participant_.Clear(kLoggerGone);
  logger = {.heard = now, .again = true};
}

void LoggerWatch::Gone(int64_t session, const std::string& text, double silence) {
  loggers_.erase(session);
  // The end of a run is announced before its logger leaves, so its leaving is no fault then.
  if (participant_.stop()) return;
  participant_.Raise(kLoggerGone, fmt::format("{} no longer records: {}", participant_.NameOf(session), text),
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

LoggerWindow::LoggerWindow(bus::Bus& bus, const std::vector<bus::Channels>& channels) {
  for (const bus::Channels& each : channels) {
    bus.Subscribe<log_progress_t>(each.Of<log_progress_t>(), [this](const log_progress_t& progress) {
      const auto known = progress_.find(progress.session);
      if (known != progress_.end()) known->second = progress.tick;
    });
  }
}

void LauncherWatch::CheckDue(int64_t tick, bus::Clock::TimePoint now) {
  next_check_ = now + kHeartbeatCheck;
  if (heartbeat_()) newest_ = now;
  const double silence = newest_ ? bus::ToSeconds(now - *newest_) : 0;
  safety_.Set(VoltageGuard::Cause::kSupervisorGone, silence > allowed_, [&] {
    return OutputSafety::Finding{fmt::format("tick {}: hydro-launch, which started this process, has not "
                                             "been heard for {:.2f} s, allowed are {} s "
                                             "(limits.stale_supervisor_s); is it stopped (Ctrl-Z)?",
                                             tick, silence, allowed_),
                                 silence, allowed_};
  });
}

}  // namespace hydro::plant
