#include "bus/channels.h"

#include <algorithm>

namespace hydro::bus {
namespace {

int64_t ReadInt64(const uint8_t* data) {
  uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = value << 8 | data[i];
  return static_cast<int64_t>(value);
}

}  // namespace

Channels::Channels(const std::string& suffix) {
  size_t index = 0;
  ForEachMessage([&](const auto& row) { names_[index++] = std::string(row.channel) + suffix; });
}

std::optional<LoopNumbers> ReadLoopNumbers(const RawMessage& message, const Channels& channels) {
  std::optional<LoopNumbers> numbers;
  AnyMessage([&]<class Message>(const MessageRow<Message>& row) {
    if constexpr (RowOf<Message>().part == LoopPart::kNone) {
      return false;
    } else {
      if (message.channel != channels.Of<Message>()) return false;
      constexpr NumberPlaces kPlaces = PlacesOf<Message>();
      static_assert(kPlaces.tick >= 0 && kPlaces.session >= 0 && kPlaces.sequence >= 0,
                    "a message of the loops has a tick, a session and a sequence number");
      constexpr int kEnd = 8 + std::max({kPlaces.tick, kPlaces.session, kPlaces.sequence});
      if (message.size < kEnd) return true;
      numbers = {row.part, ReadInt64(message.data + kPlaces.tick), ReadInt64(message.data + kPlaces.session),
                 ReadInt64(message.data + kPlaces.sequence)};
      return true;
    }
  });
  return numbers;
}

}  // namespace hydro::bus
