#include <hydro/loop_statistics_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/stop_t.hpp>
#include <map>

#include "bus/channels.h"
#include "bus/session.h"
#include "launch/operator_request.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr auto kRepeat = 50ms;    // UDP may lose a message
constexpr auto kUnheard = 500ms;  // for this long also when no process has been heard

// The processes that are heard, until they announce their end.
class Presence {
 public:
  Presence(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels) : clock_(clock) {
    bus.Subscribe<state_t>(channels.Of<state_t>(), [this](const state_t& s) { Heard(s.session, "plant"); });
    bus.Subscribe<loop_statistics_t>(channels.Of<loop_statistics_t>(), [this](const loop_statistics_t& s) {
      Heard(s.session, s.role + " on " + s.host);
    });
    bus.Subscribe<process_status_t>(channels.Of<process_status_t>(), [this](const process_status_t& s) {
      Heard(s.session, s.role + " on " + s.host + " (process " + std::to_string(s.pid) + ")");
      if (s.state == process_status_t::DONE || s.state == process_status_t::FAILED) {
        processes_[s.session].left = true;
      }
    });
  }

  bool anybody() const { return !processes_.empty(); }
  size_t count() const { return processes_.size(); }
  bus::Clock::TimePoint newest() const { return newest_; }

  // The processes that have not announced their end.
  std::string Remaining() const {
    std::string names;
    for (const auto& [session, process] : processes_) {
      if (!process.left) names += (names.empty() ? "" : ", ") + process.name;
    }
    return names;
  }

 private:
  struct Process {
    std::string name;
    bool left = false;
  };

  void Heard(int64_t session, const std::string& name) {
    newest_ = clock_.Now();
    Process& process = processes_[session];
    if (process.name.size() < name.size()) process.name = name;
  }

  const bus::Clock& clock_;
  bus::Clock::TimePoint newest_{};
  std::map<int64_t, Process> processes_;
};

}  // namespace

OperatorResult StopStack(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                         const OperatorTiming& timing) {
  const bus::Channels channels(config.bus.channel_suffix);
  Presence presence(bus, clock, channels);
  stop_t stop;
  stop.tick = -1;
  stop.session = bus::SessionOn(clock);
  stop.addressee = 0;  // whoever hears it: an operator who stops is not asked which run
  stop.source = "launch";
  stop.reason = "hydro-launch --stop";
  stop.exit_code = 0;
  const auto start = clock.Now();
  auto next_stop = start;
  while (true) {
    const auto now = clock.Now();
    const std::string remaining = presence.Remaining();
    if (now >= next_stop && (now - start < kUnheard || !remaining.empty())) {
      stop.utime = clock.Utime();
      bus.Publish(channels.Of<stop_t>(), stop);
      next_stop = now + kRepeat;
    }
    if (!presence.anybody() && now - start > timing.presence) {
      return {1, "no process of a stack is heard on " + config.bus.url};
    }
    if (presence.anybody() && remaining.empty() && now - presence.newest() > timing.quiet) {
      return {0, "stopped: " + std::to_string(presence.count()) + " processes have ended"};
    }
    if (now - start > timing.end) return {1, "has not ended: " + remaining};
    bus.HandleUntil(now + kRepeat);
  }
}

}  // namespace hydro::launch
