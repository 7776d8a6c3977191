#include "bus/in_process_bus.h"

#include <algorithm>
#include <utility>

#include "bus/clock.h"

namespace hydro::bus {
namespace {

const WallClock kWallClock;
constexpr size_t kFirstSlots = 16;

}  // namespace

// A waiting message: a typed copy, or bytes when it was published raw or as another type than the channel's.
struct InProcessBus::Slot {
  Channel* channel;
  Slot* next = nullptr;  // the message behind it, or the next idle slot of the channel
  std::shared_ptr<void> message;
  std::vector<uint8_t> bytes;
  bool raw = false;

  [[gnu::cold]] void Create(const MessageType& type) { message = type.create(); }
};

struct InProcessBus::Handler {
  const MessageType* type;
  bool of_channel;                // it has the same type as the channel's typed copies
  std::shared_ptr<void> decoded;  // for raw messages
  std::function<void(const void*)> call;
  std::unique_ptr<Handler> next;
};

struct InProcessBus::Channel {
  std::string name;
  const MessageType* type = nullptr;  // of the typed copies: the type of the first publisher or subscriber
  std::unique_ptr<Handler> handlers;  // in the order of subscription
  const Handler* last = nullptr;      // of them
  std::vector<std::unique_ptr<Slot>> slots;
  Slot* idle = nullptr;  // the first of the slots without a waiting message

  Slot& TakeSlot() {
    if (idle == nullptr) AddSlots();
    return *std::exchange(idle, idle->next);
  }
  void GiveBack(Slot& slot) { slot.next = std::exchange(idle, &slot); }

  [[gnu::cold]] void AddSlots() {
    for (size_t more = std::max(slots.size(), kFirstSlots); more > 0; --more) {
      slots.push_back(std::make_unique<Slot>());
      slots.back()->channel = this;
      GiveBack(*slots.back());
    }
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

InProcessBus::InProcessBus(SimulatedClock* clock)
    : stamps_(clock != nullptr ? static_cast<const Clock*>(clock) : &kWallClock), clock_(clock) {}
InProcessBus::InProcessBus(const Clock& wall) : stamps_(&wall), clock_(nullptr) {}
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
  std::unique_ptr<Handler>* last = &found.handlers;
  while (*last != nullptr) last = &(*last)->next;
  *last = std::make_unique<Handler>(
      Handler{&type, found.type->hash == type.hash, type.create(), std::move(handler), nullptr});
  found.last = last->get();
}

std::shared_ptr<Outlet> InProcessBus::MakeOutlet(const std::string& channel, const MessageType& type) {
  return std::make_shared<ChannelOutlet>(this, &Find(channel), type);
}

void InProcessBus::PublishTyped(const std::string& channel, const MessageType& type, const void* message) {
  Enqueue(Find(channel), type, message);
}

inline void InProcessBus::Append(Slot& slot) {
  slot.next = nullptr;
  (oldest_ == nullptr ? oldest_ : newest_->next) = &slot;
  newest_ = &slot;
}

inline bool InProcessBus::IsHeard(const Channel& channel) const {
  return channel.handlers != nullptr || !taps_.empty();
}

void InProcessBus::Enqueue(Channel& channel, const MessageType& type, const void* message) {
  if (!IsHeard(channel)) return;
  if (channel.type == nullptr) channel.type = &type;
  if (channel.type != &type && channel.type->hash != type.hash) return EnqueueEncoded(channel, type, message);
  Slot& slot = channel.TakeSlot();
  if (slot.message == nullptr) slot.Create(type);
  type.copy(slot.message.get(), message);
  slot.raw = false;
  Append(slot);
}

void InProcessBus::EnqueueEncoded(Channel& channel, const MessageType& type, const void* message) {
  Slot& slot = channel.TakeSlot();
  slot.bytes.resize(type.encoded_size(message));
  type.encode(message, slot.bytes.data(), static_cast<int>(slot.bytes.size()));
  slot.raw = true;
  Append(slot);
}

void InProcessBus::PublishRaw(const std::string& channel, const void* data, int size) {
  Channel& found = Find(channel);
  if (!IsHeard(found)) return;
  Slot& slot = found.TakeSlot();
  const auto* const bytes = static_cast<const uint8_t*>(data);
  slot.bytes.assign(bytes, bytes + size);
  slot.raw = true;
  Append(slot);
}

// Takes the oldest message off the queue.
inline void InProcessBus::Done(Slot& slot) {
  oldest_ = slot.next;
  slot.channel->GiveBack(slot);
}

inline void InProcessBus::Dispatch(const Slot& slot) {
  // A handler that is subscribed meanwhile does not get this message.
  const Handler* const last = slot.channel->last;
  if (!taps_.empty()) ShowTaps(slot);
  if (last == nullptr) return;
  if (slot.raw) return DispatchRaw(slot, *last);
  const void* const message = slot.message.get();
  for (const Handler* handler = slot.channel->handlers.get();; handler = handler->next.get()) {
    if (handler->of_channel) {
      handler->call(message);
    } else {
      ++undecodable_;
    }
    if (handler == last) return;
  }
}

int InProcessBus::HandleUntil(TimePoint deadline) {
  if (handling_) throw std::logic_error("HandleUntil called from a handler");
  if (oldest_ == nullptr) {
    if (clock_ != nullptr) {
      clock_->AdvanceTo(deadline);
    } else {
      SleepUntil(deadline);
    }
    return 0;
  }
  const Slot* const last = newest_;
  int handled = 0;
  handling_ = true;
  for (bool more = true; more; ++handled) {
    Slot& slot = *oldest_;
    more = &slot != last;
    try {
      Dispatch(slot);
    } catch (...) {
      Done(slot);
      handling_ = false;
      throw;
    }
    Done(slot);
  }
  handling_ = false;
  return handled;
}

void InProcessBus::DispatchRaw(const Slot& slot, const Handler& last) {
  const auto size = static_cast<int>(slot.bytes.size());
  for (const Handler* handler = slot.channel->handlers.get();; handler = handler->next.get()) {
    if (handler->type->decode_into(handler->decoded.get(), slot.bytes.data(), size)) {
      handler->call(handler->decoded.get());
    } else {
      ++undecodable_;
    }
    if (handler == &last) return;
  }
}

void InProcessBus::ShowTaps(const Slot& slot) {
  const Channel& channel = *slot.channel;
  const std::vector<uint8_t>* bytes = &slot.bytes;
  if (!slot.raw) {
    encoded_.resize(channel.type->encoded_size(slot.message.get()));
    channel.type->encode(slot.message.get(), encoded_.data(), static_cast<int>(encoded_.size()));
    bytes = &encoded_;
  }
  const RawMessage message{channel.name, bytes->data(), static_cast<int>(bytes->size()), stamps_->Utime()};
  const size_t count = taps_.size();
  for (size_t i = 0; i < count; ++i) taps_[i](message);
}

}  // namespace hydro::bus
