#include "bus/udpm/udpm_bus.h"

#include <poll.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "bus/udpm/lcm_packet.h"

namespace hydro::bus {
namespace {

constexpr int kMostPerCall = 4096;
constexpr size_t kFirstEncodedSize = 64 << 10;  // longer messages make the buffer grow once
constexpr std::string_view kLcmSelfTest = "LCM_SELF_TEST";

class Marked {
 public:
  explicit Marked(bool* flag) : flag_(flag) {
    if (*flag_) throw std::logic_error("HandleUntil called from a handler");
    *flag_ = true;
  }
  ~Marked() { *flag_ = false; }
  Marked(const Marked&) = delete;
  Marked& operator=(const Marked&) = delete;

 private:
  bool* flag_;
};

void CheckChannel(const std::string& channel) {
  if (channel.empty() || channel.size() > kLcmLongestChannel) {
    throw BusError("channel \"" + channel + "\" has " + std::to_string(channel.size()) +
                   " characters; LCM allows 1 to " + std::to_string(kLcmLongestChannel));
  }
}

// The network may come back, because it has worked before (OpenUdpmBus() checked that).
bool IsPassing(int error) {
  return error == ENETUNREACH || error == ENETDOWN || error == EHOSTUNREACH || error == EADDRNOTAVAIL ||
         error == ENOBUFS || error == EPERM;  // the last: a firewall
}

enum class Wait { kReadable, kOther, kDeadline, kSignal };

// `other` also ends the wait when it is readable; -1: none.
Wait WaitReadable(int fd, int other, Bus::TimePoint deadline) {
  while (true) {
    timespec timeout{};
    const auto now = std::chrono::steady_clock::now();
    if (deadline > now) {
      const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(deadline - now).count();
      timeout.tv_sec = left / 1'000'000'000;
      timeout.tv_nsec = left % 1'000'000'000;
    }
    pollfd waiting[] = {{fd, POLLIN, 0}, {other, POLLIN, 0}};
    const int ready = ppoll(waiting, 2, &timeout, nullptr);
    if (ready > 0) return waiting[0].revents != 0 ? Wait::kReadable : Wait::kOther;
    if (ready < 0 && errno == EINTR) return Wait::kSignal;
    if (ready < 0) throw BusError(std::string("waiting for messages failed: ") + std::strerror(errno));
    if (deadline <= now || std::chrono::steady_clock::now() >= deadline) return Wait::kDeadline;
  }
}

}  // namespace

UdpmBus::UdpmBus(const UdpmUrl& url, std::unique_ptr<Authenticator> authenticator,
                 ReceiveBuffer receive_buffer)
    : authenticator_(std::move(authenticator)),
      receive_buffer_(receive_buffer),
      socket_(url),
      encoded_(kFirstEncodedSize) {
  if (authenticator_ != nullptr) refused_ = &authenticator_->refused();
}

std::string UdpmBus::receive_buffer_hint() const {
  const auto [asked, given] = receive_buffer_;
  if (given >= asked) return {};
  return "the kernel's receive buffer is " + std::to_string(given) + " of " + std::to_string(asked) +
         " bytes: bursts may lose messages; allow it with `sysctl -w net.core.rmem_max=" +
         std::to_string(asked) + "`";
}

void UdpmBus::SubscribeAll(std::function<void(const RawMessage&)> handler) {
  socket_.AcceptAll();
  subscriptions_.push_back({"", nullptr, nullptr, {}, std::move(handler)});
}

void UdpmBus::SubscribeTyped(const std::string& channel, const MessageType& type,
                             std::function<void(const void*)> handler) {
  CheckChannel(channel);
  socket_.Accept(channel);
  subscriptions_.push_back({channel, &type, type.create(), std::move(handler), {}});
}

UdpmBus::Outcome UdpmBus::HandleNext() {
  UdpmSocket::Message message;
  if (!socket_.Receive(&message)) return Outcome::kNoneWaited;
  return Deliver({message.channel, message.data, static_cast<int>(message.size), message.receive_utime});
}

UdpmBus::Outcome UdpmBus::Deliver(const RawMessage& arrived) {
  RawMessage message = arrived;
  if (message.channel == kLcmSelfTest) return Outcome::kPassedOver;
  bool introduction = false;  // only for the bus itself and the recording
  if (authenticator_ != nullptr) {
    const std::optional<int> plain_size = Authenticate(message);
    if (!plain_size) return Outcome::kPassedOver;
    message.size = *plain_size;
    introduction = message.channel == authenticator_->introduction_channel();
  }
  Outcome outcome = Outcome::kPassedOver;
  // The loop goes by index, because a handler may subscribe. New subscriptions do not get this message.
  const size_t count = subscriptions_.size();
  for (size_t i = 0; i < count; ++i) {
    Subscription& subscription = subscriptions_[i];
    if (subscription.type == nullptr) {
      outcome = Outcome::kHandled;
      subscription.raw(message);
    } else if (!introduction && subscription.channel == message.channel &&
               DeliverTyped(message, &subscription)) {
      outcome = Outcome::kHandled;
    }
  }
  return outcome;
}

// Returns false when the message cannot be decoded.
bool UdpmBus::DeliverTyped(const RawMessage& message, Subscription* subscription) {
  if (!subscription->type->decode_into(subscription->message.get(), message.data, message.size)) {
    ++undecodable_;
    undecodable_channel_ = message.channel;
    return false;
  }
  subscription->typed(subscription->message.get());
  return true;
}

void UdpmBus::PublishRaw(const std::string& channel, const void* data, int size) {
  CheckChannel(channel);
  if (authenticator_ != nullptr) {
    const auto* const bytes = static_cast<const uint8_t*>(data);
    encoded_.assign(bytes, bytes + size);
    size = authenticator_->Seal(channel, &encoded_, size);
    data = encoded_.data();
  }
  SendOrCount(channel, data, size);
}

void UdpmBus::PublishTyped(const std::string& channel, const MessageType& type, const void* message) {
  CheckChannel(channel);
  int size = type.encoded_size(message);
  if (encoded_.size() < static_cast<size_t>(size)) encoded_.resize(size);
  if (type.encode(message, encoded_.data(), size) != size) {
    throw BusError("a message for " + channel + " cannot be encoded");
  }
  if (authenticator_ != nullptr) size = authenticator_->Seal(channel, &encoded_, size);
  SendOrCount(channel, encoded_.data(), size);
}

void UdpmBus::SendOrCount(const std::string& channel, const void* data, int size) {
  if (socket_.Send(channel, data, static_cast<size_t>(size))) return;
  if (!IsPassing(errno)) throw BusError("LCM cannot publish on " + channel + ": " + std::strerror(errno));
  ++unsent_;  // as if lost on its way: every process that waits for it has a watchdog
}

int UdpmBus::HandleUntil(TimePoint deadline) {
  const Marked marked(&handling_);
  if (authenticator_ != nullptr && !introduced_) StartIntroductions();
  if (!held_.empty()) GiveUpHeld();
  int handled = 0;
  for (int seen = 0; seen < kMostPerCall; ++seen) {
    // Once a message has been handled, the loop takes only those that already wait.
    if (handled == 0 && WaitReadable(socket_.fd(), wake_on_, deadline) != Wait::kReadable) break;
    const Outcome outcome = HandleNext();
    if (outcome == Outcome::kHandled) ++handled;
    if (outcome == Outcome::kNoneWaited && handled > 0) break;
  }
  return handled;
}

}  // namespace hydro::bus
