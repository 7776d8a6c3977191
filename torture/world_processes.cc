// The World's processes: their start, their death, the sleep of their machines, and what is sent in nobody's
// name.
#include <fmt/format.h>

#include <algorithm>

#include "bus/seal/authenticated_channels.h"
#include "torture/active_fault.h"
#include "torture/programs.h"
#include "torture/world.h"

namespace hydro::torture {
namespace {

constexpr TrueTime kRestart = 300'000'000;  // ns: how soon whoever watches a process starts it again

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
  const settings::StackConfig* const other = starts_with_[index];
  Begin(role,
        ProgramOf(role, other != nullptr ? *other : config_, *this, static_cast<int>(by_number_.size())),
        other != nullptr);
}

void World::Begin(Role role, SimulatedProcess::Body body, bool misconfigured) {
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
    process->bus().UseKey(std::make_unique<bus::Authenticator>(kKey, bus::AuthenticatedChannels(channels_),
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
  if (process.role() == Role::kLogger) {
    CheckLog(process);
  } else {
    observer_.OnEnd(process);
  }
  if (!ending_ && !process.killed() && process.role() != Role::kOperator)
    StartAt(process.role(), now_ + kRestart);
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

void World::CheckLog(const SimulatedProcess& logger) {
  const auto log = logs_.find(logger.number());
  if (log == logs_.end()) return;  // it was killed before it had one
  disk_.CheckRoom();
  // A full disk ends the logger, with an error that its main prints; one that lies makes it find another file there.
  const bool sees_another = log->second.lied && logger.exit_code() == 1 && logger.failure().empty();
  if (!log->second.was_full && !sees_another) observer_.OnEnd(logger);
  const std::string wrong = WrongWith(log->second);
  if (!wrong.empty())
    observer_.Report("a log is what has happened, or says that it is not", log->second.file + ": " + wrong);
  logs_.erase(log);
}

void World::Kill(Role role, TrueTime restart_at) {
  if (SimulatedProcess* const process = Find(role)) {
    if (role == Role::kLogger) NoteLogFault(&LogRecord::killed);
    const int64_t written = disk_.size();
    process->Kill();
    process->Resume();
    if (role == Role::kLogger) disk_.Tear(written, disk_.size(), disk_random_);
    Reap(*process);
  }
  StartAt(role, restart_at);
}

void World::Suspend(Role role, TrueTime until) {
  TrueTime& awake_at = awake_at_[static_cast<size_t>(role)];
  if (awake_at > now_) return;  // asleep already
  awake_at = until;
  asleep_since_[static_cast<size_t>(role)] = now_;
  if (SimulatedProcess* process = Find(role)) process->FreezeUntil(until);
  Push(until, Happening::kAwake, static_cast<int>(role));
}

void World::Awake(Role role) {
  MachineOf(role).Slept(now_ - asleep_since_[static_cast<size_t>(role)]);
  if (SimulatedProcess* process = Find(role)) process->ClockChanged();
}

void World::ForgeBytes(const std::string& channel, const bus::MessageType& type, const void* message,
                       Origin origin) {
  PacketPtr packet = network_.NewPacket();
  const int size = type.encoded_size(message);
  packet->bytes.resize(static_cast<size_t>(size));
  type.encode(message, packet->bytes.data(), size);
  packet->channel = network_.ChannelNumber(channel);
  packet->sender = -1;
  packet->origin = origin;
  trace_.Add(packet->bytes);
  Tell(*packet, -1, "sends");
  network_.Send(packet, -1, receivers_);
}

void World::ForgeAgain(const Packet& packet) {
  PacketPtr copy = network_.NewPacket();
  copy->bytes = packet.bytes;
  copy->channel = packet.channel;
  copy->sender = -1;
  copy->origin = packet.origin == Origin::kProcess ? Origin::kRepeated : packet.origin;
  Tell(*copy, -1, "sends");
  network_.Send(copy, -1, receivers_);
}

const Packet* World::RecordedCommand(TrueTime before) const {
  const auto found = std::find_if(recorded_.rbegin(), recorded_.rend(),
                                  [&](const PacketPtr& packet) { return packet->sent <= before; });
  return found == recorded_.rend() ? nullptr : found->get();
}

void World::SendRearm() {
  const SimulatedProcess* const plant = Find(Role::kPlant);
  if (plant == nullptr) return;
  Begin(Role::kOperator, RearmProgram(config_, plant->identity().session), false);
}

void World::SendInsider(double voltage, double seconds) {
  Begin(Role::kOperator, InsiderProgram(config_, voltage, seconds), false);
}

void World::SendStop() { Begin(Role::kOperator, StopProgram(config_), false); }

}  // namespace hydro::torture
