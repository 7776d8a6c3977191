#include "sim/limb/telemetry.h"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "base/bytes.h"
#include "bus/channels.h"

namespace hydro::limb {
namespace {

constexpr size_t kFirstCapacity = 256;
// The most messages that wait: one second of all that a large limb sends in between.
constexpr size_t kMostWaiting = 1 << 14;

template <class Message, class... Others>
consteval bool IsOneOf() {
  return (std::is_same_v<Message, Others> || ...);
}

template <class Message>
constexpr Passage PassageOfType() {
  if (bus::RowOf<Message>().part != bus::LoopPart::kNone) return Passage::kSampled;
  if (IsOneOf<Message, fault_t, active_faults_t, stop_t, output_left_t, rearm_t, process_status_t,
              tuning_answer_t>()) {
    return Passage::kAtOnce;
  }
  if (IsOneOf<Message, tuning_request_t, arm_plan_t, log_progress_t, introduction_t, configuration_t>()) {
    return Passage::kNever;
  }
  return Passage::kInBetween;
}

// Every field before this one in a state takes eight bytes (bus/messages.h).
constexpr int kSkippedPlace = 8 + static_cast<int>(offsetof(state_t, skipped_ticks));

int64_t NumberAt(const bus::RawMessage& message, int place) {
  return place >= 0 && message.size >= place + 8 ? static_cast<int64_t>(LoadBigEndian64(message.data + place))
                                                 : -1;
}

}  // namespace

Telemetry::Telemetry(bus::Bus& out, int64_t interval)
    : out_(out), interval_(interval), queue_(kFirstCapacity) {}

void Telemetry::Add(bus::Bus& joint, const std::string& suffix, int64_t phase,
                    std::function<bool(int64_t session)> is_own) {
  Stack& stack = *stacks_.emplace_back(std::make_unique<Stack>());
  stack.phase = phase;
  stack.is_own = std::move(is_own);
  const bus::Channels channels(suffix);
  bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>& row) {
    stack.channels.push_back(
        {channels.Of<Message>(), row.part, PassageOfType<Message>(), bus::PlacesOf<Message>()});
  });
  joint.SubscribeAll([this, &stack](const bus::RawMessage& message) { OnMessage(stack, message); });
}

void Telemetry::OnMessage(Stack& stack, const bus::RawMessage& message) {
  const auto channel = std::find_if(stack.channels.begin(), stack.channels.end(),
                                    [&](const Channel& one) { return one.name == message.channel; });
  if (channel == stack.channels.end()) return;
  switch (channel->passage) {
    case Passage::kSampled:
      OnSample(stack, *channel, message);
      return;
    case Passage::kAtOnce:
      // A message that came from outside is not sent back.
      if (stack.is_own(NumberAt(message, channel->places.session))) {
        out_.PublishRaw(channel->name, message.data, message.size);
      }
      return;
    case Passage::kInBetween:
      if (!stack.is_own(NumberAt(message, channel->places.session))) return;
      Enqueue(*channel, message.data, static_cast<size_t>(message.size));
      return;
    case Passage::kNever:
      return;
  }
}

// The states in between are not missing, so the messages that go out get new sequence numbers, because
// receivers look for gaps. A state reports all ticks that were skipped since the state sent before it.
void Telemetry::OnSample(const Stack& stack, Channel& channel, const bus::RawMessage& message) {
  if (channel.part == bus::LoopPart::kState)
    channel.skipped += std::max<int64_t>(0, NumberAt(message, kSkippedPlace));
  const int64_t slot = (NumberAt(message, channel.places.tick) + stack.phase) / interval_;
  const auto size = static_cast<size_t>(message.size);
  if (interval_ > 1 && slot == channel.slot) {
    channel.newest.assign(message.data, message.data + size);
    return;
  }
  channel.slot = slot;
  channel.newest.clear();
  Sample(channel, message.data, size);
}

void Telemetry::Sample(Channel& channel, const uint8_t* data, size_t size) {
  std::vector<uint8_t>* const bytes = Enqueue(channel, data, size);
  if (bytes == nullptr) return;
  StoreBigEndian64(static_cast<uint64_t>(channel.sequence++), bytes->data() + channel.places.sequence);
  if (channel.part != bus::LoopPart::kState) return;
  StoreBigEndian64(static_cast<uint64_t>(std::exchange(channel.skipped, 0)), bytes->data() + kSkippedPlace);
}

void Telemetry::PassAll() {
  interval_ = 1;
  for (auto& stack : stacks_) {
    for (Channel& channel : stack->channels) {
      if (!channel.newest.empty()) Sample(channel, channel.newest.data(), channel.newest.size());
      channel.newest.clear();
    }
  }
}

std::vector<uint8_t>* Telemetry::Enqueue(const Channel& channel, const uint8_t* data, size_t size) {
  if (waiting() == queue_.size()) {
    if (queue_.size() >= kMostWaiting) {
      ++left_out_;
      return nullptr;
    }
    std::vector<Waiting> larger(2 * queue_.size());
    for (size_t i = 0; i < waiting(); ++i) larger[i] = std::move(queue_[(first_ + i) & (queue_.size() - 1)]);
    end_ -= first_;
    first_ = 0;
    queue_ = std::move(larger);
  }
  Waiting& slot = queue_[end_++ & (queue_.size() - 1)];
  slot.channel = &channel;
  slot.bytes.assign(data, data + size);
  return &slot.bytes;
}

void Telemetry::Send(const std::function<bool()>& goes_on) {
  while (first_ != end_) {
    const Waiting& next = queue_[first_ & (queue_.size() - 1)];
    out_.PublishRaw(next.channel->name, next.bytes.data(), static_cast<int>(next.bytes.size()));
    ++first_;
    if (!goes_on()) return;
  }
}

void Telemetry::SendAll() {
  Send([] { return true; });
}

}  // namespace hydro::limb
