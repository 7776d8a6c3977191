#include "runs/log/doubtful_events.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "hydro/run_description_t.hpp"
#include "runs/log/log_reader.h"
#include "runs/log/message_kinds.h"

namespace hydro::log {
namespace {

// A message of this stack, with what is needed to judge it.
struct Message {
  std::string_view channel;
  const MessageKind* kind;
  bool complete;
  std::optional<int64_t> session;
  std::string_view description;  // what a run_description_t says beside when it was sent; else empty
};

// What a description says: all that follows the type's hash and utime.
constexpr size_t kDescriptionBegins = 16;

std::string_view DescriptionIn(const MessageKind& kind, const LogEvent& event) {
  const std::string_view data(reinterpret_cast<const char*>(event.data), static_cast<size_t>(event.size));
  const bool is_one = kind.hash == run_description_t::getHash() && data.size() > kDescriptionBegins;
  return is_one ? data.substr(kDescriptionBegins) : std::string_view();
}

// The session is the first of that.
std::string_view SenderOf(std::string_view description) { return description.substr(0, sizeof(int64_t)); }

// Sessions are drawn at random from 64 bits (bus/session.h), so two of different processes have at least this
// many different bytes, but once in some 10 million pairs.
constexpr int kBytesThatDiffer = 5;

// A channel has one sender, and one more for each restart. Among more than these, none is looked for.
constexpr size_t kMostSenders = 64;

int DifferentBytes(int64_t a, int64_t b) {
  int different = 0;
  for (auto bits = static_cast<uint64_t>(a) ^ static_cast<uint64_t>(b); bits != 0; bits >>= 8) {
    different += (bits & 0xff) != 0 ? 1 : 0;
  }
  return different;
}

// One recording.
class Judge {
 public:
  explicit Judge(const MappedFile& file) : file_(file) {}

  void Learn(const KeptEvent& place) {
    const std::optional<Message> message = Read(place);
    if (!message) return;
    if (message->complete) complete_.insert(message->channel);
    if (place.vouched && message->session) senders_[message->channel].insert(*message->session);
    if (message->complete && !message->description.empty()) {
      Copies& copies =
          descriptions_[{message->channel, SenderOf(message->description)}][message->description];
      ++copies.all;
      copies.vouched += place.vouched ? 1 : 0;
    }
  }

  // Why the message is doubtful; empty: it is not.
  std::string Doubt(const KeptEvent& place) const {
    const std::optional<Message> message = Read(place);
    if (!message) return {};
    const std::string channel(message->channel);
    // Where none is complete, they come from another version. One that was recorded as it is, was sent torn,
    // or by another version beside this one: no verb that needs the whole run can read it.
    if (!message->complete && complete_.contains(message->channel))
      return "an event on " + channel + " that is not a whole " + message->kind->type;
    if (!place.vouched && message->session && IsNearlyKnown(message->channel, *message->session))
      return "an event on " + channel + " of a sender that no event with a checksum has";
    if (!place.vouched && Differs(*message))
      return "an event on " + channel + " that differs from the others of its sender";
    return {};
  }

 private:
  // How often a sender said something.
  struct Copies {
    size_t vouched = 0;
    size_t all = 0;
  };

  std::optional<Message> Read(const KeptEvent& place) const {
    LogEvent event;
    ParseLogEvent(file_, place.begin, event);
    const MessageKind* kind = KindOfChannel(event.channel);
    if (kind == nullptr) return std::nullopt;
    return Message{event.channel, kind, kind->decodes(event), kind->session(event),
                   DescriptionIn(*kind, event)};
  }

  // Whether the sender of this description says something else with a checksum, or more often. A process
  // sends the same again and again.
  bool Differs(const Message& message) const {
    const auto sender = descriptions_.find({message.channel, SenderOf(message.description)});
    if (message.description.empty() || sender == descriptions_.end()) return false;
    const auto own = sender->second.find(message.description);
    if (own == sender->second.end() || own->second.vouched > 0) return false;
    return std::any_of(sender->second.begin(), sender->second.end(), [&](const auto& other) {
      return other.second.vouched > 0 || other.second.all > own->second.all;
    });
  }

  bool IsNearlyKnown(std::string_view channel, int64_t session) const {
    const auto known = senders_.find(channel);
    if (known == senders_.end() || known->second.contains(session)) return false;
    if (known->second.size() > kMostSenders) return false;
    return std::any_of(known->second.begin(), known->second.end(),
                       [&](int64_t sender) { return DifferentBytes(sender, session) < kBytesThatDiffer; });
  }

  const MappedFile& file_;
  std::set<std::string_view> complete_;  // channels
  std::map<std::string_view, std::set<int64_t>> senders_;
  // By channel and sender, what it says of its run.
  std::map<std::pair<std::string_view, std::string_view>, std::map<std::string_view, Copies>> descriptions_;
};

}  // namespace

void DropDoubtful(const MappedFile& file, const std::vector<int64_t>& joins, std::vector<KeptEvent>& kept,
                  std::vector<LostBytes>& lost) {
  std::vector<KeptEvent> good;
  size_t join = 0;
  for (size_t begin = 0; begin < kept.size();) {
    while (join < joins.size() && joins[join] <= kept[begin].begin) ++join;
    size_t end = begin;
    while (end < kept.size() && (join == joins.size() || kept[end].begin < joins[join])) ++end;
    Judge judge(file);
    for (size_t k = begin; k < end; ++k) judge.Learn(kept[k]);
    for (size_t k = begin; k < end; ++k) {
      const std::string doubt = judge.Doubt(kept[k]);
      if (doubt.empty()) {
        good.push_back(kept[k]);
      } else {
        lost.push_back({kept[k].begin, kept[k].end, doubt});
      }
    }
    begin = end;
  }
  kept = std::move(good);
}

}  // namespace hydro::log
