#include "bus/in_process_bus.h"

#include <deque>

#include "bus/sleep_until.h"

namespace hydro::bus {
namespace {

constexpr size_t kFirstCapacity = 16;

// A waiting message: a typed copy, or bytes when it was published raw or as another type than the channel's.
struct Slot {
  std::shared_ptr<void> message;
  std::vector<uint8_t> bytes;
  bool raw = false;
};

struct Handler {
  const MessageType* type;
  std::shared_ptr<void> decoded;  // for raw messages
  std::function<void(const void*)> call;
};

}  // namespace

struct InProcessBus::Channel {
  std::string name;
  const MessageType* type = nullptr;  // of the slots' typed copies: that of the first publisher or subscriber
  std::deque<Handler> handlers;       // a handler may subscribe: existing ones stay in place
  std::vector<std::unique_ptr<Slot>> slots;  // ring, size a power of 2
  size_t first = 0;
  size_t end = 0;

  Slot& Append() {
    if (end - first == slots.size()) Grow();
    return *slots[end++ & (slots.size() - 1)];
  }

  Slot& Oldest() { return *slots[first & (slots.size() - 1)]; }

  // Slots stay in place in memory, because a handler may hold one of them.
  void Grow() {
    std::vector<std::unique_ptr<Slot>> larger(slots.empty() ? kFirstCapacity : 2 * slots.size());
    for (size_t i = 0; i < slots.size(); ++i) larger[i] = std::move(slots[(first + i) & (slots.size() - 1)]);
    for (std::unique_ptr<Slot>& slot : larger) {
      if (slot == nullptr) slot = std::make_unique<Slot>();
    }
    end -= first;
    first = 0;
    slots = std::move(larger);
  }
};

class InProcessBus::ChannelOutlet : public Outlet {
 public:
  ChannelOutlet(InProcessBus* bus, Channel* channel, const MessageType& type)
      : bus_(bus), channel_(channel), type_(type) {}
  void Send(const void* message) override { bus_->Enqueue(*channel_, type_, message); }

 private:
  InProcessBus* bus_;
  Channel* channel_;
  const MessageType& type_;
};

InProcessBus::InProcessBus(SimulatedClock* clock) : clock_(clock), order_(kFirstCapacity) {}
InProcessBus::~InProcessBus() = default;

InProcessBus::Channel& InProcessBus::Find(const std::string& name) {
  Channel*& recent = recent_[(reinterpret_cast<uintptr_t>(&name) / sizeof(std::string)) % recent_.size()];
  if (recent == nullptr || recent->name != name) {
    std::unique_ptr<Channel>& channel = channels_[name];
    if (channel == nullptr) {
      channel = std::make_unique<Channel>();
      channel->name = name;
    }
    recent = channel.get();
  }
  return *recent;
}

void InProcessBus::SubscribeAll(std::function<void(const RawMessage&)> handler) {
  taps_.push_back(std::move(handler));
}

void InProcessBus::SubscribeTyped(const std::string& channel, const MessageType& type,
                                  std::function<void(const void*)> handler) {
  Channel& found = Find(channel);
  if (found.type == nullptr) found.type = &type;
  found.handlers.push_back({&type, type.create(), std::move(handler)});
}

std::shared_ptr<Outlet> InProcessBus::MakeOutlet(const std::string& channel, const MessageType& type) {
  return std::make_shared<ChannelOutlet>(this, &Find(channel), type);
}

void InProcessBus::PublishTyped(const std::string& channel, const MessageType& type, const void* message) {
  Enqueue(Find(channel), type, message);
}

void InProcessBus::Enqueue(Channel& channel, const MessageType& type, const void* message) {
  if (channel.handlers.empty() && taps_.empty()) return;
  if (channel.type == nullptr) channel.type = &type;
  Slot& slot = channel.Append();
  if (channel.type->hash == type.hash) {
    if (slot.message == nullptr) slot.message = type.create();
    type.copy(slot.message.get(), message);
    slot.raw = false;
  } else {
    slot.bytes.resize(type.encoded_size(message));
    type.encode(message, slot.bytes.data(), static_cast<int>(slot.bytes.size()));
    slot.raw = true;
  }
  Order(&channel);
}

void InProcessBus::PublishRaw(const std::string& channel, const void* data, int size) {
  Channel& found = Find(channel);
  if (found.handlers.empty() && taps_.empty()) return;
  Slot& slot = found.Append();
  const auto* const bytes = static_cast<const uint8_t*>(data);
  slot.bytes.assign(bytes, bytes + size);
  slot.raw = true;
  Order(&found);
}

void InProcessBus::Order(Channel* channel) {
  if (end_ - first_ == order_.size()) {
    std::vector<Channel*> larger(2 * order_.size());
    for (size_t i = 0; i < order_.size(); ++i) larger[i] = order_[(first_ + i) & (order_.size() - 1)];
    end_ -= first_;
    first_ = 0;
    order_ = std::move(larger);
  }
  order_[end_++ & (order_.size() - 1)] = channel;
}

int InProcessBus::HandleUntil(TimePoint deadline) {
  if (handling_) throw std::logic_error("HandleUntil called from a handler");
  if (first_ == end_) {
    if (clock_ != nullptr) {
      clock_->AdvanceTo(deadline);
    } else {
      SleepUntil(deadline);
    }
    return 0;
  }
  // Takes the message off both queues when its handlers are done with it, also when one of them throws.
  struct Turn {
    InProcessBus* bus;
    Channel* channel;
    Turn(InProcessBus* b, Channel* c) : bus(b), channel(c) { bus->handling_ = true; }
    ~Turn() {
      ++channel->first;
      ++bus->first_;
      bus->handling_ = false;
    }
  };
  const size_t waiting = end_ - first_;
  for (size_t i = 0; i < waiting; ++i) {
    const Turn turn(this, order_[first_ & (order_.size() - 1)]);
    Dispatch(*turn.channel);
  }
  return static_cast<int>(waiting);
}

void InProcessBus::Dispatch(Channel& channel) {
  Slot& slot = channel.Oldest();
  if (!taps_.empty()) {
    const std::vector<uint8_t>* bytes = &slot.bytes;
    if (!slot.raw) {
      encoded_.resize(channel.type->encoded_size(slot.message.get()));
      channel.type->encode(slot.message.get(), encoded_.data(), static_cast<int>(encoded_.size()));
      bytes = &encoded_;
    }
    const RawMessage message{channel.name, bytes->data(), static_cast<int>(bytes->size()),
                             clock_ != nullptr ? clock_->Utime() : WallClock().Utime()};
    for (size_t i = 0; i < taps_.size(); ++i) taps_[i](message);
  }
  for (size_t i = 0; i < channel.handlers.size(); ++i) {
    Handler& handler = channel.handlers[i];
    if (!slot.raw && handler.type->hash == channel.type->hash) {
      handler.call(slot.message.get());
    } else if (slot.raw && handler.type->decode_into(handler.decoded.get(), slot.bytes.data(),
                                                     static_cast<int>(slot.bytes.size()))) {
      handler.call(handler.decoded.get());
    } else {
      ++undecodable_;
    }
  }
}

}  // namespace hydro::bus
