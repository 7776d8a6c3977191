// Decides which messages are genuine and new in a stack with a key: seals what this process sends and checks
// the seals of what it receives.
//
// It accepts a message whose seal is right (bus_key.h), whose sender has proved that it is alive, and
// whose counter is above all earlier ones on that channel. The proof is an introduction (introduction_t) that
// names the session of this bus, a fresh random number that no recording of an earlier run can contain.
// Therefore
// - a sender without the key, or with another one, is refused;
// - a recording is refused, whether of an earlier run or of this one;
// - a process that restarts has a new session, introduces itself, and is accepted.
//
// Pure: the caller passes the time in and sends the messages that are returned.
#pragma once

#include <chrono>
#include <cstdint>
#include <hydro/introduction_t.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bus/bus.h"
#include "bus/channels.h"
#include "bus/seal/bus_key.h"
#include "bus/session.h"

namespace hydro::bus {

// The channels that are authenticated when the stack has a key: those that the table of messages marks as
// sealed. The channel of the introductions comes first.
inline std::vector<std::string> AuthenticatedChannels(const Channels& channels) {
  std::vector<std::string> sealed = {channels.Of<introduction_t>()};
  ForEachMessage([&]<class Message>(const MessageRow<Message>& row) {
    const std::string& channel = channels.Of<Message>();
    if (row.sealed && channel != sealed.front()) sealed.push_back(channel);
  });
  return sealed;
}

class Authenticator {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  // How long a genuine sender may take to prove itself before it counts as a recording.
  static constexpr auto kIntroductionTime = std::chrono::milliseconds(500);

  enum class Verdict {
    kPlain,     // on a channel that is not authenticated
    kAccepted,  // use it
    kWaiting,   // genuine, but its sender has not yet proved that it is alive: do not use it
    kRefused,   // counted in refused(): do not use it
  };
  struct Opened {
    Verdict verdict = Verdict::kPlain;
    int size = 0;  // without its seal; the whole size if the message is plain or refused
    int64_t session = 0;
    uint64_t counter = 0;
  };

  // `channels` are the authenticated ones; the channel of the introductions comes first. `session` is that of
  // this process's bus; only a simulation passes one that is not fresh.
  Authenticator(const BusKey& key, std::vector<std::string> channels, int64_t session = RandomSession());

  const std::string& introduction_channel() const { return channels_.front(); }
  int64_t session() const { return session_; }

  // Seals the first `size` of `bytes`, which grow as needed, and returns the size including the seal; on a
  // channel that is not authenticated, returns `size`.
  int Seal(std::string_view channel, std::vector<uint8_t>* bytes, int size);

  // Call once for each message that arrives.
  Opened Open(std::string_view channel, const void* data, int size, TimePoint now);

  // The introduction to send first.
  introduction_t Greeting() const { return Introduction(0); }

  // For an introduction that Open() did not refuse: returns the answer, if one is due. Sets `admitted` when
  // the introduction has proved that its sender is genuine.
  std::optional<introduction_t> Hear(const introduction_t& introduction, const Opened& opened,
                                     bool* admitted);

  // For any other waiting message: asks its sender to introduce itself, but not too often.
  std::optional<introduction_t> Ask(int64_t session, TimePoint now);

  const RefusedMessages& refused() const { return refused_; }

 private:
  using Counters = std::vector<uint64_t>;  // the newest accepted counter, by channel

  std::optional<size_t> IndexOf(std::string_view channel) const;
  Opened Refuse(int64_t RefusedMessages::*reason, std::string_view channel, int size);
  bool WaitsTooLong(int64_t session, TimePoint now);
  introduction_t Introduction(int64_t answers) const;

  BusKey key_;
  std::vector<std::string> channels_;
  std::unordered_map<std::string_view, size_t> index_of_;  // their texts
  int64_t session_;
  uint64_t counter_ = 0;
  std::unordered_map<int64_t, Counters>
      admitted_;  // by session; never removed, because a removed session's messages could be replayed
  std::unordered_map<int64_t, TimePoint> waiting_;  // when a session was first heard
  TimePoint next_question_{};
  RefusedMessages refused_;
};

// The authenticator of a stack with that key file; null when `key_file` is empty. Throws InputError
// (bus_key.h). In `channels`, the stack's own come first, then those of its joints.
std::unique_ptr<Authenticator> MakeAuthenticator(const std::string& key_file,
                                                 const std::vector<Channels>& channels, int port);

}  // namespace hydro::bus
