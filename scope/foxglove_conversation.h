// The conversation with Foxglove, Lichtblick or PlotJuggler: version 1 of their web-socket protocol,
// read-only.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "base/unit_system.h"
#include "scope/run_table.h"
#include "scope/signals/message_store.h"
#include "scope/wire/site.h"

namespace hydro::scope {

// The messages of a stack in the form that Foxglove's protocol carries: encoded as CDR and described by ROS 2
// message definitions, which Foxglove, Lichtblick and PlotJuggler read. hydro-log export writes the same to
// MCAP files.
struct FoxgloveTopic {
  std::string topic;    // "/hydro/state"
  std::string channel;  // LCM channel, without the stack's suffix
  std::string schema_name;

  // A ROS 2 message definition; its comments give the units of the fields for a stack in these units.
  std::string SchemaIn(const UnitSystem& units) const;

  // Writes the message as CDR, little endian. Returns false when the bytes are not such a message.
  bool Encode(const uint8_t* data, int size, std::string* cdr) const;
};

// The topics that change while a stack runs.
const std::vector<FoxgloveTopic>& FoxgloveTopics();

// Sends the messages of the running stack on the topics to which the client subscribes. It reads them from
// the run's store when the client is ready for them: a client that is more than kMostBehind messages late
// continues with the newest.
class FoxgloveConversation : public Conversation {
 public:
  static constexpr uint64_t kMostBehind = 20000;

  explicit FoxgloveConversation(RunTable* runs);

  // Whether a subprotocol is one of theirs.
  static bool Speaks(const std::string& subprotocol);

  void Hear(std::string_view message, bool binary) override;
  bool Next(Message* message) override;
  bool over() const override { return wrong_ >= 20; }

  uint64_t skipped() const { return skipped_; }

 private:
  void Subscribe(std::string_view message);
  void Complain(const std::string& text);

  RunTable& runs_;
  const MessageStore* store_ = nullptr;  // the store that the place is in
  MessageStore::Place place_{};
  std::deque<std::string> replies_;
  std::map<std::string, std::map<uint32_t, size_t>, std::less<>> subscriptions_;  // by channel: id, topic
  std::deque<Message> ready_;  // one message, for several subscriptions
  std::string cdr_;
  uint64_t skipped_ = 0;
  int wrong_ = 0;
};

}  // namespace hydro::scope
