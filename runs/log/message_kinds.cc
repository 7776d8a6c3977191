#include "runs/log/message_kinds.h"

#include "base/bytes.h"
#include "bus/messages.h"

namespace hydro::log {
namespace {

std::optional<int64_t> NoSession(const LogEvent&) { return std::nullopt; }

template <class Message>
std::optional<int64_t> SessionOf(const LogEvent& event) {
  constexpr int kPlace = bus::PlacesOf<Message>().session;
  if (kPlace < 0 || event.size < kPlace + 8) return std::nullopt;
  return static_cast<int64_t>(LoadBigEndian64(event.data + kPlace));
}

}  // namespace

const std::vector<MessageKind>& MessageKinds() {
  static const std::vector<MessageKind> kinds = [] {
    std::vector<MessageKind> all;
    bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>& row) {
      all.push_back({std::string(row.channel), std::string("hydro.") + Message::getTypeName(),
                     Message::getHash(),
                     [](const LogEvent& event) {
                       Message message;
                       return DecodeAs(event, message);
                     },
                     row.part == bus::LoopPart::kNone ? &NoSession : &SessionOf<Message>});
    });
    return all;
  }();
  return kinds;
}

const MessageKind* KindOfChannel(std::string_view channel) {
  for (const MessageKind& kind : MessageKinds()) {
    if (channel.starts_with(kind.channel)) return &kind;
  }
  return nullptr;
}

}  // namespace hydro::log
