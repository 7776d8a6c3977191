#include "bus/channels.h"

#include <algorithm>

#include "base/bytes.h"

namespace hydro::bus {

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
      const auto read = [&](int place) {
        return static_cast<int64_t>(LoadBigEndian64(message.data + place));
      };
      numbers = {row.part, read(kPlaces.tick), read(kPlaces.session), read(kPlaces.sequence)};
      return true;
    }
  });
  return numbers;
}

}  // namespace hydro::bus
