// The World's processes: their start, their death, the sleep of their machines.
#include <fmt/format.h>

#include <algorithm>

#include "bus/seal/authenticator.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/programs.h"
#include "sim/torture/world.h"

namespace hydro::torture {
namespace {

constexpr TrueTime kRestart = 300'000'000;  // ns after which a watched process is started again

// The channels of process::OpenStackBus(): all processes of a limb introduce themselves on the limb's own
// channels.
std::vector<std::string> SealedChannels(const settings::StackConfig& whole) {
  std::vector<std::string> sealed;
  for (const std::string& suffix : settings::StackSuffixes(whole)) {
    const std::vector<std::string> names = bus::AuthenticatedChannels(bus::Channels(suffix));
    sealed.insert(sealed.end(), names.begin(), names.end());
  }
  return sealed;
}

}  // namespace

SimulatedProcess* World::Find(Role role) {
  const auto found = std::find_if(alive_.begin(), alive_.end(), [&](const SimulatedProcess* process) {
    return process->role() == role && !process->ended() && !process->killed();
  });
  return found == alive_.end() ? nullptr : *found;
}

void World::Start(Role role) {
  const auto index = static_cast<size_t>(role);
  if (ending_ || Find(role) != nullptr || start_at_[index] > now_) return;
  if (awake_at_[index] > now_) {
    StartAt(role, awake_at_[index]);
    return;
  }
  // An operator does not start a stack while a stop is under way.
  if (role == Role::kLauncher && !stops_.empty()) {
    StartAt(role, now_ + kRestart);
    return;
  }
  const SimulatedProcess& process = BeginRole(role);
  if (role == Role::kLauncher) launches_.OnBegin(process);
}

SimulatedProcess& World::BeginRole(Role role) {
  const settings::StackConfig* const other = starts_with_[static_cast<size_t>(role)];
  const settings::StackConfig& right = IsOfKnee(role) ? stacks_.knee : config_;
  return Begin(role,
               ProgramOf(role, other != nullptr ? *other : right, *this, static_cast<int>(by_number_.size())),
               other != nullptr);
}

SimulatedProcess& World::Begin(Role role, SimulatedProcess::Body body, bool misconfigured) {
  const int number = static_cast<int>(by_number_.size());
  Random draw(schedule_.seed, 1000 + static_cast<uint64_t>(number));
  bus::HostedProcess identity;
  identity.host = MachineOf(role).name();
  identity.id = 1000 + number;
  identity.session = static_cast<int64_t>(draw.Next() | 1);
  by_number_.push_back(nullptr);
  processes_.push_back(std::make_unique<SimulatedProcess>(number, role, MachineOf(role), &now_, identity,
                                                          *this, std::move(body)));
  SimulatedProcess* const process = processes_.back().get();
  if (schedule_.key) {
    static const bus::BusKey kKey({1, 2, 3, 4, 5, 6, 7, 8});
    process->bus().UseKey(std::make_unique<bus::Authenticator>(kKey, SealedChannels(stacks_.whole),
                                                               static_cast<int64_t>(draw.Next() | 1)));
  }
  process->set_misconfigured(misconfigured);
  if (misconfigured) observer_.AddMisconfigured(identity.session);
  by_number_.back() = process;
  if (tail_ != nullptr)
    tail_->Add(now_, NameOf(number), misconfigured ? "starts with the other configuration" : "starts");
  alive_.push_back(process);
  receivers_.push_back({number, static_cast<int>(role)});
  NoteConfigurations();
  return *process;
}

void World::StartAt(Role role, TrueTime time) {
  start_at_[static_cast<size_t>(role)] = time;
  Push(time, Happening::kStart, static_cast<int>(role));
}

void World::NoteConfigurations() {
  const bool other = std::any_of(alive_.begin(), alive_.end(),
                                 [](const SimulatedProcess* process) { return process->misconfigured(); });
  observer_.SetOtherConfiguration(other);
}

void World::Reap(SimulatedProcess& process) {
  trace_.Add(static_cast<uint64_t>(process.exit_code()) << 32 | static_cast<uint64_t>(process.number()));
  std::erase(alive_, &process);
  if (tail_ != nullptr) {
    tail_->Add(
        now_, NameOf(process.number()),
        fmt::format("ends with exit code {}{}", process.exit_code(), process.killed() ? ", killed" : ""));
  }
  std::erase_if(receivers_, [&](const Network::Receiver& r) { return r.number == process.number(); });
  NoteConfigurations();
  if (schedule_.launcher) {
    launches_.OnEnd(process);
    // The launcher gets SIGCHLD.
    if (SimulatedProcess* const launcher = Find(Role::kLauncher)) {
      launcher->Interrupt();
      NoteDue();
    }
  }
  if (process.role() == Role::kLogger) {
    CheckLog(process);
  } else {
    observer_.OnEnd(process);
  }
  if (stops_.erase(&process) > 0) stopped_at_ = now_;
  if (ending_ || process.role() == Role::kOperator) return;
  // A launcher handles its own children. The launcher itself is started again, however it ended.
  const bool restarts = schedule_.launcher ? process.role() == Role::kLauncher : !process.killed();
  if (restarts) StartAt(process.role(), now_ + kRestart);
}

std::string World::NewLog(int number) {
  LogRecord& record = logs_[number];
  record.file = disk_.NewLog();
  record.was_full = disk_.full();
  return record.file;
}

void World::NoteLogFault(bool LogRecord::*what) {
  const SimulatedProcess* const logger = Find(Role::kLogger);
  const auto log = logger == nullptr ? logs_.end() : logs_.find(logger->number());
  if (log != logs_.end()) log->second.*what = true;
}

// Two loggers may be alive at once: one that hangs, and the one of the next launch.
void World::NoteLie() {
  for (auto& [number, log] : logs_) {
    if (log.file == disk_.newest()) log.lied = true;
  }
}

void World::DeleteLog() {
  const std::string before = disk_.newest();
  if (!disk_.Delete()) return;
  for (auto& [number, log] : logs_) {
    if (log.file != before) continue;
    log.file = disk_.newest();
    log.deleted = true;
  }
}

void World::CheckLog(const SimulatedProcess& logger) {
  const auto log = logs_.find(logger.number());
  if (log == logs_.end()) return;  // it was killed before it had a log
  disk_.CheckRoom();
  // A full disk ends the logger with an error that its main prints. On a disk that lies, the logger finds
  // another file there, or none.
  const bool sees_another =
      (log->second.lied || log->second.deleted) && logger.exit_code() == 1 && logger.failure().empty();
  if (!log->second.was_full && !sees_another) observer_.OnEnd(logger);
  const std::string wrong = WrongWith(log->second);
  if (!wrong.empty())
    observer_.Report("a log is what has happened, or says that it is not", log->second.file + ": " + wrong);
  logs_.erase(log);
}

void World::Kill(Role role, TrueTime restart_at) {
  if (SimulatedProcess* const process = Find(role)) Destroy(*process, SIGKILL);
  if (!schedule_.launcher) StartAt(role, restart_at);
}

void World::Destroy(SimulatedProcess& process, int signal) {
  const bool logs = process.role() == Role::kLogger;
  if (const auto log = logs_.find(process.number()); log != logs_.end()) log->second.killed = true;
  const int64_t written = disk_.size();
  process.Kill(signal);
  process.Resume();
  if (logs) disk_.Tear(written, disk_.size(), disk_random_);
  Reap(process);
}

void World::StartPlanner() {
  if (ending_ || (planner_ != nullptr && !planner_->ended())) return;
  planner_ = &Begin(Role::kOperator, PlannerProgram(config_), false);
}

void World::SilencePlanner(TrueTime until) {
  if (!schedule_.planner) return;
  if (planner_ != nullptr && !planner_->ended()) Destroy(*planner_, SIGKILL);
  Push(until, Happening::kPlanner, 0);
}

void World::Suspend(Role role, TrueTime until) {
  TrueTime& awake_at = awake_at_[static_cast<size_t>(role)];
  if (awake_at > now_) return;  // it is already asleep
  awake_at = until;
  asleep_since_[static_cast<size_t>(role)] = now_;
  for (SimulatedProcess* process : alive_) {
    if (HomeOf(process->role()) == role) process->FreezeUntil(until);
  }
  if (role == Role::kPlant) launches_.OnFrozen(until);
  Push(until, Happening::kAwake, static_cast<int>(role));
}

void World::Awake(Role role) {
  MachineOf(role).Slept(now_ - asleep_since_[static_cast<size_t>(role)]);
  ClockChanged(role);
}

void World::ClockChanged(Role role) {
  for (SimulatedProcess* process : alive_) {
    if (HomeOf(process->role()) == role) process->ClockChanged();
  }
}

}  // namespace hydro::torture
