// Decides which messages of a stack with a key are genuine and new: seals what this process sends, and checks
// the seal of what it receives.
//
// Accepted is a message whose seal fits (message_seal.h), from a sender that has proved that it is alive now,
// and whose counter is above that of all before on its channel. The proof is an introduction (introduction_t)
// that names the session of this bus, a fresh random number: no recording of an earlier run can. So
// - nothing is accepted from who has no key, or another one;
// - a recording of an earlier run is refused, whatever it is played to, and one of this run as well;
// - who is started again has a new session, introduces itself, and is accepted.
//
// Pure: time is passed in, what is to be sent is returned.
#pragma once

#include <array>
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

namespace hydro::bus {

class Authenticator {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  // How long a genuine sender may take to prove itself before it is taken for a recording.
  static constexpr auto kIntroductionTime = std::chrono::milliseconds(500);

  enum class Verdict {
    kPlain,     // on a channel that is not authenticated
    kAccepted,  // to be used
    kWaiting,   // genuine, but its sender has not proved yet that it is alive: not to be used
    kRefused,   // counted in refused(): not to be used
  };
  struct Opened {
    Verdict verdict = Verdict::kPlain;
    int size = 0;  // of the message without its seal; the whole size where it is plain or refused
    int64_t session = 0;
    uint64_t counter = 0;
  };

  // `channels`: those that are authenticated, at most 16, the first that of the introductions.
  Authenticator(const BusKey& key, std::vector<std::string> channels);

  const std::string& introduction_channel() const { return channels_.front(); }
  int64_t session() const { return session_; }

  // Puts a seal after the first `size` of `bytes`, which grow if they must, and returns the size with it;
  // `size` on a channel that is not authenticated.
  int Seal(std::string_view channel, std::vector<uint8_t>* bytes, int size);

  // To be called once for each message that arrives.
  Opened Open(std::string_view channel, const void* data, int size, TimePoint now);

  // What to send first.
  introduction_t Greeting() const { return Introduction(0); }

  // For an introduction that Open() did not refuse: what to answer, if anything. `admitted` tells whether its
  // sender has proved itself by it.
  std::optional<introduction_t> Hear(const introduction_t& introduction, const Opened& opened,
                                     bool* admitted);

  // For another message that waits: asks its sender to introduce itself, now and then.
  std::optional<introduction_t> Ask(int64_t session, TimePoint now);

  const RefusedMessages& refused() const { return refused_; }

 private:
  static constexpr size_t kMostChannels = 16;
  using Counters = std::array<uint64_t, kMostChannels>;  // the newest accepted, by channel

  std::optional<size_t> IndexOf(std::string_view channel) const;
  Opened Refuse(int64_t RefusedMessages::*reason, std::string_view channel, int size);
  bool WaitsTooLong(int64_t session, TimePoint now);
  introduction_t Introduction(int64_t answers) const;

  BusKey key_;
  std::vector<std::string> channels_;
  int64_t session_;
  uint64_t counter_ = 0;
  std::unordered_map<int64_t, Counters> admitted_;  // by session; never forgotten, or they could be replayed
  std::unordered_map<int64_t, TimePoint> waiting_;  // when a session was heard first
  TimePoint next_question_{};
  RefusedMessages refused_;
};

// For the stack with that key file; null when `key_file` is empty. Throws InputError (bus_key.h).
std::unique_ptr<Authenticator> MakeAuthenticator(const std::string& key_file, const Channels& channels);

}  // namespace hydro::bus
