#include "bus/seal/authenticator.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "bus/clock.h"
#include "bus/session.h"

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;

// A recording that is played fast must not make this process send equally fast.
constexpr auto kQuestionPeriod = 10ms;

// These bound the memory. Only holders of the key can fill the first; in the second, new entries replace the
// oldest.
constexpr size_t kMostAdmitted = 65536;
constexpr size_t kMostWaiting = 64;

}  // namespace

Authenticator::Authenticator(const BusKey& key, std::vector<std::string> channels, int64_t session)
    : key_(key), channels_(std::move(channels)), session_(session) {
  if (channels_.empty()) throw std::invalid_argument("an authenticator takes at least one channel");
  for (size_t i = 0; i < channels_.size(); ++i) index_of_.emplace(channels_[i], i);
  admitted_[session_].resize(channels_.size());  // multicast brings our own messages back
}

std::optional<size_t> Authenticator::IndexOf(std::string_view channel) const {
  const auto found = index_of_.find(channel);
  return found == index_of_.end() ? std::nullopt : std::optional(found->second);
}

int Authenticator::Seal(std::string_view channel, std::vector<uint8_t>* bytes, int size) {
  if (!IndexOf(channel)) return size;
  const size_t sealed_size = static_cast<size_t>(size) + kSealSize;
  if (bytes->size() < sealed_size) bytes->resize(sealed_size);
  hydro::bus::Seal seal{session_, ++counter_, {}};
  seal.tag = SealTag(key_.bytes(), channel, session_, counter_, bytes->data(), size);
  WriteSeal(seal, bytes->data() + size);
  return size + kSealSize;
}

Authenticator::Opened Authenticator::Refuse(int64_t RefusedMessages::*reason, std::string_view channel,
                                            int size) {
  ++(refused_.*reason);
  refused_.last_channel = channel;
  return {Verdict::kRefused, size, 0, 0};
}

Authenticator::Opened Authenticator::Open(std::string_view channel, const void* data, int size,
                                          TimePoint now) {
  const std::optional<size_t> index = IndexOf(channel);
  if (!index) return {Verdict::kPlain, size, 0, 0};
  hydro::bus::Seal seal;
  if (!ReadSeal(data, size, &seal)) return Refuse(&RefusedMessages::unsealed, channel, size);
  const int message_size = size - kSealSize;
  const auto tag = SealTag(key_.bytes(), channel, seal.session, seal.counter, data, message_size);
  if (!SameTag(tag, seal.tag)) return Refuse(&RefusedMessages::wrong_seal, channel, size);

  const auto sender = admitted_.find(seal.session);
  if (sender == admitted_.end()) {
    // An introduction may be the very proof that this process awaits.
    if (*index != 0 && WaitsTooLong(seal.session, now)) {
      Opened opened = Refuse(&RefusedMessages::unknown_sender, channel, size);
      opened.session = seal.session;
      return opened;
    }
    return {Verdict::kWaiting, message_size, seal.session, seal.counter};
  }
  uint64_t& newest = sender->second[*index];
  if (seal.counter <= newest) return Refuse(&RefusedMessages::repeated, channel, size);
  newest = seal.counter;
  return {Verdict::kAccepted, message_size, seal.session, seal.counter};
}

bool Authenticator::WaitsTooLong(int64_t session, TimePoint now) {
  if (const auto found = waiting_.find(session); found != waiting_.end()) {
    return now - found->second > kIntroductionTime;
  }
  if (waiting_.size() >= kMostWaiting) {
    waiting_.erase(std::min_element(waiting_.begin(), waiting_.end(),
                                    [](const auto& a, const auto& b) { return a.second < b.second; }));
  }
  waiting_[session] = now;
  return false;
}

introduction_t Authenticator::Introduction(int64_t answers) const {
  introduction_t introduction{};
  introduction.utime = WallClock().Utime();
  introduction.session = session_;
  introduction.answers = answers;
  introduction.known = admitted_.contains(answers);
  return introduction;
}

std::optional<introduction_t> Authenticator::Hear(const introduction_t& introduction, const Opened& opened,
                                                  bool* admitted) {
  *admitted = false;
  if (opened.session == session_) return std::nullopt;
  const bool answers_us = introduction.answers == session_;
  if (answers_us && !admitted_.contains(opened.session) && admitted_.size() < kMostAdmitted) {
    // Nothing proves that the sender's earlier messages are new.
    admitted_[opened.session].assign(channels_.size(), opened.counter);
    waiting_.erase(opened.session);
    *admitted = true;
  }
  const bool asks = introduction.answers == 0 || (answers_us && introduction.known == 0);
  return asks ? std::optional(Introduction(opened.session)) : std::nullopt;
}

std::optional<introduction_t> Authenticator::Ask(int64_t session, TimePoint now) {
  if (now < next_question_) return std::nullopt;
  next_question_ = now + kQuestionPeriod;
  return Introduction(session);
}

std::unique_ptr<Authenticator> MakeAuthenticator(const std::string& key_file,
                                                 const std::vector<Channels>& channels, int port) {
  if (key_file.empty()) return nullptr;
  std::vector<std::string> sealed;
  for (const Channels& one : channels) {
    const std::vector<std::string> names = AuthenticatedChannels(one);
    sealed.insert(sealed.end(), names.begin(), names.end());
  }
  return std::make_unique<Authenticator>(KeyForPort(ReadBusKey(key_file), port), sealed);
}

}  // namespace hydro::bus
