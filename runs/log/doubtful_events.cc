#include "runs/log/doubtful_events.h"

#include <algorithm>
#include <bit>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

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
};

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
    return {};
  }

 private:
  std::optional<Message> Read(const KeptEvent& place) const {
    LogEvent event;
    ParseLogEvent(file_, place.begin, event);
    const MessageKind* kind = KindOfChannel(event.channel);
    if (kind == nullptr) return std::nullopt;
    return Message{event.channel, kind, kind->decodes(event), kind->session(event)};
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
