#include "log/message_kinds.h"

#include "bus/messages.h"

namespace hydro::log {

const std::vector<MessageKind>& MessageKinds() {
  static const std::vector<MessageKind> kinds = [] {
    std::vector<MessageKind> all;
    bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>& row) {
      all.push_back({std::string(row.channel), std::string("hydro.") + Message::getTypeName(),
                     Message::getHash(), [](const LogEvent& event) {
                       Message message;
                       return DecodeAs(event, message);
                     }});
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
