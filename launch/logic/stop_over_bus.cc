#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <hydro/loop_statistics_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/stop_t.hpp>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "bus/channels.h"
#include "bus/session.h"
#include "launch/logic/operator_request.h"
#include "process/participant.h"
#include "process/status.h"

namespace hydro::launch {
namespace {

using namespace std::chrono_literals;

constexpr size_t kMostProcesses = 256;  // a stack has five; more would come from a flood of made-up ones
constexpr size_t kMostPartsOfAJoint = 8;
constexpr auto kStopRepeat = 50ms;  // UDP may lose a message
constexpr auto kUnheard = 500ms;    // stops are sent for this long even if no process has been heard
// For processes of this machine to end because of the stop on the bus.
constexpr auto kLocalPatience = 1500ms;

// The processes that are heard, until they announce their end.
class Presence {
 public:
  Presence(bus::Bus& bus, const bus::Clock& clock, const std::vector<bus::Channels>& stacks,
           const LocalProcesses& local)
      : clock_(clock),
        local_(local),
        host_(bus::IdentityOn(bus, clock).host),
        most_(kMostProcesses + stacks.size() * kMostPartsOfAJoint) {
    for (const bus::Channels& channels : stacks) Listen(bus, channels);
  }

  bool anybody() const { return !processes_.empty(); }
  // The number of processes that were not found on this machine. All joints of a limb's process count as one.
  size_t others() const {
    std::set<std::pair<std::string, int32_t>> known;
    size_t nameless = 0;
    for (const auto& [session, process] : processes_) {
      if (process.local) continue;
      if (process.id) {
        known.insert(*process.id);
      } else {
        ++nameless;
      }
    }
    return known.size() + nameless;
  }
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
    bool local = false;                                 // whether it was found on this machine
    std::optional<std::pair<std::string, int32_t>> id;  // host and process id, if it has announced them
  };

  void Listen(bus::Bus& bus, const bus::Channels& channels) {
    bus.Subscribe<state_t>(channels.Of<state_t>(), [this](const state_t& s) { Heard(s.session, "plant"); });
    bus.Subscribe<loop_statistics_t>(channels.Of<loop_statistics_t>(), [this](const loop_statistics_t& s) {
      Heard(s.session, s.role + " on " + s.host);
    });
    bus.Subscribe<process_status_t>(channels.Of<process_status_t>(), [this](const process_status_t& s) {
      if (s.role == process::kLaunchRole) return;  // it only asks who is present
      Heard(s.session, process::ProcessName(s));
      const auto found = processes_.find(s.session);
      if (found == processes_.end()) return;
      Process& process = found->second;
      process.local = s.host == host_ && local_.Found(s.pid);
      process.left = process::HasLeft(s);
      process.id = {s.host, s.pid};
    });
  }

  void Heard(int64_t session, const std::string& name) {
    if (processes_.size() >= most_ && !processes_.contains(session)) return;
    newest_ = clock_.Now();
    Process& process = processes_[session];
    if (process.name.size() < name.size()) process.name = name;
  }

  const bus::Clock& clock_;
  const LocalProcesses& local_;
  const std::string host_;
  const size_t most_;
  bus::Clock::TimePoint newest_{};
  std::map<int64_t, Process> processes_;
};

}  // namespace

const Asker kHydroLaunch{process::kLaunchRole, "hydro-launch --stop", "hydro-launch --rearm"};
const Asker kScopePage{"scope", "STOP on the page of hydro-scope", "Re-arm on the page of hydro-scope"};

std::string Stopped(size_t count) {
  return fmt::format("stopped: {} process{}", count, count == 1 ? " has ended" : "es have ended");
}

OperatorResult StopOverBus(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                           LocalProcesses& local, const OperatorTiming& timing, const Asker& asker) {
  std::vector<bus::Channels> stacks;
  for (const std::string& suffix : settings::StackSuffixes(config)) stacks.emplace_back(suffix);
  Presence presence(bus, clock, stacks, local);
  stop_t stop;
  stop.tick = -1;
  stop.session = bus::IdentityOn(bus, clock).session;
  stop.addressee = 0;  // every process that hears it: an operator who stops need not name the run
  stop.source = asker.role;
  stop.reason = asker.stop;
  stop.exit_code = 0;
  const auto start = clock.Now();
  auto next_stop = start;
  while (true) {
    const auto now = clock.Now();
    const std::string remaining = presence.Remaining();
    const bool here = !local.Left().empty();
    if (now >= next_stop && (now - start < kUnheard || !remaining.empty())) {
      stop.utime = clock.Utime();
      for (const bus::Channels& channels : stacks) bus.Publish(channels.Of<stop_t>(), stop);
      next_stop = now + kStopRepeat;
    }
    if (!presence.anybody() && local.found() == 0 && now - start > timing.presence) {
      return {1, "no process of a stack is heard on " + config.bus.url};
    }
    const auto newest = std::max(presence.newest(), start);
    if ((presence.anybody() || local.found() > 0) && remaining.empty() && !here &&
        now - newest > timing.quiet) {
      return {0, Stopped(presence.others() + static_cast<size_t>(local.found()))};
    }
    if (here && remaining.empty() && now - newest > kLocalPatience) return {1, ""};
    if (now - start > timing.end) return {1, "has not ended: " + remaining};
    bus.HandleUntil(now + kStopRepeat);
  }
}

}  // namespace hydro::launch
