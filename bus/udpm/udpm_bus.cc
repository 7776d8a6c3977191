#include "bus/udpm/udpm_bus.h"

#include <poll.h>
#include <pthread.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <string_view>
#include <utility>

#include "bus/udpm/multicast_self_test.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {
namespace {

constexpr int kMostPerCall = 4096;
constexpr size_t kFirstEncodedSize = 64 << 10;  // longer messages make the buffer grow once
constexpr std::string_view kLcmSelfTest = "LCM_SELF_TEST";

// While it lives, threads that are created inherit a mask in which every signal is blocked: signals must
// reach the application's thread, or HandleUntil() would not notice them.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

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

// LCM takes a channel to subscribe to as a regular expression.
std::string EscapeRegex(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') pattern += '\\';
    pattern += c;
  }
  return pattern;
}

void CheckChannel(const std::string& channel) {
  if (channel.empty() || channel.size() > LCM_MAX_CHANNEL_NAME_LENGTH) {
    throw BusError("channel \"" + channel + "\" has " + std::to_string(channel.size()) +
                   " characters; LCM allows 1 to " + std::to_string(LCM_MAX_CHANNEL_NAME_LENGTH));
  }
}

// The network may come back: it has worked before (the constructor has seen to that).
bool IsPassing(int error) {
  return error == ENETUNREACH || error == ENETDOWN || error == EHOSTUNREACH || error == EADDRNOTAVAIL ||
         error == ENOBUFS || error == EPERM;  // the last: a firewall
}

// Waits until `fd` can be read: 1, the deadline passed: 0, a signal arrived: -1.
int WaitReadable(int fd, Bus::TimePoint deadline) {
  while (true) {
    timespec timeout{};
    const auto now = std::chrono::steady_clock::now();
    if (deadline > now) {
      const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(deadline - now).count();
      timeout.tv_sec = left / 1'000'000'000;
      timeout.tv_nsec = left % 1'000'000'000;
    }
    pollfd waiting{fd, POLLIN, 0};
    const int ready = ppoll(&waiting, 1, &timeout, nullptr);
    if (ready > 0) return 1;
    if (ready < 0 && errno == EINTR) return -1;
    if (ready < 0) throw BusError(std::string("waiting for messages failed: ") + std::strerror(errno));
    if (deadline <= now || std::chrono::steady_clock::now() >= deadline) return 0;
  }
}

}  // namespace

UdpmBus::UdpmBus(const std::string& url, std::unique_ptr<Authenticator> authenticator, Receiving receiving)
    : encoded_(kFirstEncodedSize), authenticator_(std::move(authenticator)) {
  std::string lcm_url = url;
  if (url != "memq://") {
    UdpmUrl parsed = ParseUdpmUrl(url);
    if (parsed.recv_buf_size == 0) parsed.recv_buf_size = kReceiveBufferBytes;
    receive_buffer_asked_ = parsed.recv_buf_size;
    receive_buffer_bytes_ = TestMulticast(parsed);
    // LCM prints several lines when it gets less than it asks for: we know what it will get.
    parsed.recv_buf_size = std::min(parsed.recv_buf_size, receive_buffer_bytes_);
    lcm_url = parsed.ToString();
    if (receiving == Receiving::kDirect) {
      socket_ = std::make_unique<UdpmSocket>(parsed);
      fd_ = socket_->fd();
      return;
    }
  }
  const SignalsBlocked blocked;
  lcm_ = lcm_create(lcm_url.c_str());
  if (lcm_ == nullptr)
    throw BusError("LCM cannot work with " + lcm_url + "; see Troubleshooting in README.md");
  fd_ = lcm_get_fileno(lcm_);  // starts receiving, and LCM's own self test
  if (fd_ < 0) {
    lcm_destroy(lcm_);
    throw BusError("LCM's self test failed for " + lcm_url + "; see Troubleshooting in README.md");
  }
  // LCM counts per subscription how many messages wait, and takes one off for each that is handled and
  // matches, also when it was queued before the subscription was made; then the last of a burst is never
  // delivered. Its self test leaves such messages, those of other processes included: take them out before
  // anybody subscribes.
  while (WaitReadable(fd_, TimePoint::min()) == 1) {
    if (lcm_handle(lcm_) != 0) throw BusError("LCM cannot receive any more");
  }
}

UdpmBus::~UdpmBus() {
  if (lcm_ != nullptr) lcm_destroy(lcm_);
}

std::string UdpmBus::receive_buffer_hint() const {
  if (receive_buffer_bytes_ >= receive_buffer_asked_) return {};
  return "the kernel's receive buffer is " + std::to_string(receive_buffer_bytes_) + " of " +
         std::to_string(receive_buffer_asked_) +
         " bytes: bursts may lose messages; allow it with `sysctl -w net.core.rmem_max=" +
         std::to_string(receive_buffer_asked_) + "`";
}

void UdpmBus::SubscribeAll(std::function<void(const RawMessage&)> handler) {
  Subscription& added =
      subscriptions_.emplace_back(Subscription{this, "", nullptr, nullptr, {}, std::move(handler)});
  if (all_ == nullptr) AddSubscription(".*", &added);
  all_ = all_ == nullptr ? &added : all_;
}

void UdpmBus::SubscribeTyped(const std::string& channel, const MessageType& type,
                             std::function<void(const void*)> handler) {
  CheckChannel(channel);
  Subscription& added =
      subscriptions_.emplace_back(Subscription{this, channel, &type, type.create(), std::move(handler), {}});
  // Where all channels are subscribed already, that subscription serves this one too: two that overlap would
  // meet the miscount described in the constructor.
  if (all_ == nullptr) {
    added.own = true;
    AddSubscription(EscapeRegex(channel), &added);
  }
}

