#include "sim/torture/message_tail.h"

#include <fmt/format.h>

#include <array>
#include <concepts>

#include "base/text_file.h"
#include "bus/messages.h"

namespace hydro::torture {
namespace {

constexpr std::array kOrigins{"", ", repeated", ", changed or made up", ", forged", ", of an insider"};

// The most informative fields of a message.
template <class Message>
std::string Told(const Message& m) {
  std::string text;
  if constexpr (requires { m.tick; }) text += fmt::format(" tick {}", m.tick);
  if constexpr (requires { m.sequence; }) text += fmt::format(" sequence {}", m.sequence);
  if constexpr (requires { m.session; }) text += fmt::format(" session {:x}", m.session);
  if constexpr (requires { m.addressee; }) text += fmt::format(" addressee {:x}", m.addressee);
  if constexpr (requires { m.command_tick; }) text += fmt::format(" command_tick {}", m.command_tick);
  if constexpr (requires { m.pressure_command_tick; })
    text += fmt::format(" from {}", m.pressure_command_tick);
  if constexpr (requires { m.status; }) text += fmt::format(" status {}", static_cast<int>(m.status));
  if constexpr (requires { m.voltage; }) text += fmt::format(" {:.17g} V", m.voltage);
  if constexpr (requires { m.role; }) text += " " + m.role;
  if constexpr (requires { m.code; }) text += " " + m.code;
  if constexpr (requires { m.codes; }) text += " " + m.codes;
  if constexpr (requires { m.active; }) text += m.active ? " begins" : " ends";
  if constexpr (requires { m.latched; }) text += m.latched ? " latched" : "";
  if constexpr (requires {
                  { m.state } -> std::convertible_to<int>;
                })
    text += fmt::format(" state {}", static_cast<int>(m.state));
  if constexpr (requires { m.text; }) text += ": " + m.text;
  if constexpr (requires { m.reason; }) text += ": " + m.reason;
  return text;
}

std::string Decoded(const std::string& channel, const Packet& packet) {
  std::string text = " (cannot be decoded)";
  bus::AnyMessage([&](const auto& row) {
    using Message = typename std::decay_t<decltype(row)>::Type;
    if (!channel.starts_with(row.channel)) return false;
    Message message;
    if (Decode(packet, &message)) text = Told(message);
    return true;
  });
  return text;
}

// "stale_state begins"; empty: the message is not a fault, or no process sent it.
std::string FaultOf(const std::string& channel, const Packet& packet) {
  fault_t fault;
  if (packet.origin != Origin::kProcess || !channel.starts_with("HYDRO_FAULT") || !Decode(packet, &fault))
    return "";
  return fmt::format("{} {}{}", fault.code, fault.active ? "begins" : "ends",
                     fault.latched ? " latched" : "");
}

}  // namespace

void MessageTail::AddMessage(TrueTime at, const std::string& who, const std::string& what,
                             const std::string& channel, const Packet& packet) {
  if (faults_only_) {
    const std::string fault = what == "sends" ? FaultOf(channel, packet) : "";
    if (!fault.empty()) Keep(at, who, fault);
    return;
  }
  Keep(at, who,
       fmt::format("{} {}{}{}", what, channel, Decoded(channel, packet),
                   kOrigins[static_cast<size_t>(packet.origin)]));
}

void MessageTail::Add(TrueTime at, const std::string& who, const std::string& text) {
  if (!faults_only_) Keep(at, who, text);
}

void MessageTail::Keep(TrueTime at, const std::string& who, const std::string& text) {
  lines_.push_back(
      {at, fmt::format("{:.6f} {}: {}\n", static_cast<double>(at) * 1e-9, who, Printable(text))});
  while (lines_.front().at < at - kept_) lines_.pop_front();
}

std::string MessageTail::Text() const {
  std::string text;
  for (const Line& line : lines_) text += line.text;
  return text;
}

}  // namespace hydro::torture
