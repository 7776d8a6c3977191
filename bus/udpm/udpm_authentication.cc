// How UdpmBus handles authenticated messages (authenticator.h).
#include <utility>

#include "bus/udpm/udpm_bus.h"

namespace hydro::bus {
namespace {

// A refused message is still recorded, under a name that nobody mistakes for the real channel.
constexpr const char* kRefusedPrefix = "REFUSED_";

// The number of messages that may wait for their senders to prove themselves.
constexpr size_t kMostHeld = 1024;

}  // namespace

// Introductions start only after everyone has subscribed, because a subscriber that records everything needs
// them too.
void UdpmBus::StartIntroductions() {
  introduced_ = true;
  const std::string& channel = authenticator_->introduction_channel();
  socket_.Accept(channel);
  Publish(channel, authenticator_->Greeting());
}

// Returns how much of the message handlers may see: its size without the seal, or nothing when they must not
// see it.
std::optional<int> UdpmBus::Authenticate(const RawMessage& arrived) {
  using Verdict = Authenticator::Verdict;
  const auto now = std::chrono::steady_clock::now();
  const Authenticator::Opened opened = authenticator_->Open(arrived.channel, arrived.data, arrived.size, now);
  if (opened.verdict == Verdict::kPlain) return opened.size;
  if (opened.verdict == Verdict::kRefused) {
    RecordRefused(arrived);
    // A sender that is merely slow still gets its chance.
    if (opened.session != 0) Ask(opened.session, now);
    return std::nullopt;
  }
  if (arrived.channel == authenticator_->introduction_channel()) {
    introduction_t introduction;
    if (introduction.decode(arrived.data, 0, opened.size) != opened.size) return std::nullopt;
    bool admitted = false;
    const auto answer = authenticator_->Hear(introduction, opened, &admitted);
    if (answer) Publish(authenticator_->introduction_channel(), *answer);
    if (admitted) RecordHeld(opened.session);
    return opened.size;
  }
  if (opened.verdict == Verdict::kAccepted) return opened.size;
  if (socket_.accepts_all() && held_.size() < kMostHeld) {
    held_.push_back({std::string(arrived.channel),
                     {arrived.data, arrived.data + arrived.size},
                     arrived.receive_utime,
                     opened.session,
                     now});
  } else {
    RecordRefused(arrived);
  }
  Ask(opened.session, now);
  return std::nullopt;
}

void UdpmBus::Ask(int64_t session, TimePoint now) {
  if (const auto question = authenticator_->Ask(session, now)) {
    Publish(authenticator_->introduction_channel(), *question);
  }
}

void UdpmBus::Record(const RawMessage& message) {
  const size_t count = subscriptions_.size();  // a handler may subscribe
  for (size_t i = 0; i < count; ++i) {
    if (subscriptions_[i].type == nullptr) subscriptions_[i].raw(message);
  }
}

void UdpmBus::RecordRefused(const RawMessage& arrived) {
  if (!socket_.accepts_all()) return;
  const std::string channel = kRefusedPrefix + std::string(arrived.channel);
  Record({channel, arrived.data, arrived.size, arrived.receive_utime});
}

void UdpmBus::RecordHeld(int64_t session) {
  for (const HeldMessage& held : std::exchange(held_, {})) {
    if (held.session != session) {
      held_.push_back(held);
      continue;
    }
    const int size = SizeWithoutSeal(held.data.data(), static_cast<int>(held.data.size()));
    Record({held.channel, held.data.data(), size, held.receive_utime});
  }
}

void UdpmBus::GiveUpHeld() {
  const auto now = std::chrono::steady_clock::now();
  while (!held_.empty() && now - held_.front().arrived > Authenticator::kIntroductionTime) {
    const HeldMessage held = std::move(held_.front());
    held_.pop_front();
    RecordRefused({held.channel, held.data.data(), static_cast<int>(held.data.size()), held.receive_utime});
  }
}

}  // namespace hydro::bus
