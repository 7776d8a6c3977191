#include "plant/run_start.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>

#include "process/status.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

// A stack has five processes; more would come from a flood of made-up ones.
constexpr size_t kMostPresent = 256;
// The time a participant may take to report its configuration; a program of the user's own never reports it.
constexpr auto kConfigurationTime = 300ms;
constexpr auto kNoticePeriod = 2s;       // of the line that names who is missing
constexpr auto kDescriptionPeriod = 1s;  // often enough for logs and plots that start late

}  // namespace

void RollCall::Observe(const process_status_t& status) {
  const std::pair key(status.role, status.session);  // on a simulated clock every session is 0
  const bool matters = status.role == "logger" ||
                       std::find(expected_.begin(), expected_.end(), status.role) != expected_.end();
  if (!matters) return;
  if (process::IsThere(status)) {
    if (present_.size() < kMostPresent || present_.contains(key)) present_[key] = status;
    return;
  }
  const auto found = present_.find(key);
  if (found == present_.end()) return;  // it took no part in this run
  present_.erase(found);
  if (left_.empty()) {
    left_ = process::ProcessName(status);
    if (!status.text.empty()) left_ += ": " + status.text;
  }
}

std::vector<std::string> RollCall::Missing() const {
  std::vector<std::string> missing;
  for (const std::string& role : expected_) {
    const bool present = std::any_of(present_.begin(), present_.end(),
                                     [&](const auto& entry) { return entry.second.role == role; });
    if (!present) missing.push_back(role);
  }
  return missing;
}

std::vector<int64_t> RollCall::Participants() const {
  std::vector<int64_t> sessions = Loggers();
  for (const auto& [key, status] : present_) {
    if (std::find(expected_.begin(), expected_.end(), status.role) != expected_.end()) {
      sessions.push_back(status.session);
    }
  }
  return sessions;
}

std::vector<int64_t> RollCall::Loggers() const {
  std::vector<int64_t> sessions;
  for (const auto& [key, status] : present_) {
    if (status.role == "logger") sessions.push_back(status.session);
  }
  return sessions;
}

run_description_t DescriptionOf(const settings::StackConfig& config, const std::string& program) {
  run_description_t description{};
  description.config_file = config.file;
  description.config_text = config.text;
  description.program = program;
  description.version = HYDRO_VERSION;
  description.rate_hz = config.plant.rate_hz;
  description.seed = config.seed;
  return description;
}

RunStart::RunStart(process::Participant& participant, const SiblingFaults& siblings, Options options)
    : participant_(participant),
      siblings_(siblings),
      joints_(std::move(options.joints)),
      timeout_s_(options.timeout_s),
      roll_call_(std::move(options.roles)),
      loggers_(participant.bus(), options.loggers),
      description_(std::move(options.description)) {
  description_.session = participant.session();
  description_.host = participant.host();
  bus::Bus& bus = participant.bus();
  const std::string own = participant.channels().Of<process_status_t>();
  bus.Subscribe<process_status_t>(own, [this](const process_status_t& each) { roll_call_.Observe(each); });
  for (const bus::Channels& channels : options.loggers) {
    const std::string other = channels.Of<process_status_t>();
    if (other == own) continue;
    bus.Subscribe<process_status_t>(other, [this](const process_status_t& status) {
      if (status.role == "logger") roll_call_.Observe(status);
    });
  }
}

std::string RunStart::Missing() const {
  std::vector<std::string> missing = roll_call_.Missing();
  for (const std::string& joint : siblings_.Missing(joints_)) missing.push_back(joint);
  return fmt::format("{}", fmt::join(missing, ", "));
}

bool RunStart::AllHaveSaidTheirConfiguration() const {
  const std::vector<int64_t> sessions = roll_call_.Participants();
  return std::all_of(sessions.begin(), sessions.end(),
                     [&](int64_t session) { return participant_.HasSaidItsConfiguration(session); });
}

bool RunStart::Await(const std::function<bool()>& ended,
                     const std::function<void(bus::Clock::TimePoint now)>& meanwhile) {
  const bus::Clock& clock = participant_.clock();
  const auto start = clock.Now();
  const auto deadline = start + bus::FromSeconds(timeout_s_);
  auto next_notice = start + kNoticePeriod;
  std::optional<bus::Clock::TimePoint> complete;
  while (!ended()) {
    const std::string missing = Missing();
    const auto now = clock.Now();
    auto until = now + 5ms;
    if (missing.empty()) {
      if (!complete) complete = now;
      if (AllHaveSaidTheirConfiguration() || now - *complete > kConfigurationTime) return true;
    } else {
      if (now >= deadline) {
        participant_.RequestStop(
            fmt::format("not ready after {} s (time.start_timeout_s): {}", timeout_s_, missing), 1);
        return false;
      }
      if (now >= next_notice) {
        spdlog::info("waiting for {}", missing);
        next_notice = now + kNoticePeriod;
      }
      until = std::min(now + 50ms, deadline);
    }
    participant_.bus().HandleUntil(until);
    meanwhile(clock.Now());
  }
  return false;
}

void RunStart::Begin() {
  participant_.Announce(process_status_t::RUNNING);
  Describe();
  took_part_ = roll_call_.Participants();
  loggers_.Await(roll_call_.Loggers());
}

void RunStart::Describe() {
  next_description_ = participant_.clock().Now() + kDescriptionPeriod;
  description_.utime = participant_.clock().Utime();
  participant_.bus().Publish(participant_.channels().Of<run_description_t>(), description_);
}

bool RunStart::BeganWith(int64_t session) const {
  return std::find(took_part_.begin(), took_part_.end(), session) != took_part_.end();
}

std::string RunStart::Departure(int64_t tick) const {
  return roll_call_.left().empty()
             ? ""
             : fmt::format("{} has left the lockstep run at tick {}", roll_call_.left(), tick);
}

}  // namespace hydro::plant