void UdpmBus::AddSubscription(const std::string& pattern, Subscription* subscription) {
  if (socket_ != nullptr) {
    subscription->type == nullptr ? socket_->AcceptAll() : socket_->Accept(subscription->channel);
    return;
  }
  lcm_subscription_t* const added = lcm_subscribe(lcm_, pattern.c_str(), &UdpmBus::OnMessage, subscription);
  if (added == nullptr) throw BusError("LCM refuses to subscribe to " + pattern);
  lcm_subscription_set_queue_capacity(added, 0);  // unlimited: the default drops the newest after 30
}

void UdpmBus::OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* subscription) noexcept {
  auto* const target = static_cast<Subscription*>(subscription);
  if (target->bus->exception_) return;
  try {
    target->bus->Deliver(*buffer, channel, target);
  } catch (...) {
    target->bus->exception_ = std::current_exception();
  }
}

void UdpmBus::Deliver(const lcm_recv_buf_t& buffer, const char* channel, Subscription* subscription) {
  RawMessage message{channel, static_cast<const uint8_t*>(buffer.data), static_cast<int>(buffer.data_size),
                     buffer.recv_utime};
  if (message.channel == kLcmSelfTest) return;
  if (authenticator_ != nullptr) {
    // Once for all subscriptions: a second look would take it for a repetition.
    if (!std::exchange(opened_, true)) plain_size_ = Authenticate(message);
    if (!plain_size_) return;
    message.size = *plain_size_;
    if (subscription != all_ && message.channel == authenticator_->introduction_channel()) return;
  }
  if (subscription == all_) {
    delivered_ = true;
    // By index: a handler may subscribe. What it adds does not get this message.
    const size_t count = subscriptions_.size();
    Record(message);
    for (size_t i = 0; i < count; ++i) {
      Subscription& typed = subscriptions_[i];
      if (typed.type != nullptr && !typed.own && typed.channel == message.channel) {
        DeliverTyped(message, &typed);
      }
    }
  } else {
    DeliverTyped(message, subscription);
  }
}

void UdpmBus::DeliverTyped(const RawMessage& message, Subscription* subscription) {
  if (subscription->type->decode_into(subscription->message.get(), message.data, message.size)) {
    delivered_ = true;
    subscription->typed(subscription->message.get());
  } else {
    ++undecodable_;
    undecodable_channel_ = message.channel;
  }
}

void UdpmBus::PublishRaw(const std::string& channel, const void* data, int size) {
  CheckChannel(channel);
  if (authenticator_ != nullptr) {
    const auto* const bytes = static_cast<const uint8_t*>(data);
    encoded_.assign(bytes, bytes + size);
    size = authenticator_->Seal(channel, &encoded_, size);
    data = encoded_.data();
  }
  Send(channel, data, size);
}

void UdpmBus::PublishTyped(const std::string& channel, const MessageType& type, const void* message) {
  CheckChannel(channel);
  int size = type.encoded_size(message);
  if (encoded_.size() < static_cast<size_t>(size)) encoded_.resize(size);
  if (type.encode(message, encoded_.data(), size) != size) {
    throw BusError("a message for " + channel + " cannot be encoded");
  }
  if (authenticator_ != nullptr) size = authenticator_->Seal(channel, &encoded_, size);
  Send(channel, encoded_.data(), size);
}

void UdpmBus::Send(const std::string& channel, const void* data, int size) {
  const bool sent = socket_ != nullptr
                        ? socket_->Send(channel, data, static_cast<size_t>(size))
                        : lcm_publish(lcm_, channel.c_str(), data, static_cast<unsigned>(size)) == 0;
  if (!sent) {
    if (IsPassing(errno)) {
      ++unsent_;  // as if it were lost on its way: whoever waits for it has a watchdog
      return;
    }
    throw BusError("LCM cannot publish on " + channel + ": " + std::strerror(errno));
  }
}

int UdpmBus::HandleUntil(TimePoint deadline) {
  const Marked marked(&handling_);
  int handled = 0;
  if (authenticator_ != nullptr && !introduced_) StartIntroductions();
  if (!held_.empty()) GiveUpHeld();
  for (int seen = 0; seen < kMostPerCall;) {
    // Once something was handled, only what is there already counts. A socket says so itself.
    const bool waits = socket_ == nullptr || handled == 0;
    if (waits && WaitReadable(fd_, handled > 0 ? TimePoint::min() : deadline) != 1) break;
    ++seen;
    delivered_ = false;
    opened_ = false;
    const bool received = HandleNext();
    if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
    if (delivered_) ++handled;
    if (!received && handled > 0) break;
  }
  return handled;
}

// Handles one message; false when there was none.
bool UdpmBus::HandleNext() {
  if (socket_ == nullptr) {
    if (lcm_handle(lcm_) != 0) throw BusError("LCM cannot receive any more");
    return true;
  }
  UdpmSocket::Message message;
  if (!socket_->Receive(&message)) return false;
  Dispatch(message);
  return true;
}

// What LCM does with a message: hands it to each subscription that it matches.
void UdpmBus::Dispatch(const UdpmSocket::Message& message) {
  lcm_recv_buf_t buffer{};
  buffer.data = const_cast<uint8_t*>(message.data);
  buffer.data_size = static_cast<uint32_t>(message.size);
  buffer.recv_utime = message.receive_utime;
  const size_t count = subscriptions_.size();  // a handler may subscribe
  for (size_t i = 0; i < count; ++i) {
    Subscription& subscription = subscriptions_[i];
    const bool wanted =
        &subscription == all_ || (subscription.own && subscription.channel == message.channel);
    if (wanted) OnMessage(&buffer, message.channel, &subscription);
  }
}

}  // namespace hydro::bus
