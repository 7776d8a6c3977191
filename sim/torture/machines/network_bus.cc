#include "sim/torture/machines/network_bus.h"

#include <utility>

#include "bus/clock.h"

namespace hydro::torture {
namespace {

constexpr int kMostPerCall = 4096;           // as in UdpmBus
constexpr size_t kReceiveBuffer = 2u << 20;  // bytes
constexpr size_t kPacketOverhead = 256;      // bytes that the kernel counts in addition

}  // namespace

// A channel whose number is known.
class NetworkBus::ChannelOutlet : public bus::Outlet {
 public:
  ChannelOutlet(NetworkBus* bus, int channel, const bus::MessageType& type)
      : bus_(bus), channel_(channel), type_(type) {}
  void Send(const void* message) override { bus_->SendTyped(channel_, type_, message); }

 private:
  NetworkBus* bus_;
  int channel_;
  const bus::MessageType& type_;
};

int NetworkBus::Number(const std::string& channel) {
  const auto found = numbers_.find(channel);
  if (found != numbers_.end()) return found->second;
  return numbers_[channel] = port_.ChannelNumber(channel);
}

void NetworkBus::SubscribeAll(std::function<void(const bus::RawMessage&)> handler) {
  taps_.push_back(std::move(handler));
}

void NetworkBus::SubscribeTyped(const std::string& channel, const bus::MessageType& type,
                                std::function<void(const void*)> handler) {
  const auto number = static_cast<size_t>(Number(channel));
  if (typed_.size() <= number) typed_.resize(number + 1);
  typed_[number].push_back({&type, type.create(), std::move(handler)});
}

std::shared_ptr<bus::Outlet> NetworkBus::MakeOutlet(const std::string& channel,
                                                    const bus::MessageType& type) {
  return std::make_shared<ChannelOutlet>(this, Number(channel), type);
}

void NetworkBus::PublishTyped(const std::string& channel, const bus::MessageType& type, const void* message) {
  SendTyped(Number(channel), type, message);
}

void NetworkBus::SendTyped(int channel, const bus::MessageType& type, const void* message) {
  if (!connected_) return;
  PacketPtr packet = port_.NewPacket();
  const int size = type.encoded_size(message);
  packet->bytes.resize(static_cast<size_t>(size));
  if (type.encode(message, packet->bytes.data(), size) != size) {
    throw bus::BusError("a message for " + port_.ChannelName(channel) + " cannot be encoded");
  }
  if (authenticator_ != nullptr) {
    const int sealed = authenticator_->Seal(port_.ChannelName(channel), &packet->bytes, size);
    packet->bytes.resize(static_cast<size_t>(sealed));
  }
  packet->channel = channel;
  packet->sender = number_;
  packet->origin = Origin::kProcess;
  port_.Send(std::move(packet), number_);
}

void NetworkBus::PublishRaw(const std::string& channel, const void* data, int size) {
  if (!connected_) return;
  PacketPtr packet = port_.NewPacket();
  const auto* const bytes = static_cast<const uint8_t*>(data);
  packet->bytes.assign(bytes, bytes + size);
  packet->channel = Number(channel);
  packet->sender = number_;
  packet->origin = Origin::kProcess;
  port_.Send(std::move(packet), number_);
}

void NetworkBus::Arrive(PacketPtr packet) {
  const size_t size = packet->bytes.size() + kPacketOverhead;
  if (inbox_bytes_ + size > kReceiveBuffer) return;
  inbox_bytes_ += size;
  inbox_.push_back(std::move(packet));
}

int NetworkBus::HandleUntil(TimePoint deadline) {
  if (handling_) throw std::logic_error("HandleUntil called from a handler");
  struct Marked {
    bool& flag;
    explicit Marked(bool& f) : flag(f) { flag = true; }
    ~Marked() { flag = false; }
  };
  const Marked marked(handling_);
  if (authenticator_ != nullptr && !introduced_) {
    introduced_ = true;
    Introduce(authenticator_->Greeting());
  }
  int handled = 0;
  for (int seen = 0; seen < kMostPerCall; ++seen) {
    if (inbox_.empty() && (handled > 0 || !waiter_.WaitUntil(deadline))) break;
    if (inbox_.empty()) break;
    const PacketPtr packet = std::move(inbox_.front());
    inbox_.pop_front();
    inbox_bytes_ -= packet->bytes.size() + kPacketOverhead;
    const int64_t undecodable = undecodable_;
    Deliver(*packet);
    if (undecodable_ == undecodable) ++handled;
  }
  return handled;
}

void NetworkBus::Deliver(const Packet& packet) {
  int size = static_cast<int>(packet.bytes.size());
  if (authenticator_ != nullptr) {
    const std::optional<int> visible = Authenticate(packet);
    if (!visible) return;
    size = *visible;
  }
  port_.Handled(packet, number_);
  if (!taps_.empty()) {
    const bus::RawMessage raw{port_.ChannelName(packet.channel), packet.bytes.data(), size, clock_.Utime()};
    for (size_t i = 0; i < taps_.size(); ++i) taps_[i](raw);
  }
  if (static_cast<size_t>(packet.channel) >= typed_.size()) return;
  const size_t count = typed_[static_cast<size_t>(packet.channel)].size();
  for (size_t i = 0; i < count; ++i) {
    Subscription& subscription = typed_[static_cast<size_t>(packet.channel)][i];
    if (subscription.type->decode_into(subscription.message.get(), packet.bytes.data(), size)) {
      subscription.call(subscription.message.get());
    } else {
      ++undecodable_;
      undecodable_channel_ = port_.ChannelName(packet.channel);
    }
  }
}

// Authenticated messages are handled as UdpmBus does (bus/udpm/udpm_authentication.cc), except for what only
// a recorder needs.
void NetworkBus::UseKey(std::unique_ptr<bus::Authenticator> authenticator) {
  authenticator_ = std::move(authenticator);
  refused_ = &authenticator_->refused();
  introductions_ = Number(authenticator_->introduction_channel());
}

void NetworkBus::Introduce(introduction_t introduction) {
  introduction.utime = clock_.Utime();
  SendTyped(introductions_, bus::TypeOf<introduction_t>(), &introduction);
}

std::optional<int> NetworkBus::Authenticate(const Packet& packet) {
  using Verdict = bus::Authenticator::Verdict;
  const auto now = clock_.Now();
  const int size = static_cast<int>(packet.bytes.size());
  const bus::Authenticator::Opened opened =
      authenticator_->Open(port_.ChannelName(packet.channel), packet.bytes.data(), size, now);
  if (opened.verdict == Verdict::kPlain) return opened.size;
  if (opened.verdict != Verdict::kRefused && packet.channel == introductions_) {
    introduction_t introduction;
    if (introduction.decode(packet.bytes.data(), 0, opened.size) != opened.size) return std::nullopt;
    bool admitted = false;
    if (const auto answer = authenticator_->Hear(introduction, opened, &admitted)) Introduce(*answer);
    return std::nullopt;
  }
  if (opened.verdict == Verdict::kAccepted) return opened.size;
  if (opened.session != 0) {
    if (const auto question = authenticator_->Ask(opened.session, now)) Introduce(*question);
  }
  return std::nullopt;
}

}  // namespace hydro::torture
