// Messages in the World that are forged or that an operator sends, and what a replay reports of all messages.
#include <fmt/format.h>

#include <algorithm>

#include "sim/torture/active_fault.h"
#include "sim/torture/programs.h"
#include "sim/torture/world.h"

namespace hydro::torture {

// Only replays with a tail pay for this.
void World::Tell(const Packet& packet, int process, const char* what) {
  if (tail_ == nullptr) return;
  tail_->AddMessage(now_, NameOf(process), what, network_.ChannelName(packet.channel), packet);
}

void World::TellInjection(int number, const char* what) {
  if (tail_ == nullptr) return;
  const Injection& injection = schedule_.injections[static_cast<size_t>(number)];
  tail_->Add(now_, fmt::format("{} of {}", InfoOf(injection.kind).name, TargetName(injection.target)), what);
}

std::string World::NameOf(int process) const {
  if (process < 0) return "nobody";
  const SimulatedProcess& sender = *by_number_[static_cast<size_t>(process)];
  return fmt::format("{} {}", TargetName(static_cast<int>(sender.role())), process);
}

void World::Say(int process, const std::string& text) {
  if (tail_ != nullptr) tail_->Add(now_, NameOf(process), text);
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

void World::SendRearm() { Begin(Role::kOperator, RearmProgram(stacks_.whole), false); }

void World::SendInsider(double voltage, double seconds, int64_t first_sequence) {
  Begin(Role::kOperator, InsiderProgram(config_, voltage, seconds, first_sequence), false);
}

void World::SendSet(int which) { Begin(Role::kOperator, SetProgram(config_, which), false); }

void World::SendStop() {
  const bool watched = !schedule_.launcher && !ending_;
  SimulatedProcess& stop = Begin(Role::kOperator, StopProgram(stacks_.whole, watched), false);
  stops_.insert(&stop);
  last_stop_ = &stop;
}

}  // namespace hydro::torture
