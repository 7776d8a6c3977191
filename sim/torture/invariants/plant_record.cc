#include "sim/torture/invariants/plant_record.h"

#include <algorithm>
#include <bit>

namespace hydro::torture {
namespace {

constexpr size_t kMostFalse = 256;
constexpr size_t kMostSenders = 64;

bool Same(double a, double b) { return std::bit_cast<uint64_t>(a) == std::bit_cast<uint64_t>(b); }

}  // namespace

void PlantRecord::Receive(const ReceivedCommand& command) {
  if (read_tick < 0 || command.tick < 0) return;  // it does not answer any state
  if (command.tick <= read_tick) Hear(command);   // one for a future tick is another fault
  if (command.origin != Origin::kProcess && command.origin != Origin::kRepeated) {
    false_.push_back(command);
    false_.back().silence = command.handled - genuine;
    if (false_.size() > kMostFalse) false_.pop_front();
    return;
  }
  if (command.tick <= read_tick - kRemembered) return;
  genuine = command.handled;
  // A repetition may arrive before the message that it repeats.
  Tick& entry = At(command.tick);
  ReceivedCommand& first = entry.answers[0];
  (first.tick < 0 || first.session == command.session ? first : entry.answers[1]) = command;
}

void PlantRecord::Hear(const ReceivedCommand& command) {
  const auto last = senders.find(command.session);
  if (last != senders.end()) {
    last->second = command.handled;
  } else if (senders.size() < kMostSenders) {
    senders[command.session] = command.handled;
  }
}

std::optional<ReceivedCommand> PlantRecord::Newest(double wanted, int64_t oldest, int64_t newest) {
  oldest = std::max({oldest, newest - kRemembered + 1, int64_t{0}});
  for (int64_t at = newest; at >= oldest; --at) {
    const Tick& entry = ticks_[static_cast<uint64_t>(at) % kRemembered];
    if (entry.tick != at) continue;
    for (const ReceivedCommand& command : entry.answers) {
      if (command.tick == at && Same(command.voltage, wanted)) return command;
    }
  }
  return std::nullopt;
}

const ReceivedCommand* PlantRecord::NewestFalse(double wanted) const {
  const auto found = std::find_if(false_.rbegin(), false_.rend(),
                                  [&](const ReceivedCommand& c) { return Same(c.voltage, wanted); });
  return found == false_.rend() ? nullptr : &*found;
}

}  // namespace hydro::torture
