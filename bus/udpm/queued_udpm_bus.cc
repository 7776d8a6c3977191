#include "bus/udpm/queued_udpm_bus.h"

#include <poll.h>
#include <pthread.h>

#include <cctype>
#include <csignal>
#include <utility>

namespace hydro::bus {
namespace {

// While it lives, new threads inherit a mask that blocks every signal: signals must reach the application's
// thread, or HandleUntil() would not notice them.
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

// LCM treats the channel of a subscription as a regular expression.
std::string EscapeRegex(const std::string& channel) {
  std::string pattern;
  for (const char c : channel) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_') pattern += '\\';
    pattern += c;
  }
  return pattern;
}

}  // namespace

QueuedUdpmBus::QueuedUdpmBus(const std::string& lcm_url, std::unique_ptr<Authenticator> authenticator,
                             ReceiveBuffer receive_buffer)
    : UdpmBus(std::move(authenticator), receive_buffer) {
  const SignalsBlocked blocked;
  lcm_ = lcm_create(lcm_url.c_str());
  if (lcm_ == nullptr)
    throw BusError("LCM cannot work with " + lcm_url + "; see Troubleshooting in README.md");
  fd_ = lcm_get_fileno(lcm_);  // starts receiving, and LCM's own self test
  if (fd_ < 0) {
    lcm_destroy(lcm_);
    throw BusError("LCM's self test failed for " + lcm_url + "; see Troubleshooting in README.md");
  }
  // For each subscription LCM counts the waiting messages, and subtracts one for each handled message that
  // matches, even one queued before the subscription was made; then the last message of a burst is never
  // delivered. LCM's self test leaves such messages, including those of other processes: take them out before
  // anyone subscribes.
  while (Waits()) {
    if (lcm_handle(lcm_) != 0) throw BusError("LCM cannot receive any more");
  }
}

QueuedUdpmBus::~QueuedUdpmBus() { lcm_destroy(lcm_); }

bool QueuedUdpmBus::Waits() const {
  pollfd waiting{fd_, POLLIN, 0};
  return poll(&waiting, 1, 0) > 0;
}

UdpmBus::Outcome QueuedUdpmBus::HandleNext() {
  if (!Waits()) return Outcome::kNoneWaited;  // lcm_handle() would block
  seen_ = false;
  outcome_ = Outcome::kPassedOver;
  if (lcm_handle(lcm_) != 0) throw BusError("LCM cannot receive any more");
  if (exception_) std::rethrow_exception(std::exchange(exception_, nullptr));
  return outcome_;
}

void QueuedUdpmBus::OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* bus) noexcept {
  auto* const self = static_cast<QueuedUdpmBus*>(bus);
  if (std::exchange(self->seen_, true)) return;
  try {
    self->outcome_ = self->Deliver({channel, static_cast<const uint8_t*>(buffer->data),
                                    static_cast<int>(buffer->data_size), buffer->recv_utime});
  } catch (...) {
    self->exception_ = std::current_exception();
  }
}

bool QueuedUdpmBus::Send(const std::string& channel, const void* data, int size) {
  return lcm_publish(lcm_, channel.c_str(), data, static_cast<unsigned>(size)) == 0;
}

void QueuedUdpmBus::Listen(const std::string& channel) { SubscribeLcm(EscapeRegex(channel)); }

void QueuedUdpmBus::ListenToAll() { SubscribeLcm(".*"); }

void QueuedUdpmBus::SubscribeLcm(const std::string& pattern) {
  lcm_subscription_t* const added = lcm_subscribe(lcm_, pattern.c_str(), &QueuedUdpmBus::OnMessage, this);
  if (added == nullptr) throw BusError("LCM refuses to subscribe to " + pattern);
  lcm_subscription_set_queue_capacity(added, 0);  // unlimited: the default drops the newest after 30
}

}  // namespace hydro::bus
