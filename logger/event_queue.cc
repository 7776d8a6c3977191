#include "logger/event_queue.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace hydro::logger {

bool RefusedQuota::Admit(size_t bytes, bus::Clock::TimePoint now) {
  const auto size = static_cast<int64_t>(bytes);
  if (now - begin_ >= std::chrono::seconds(1)) {
    begin_ = now;
    second_messages_ = second_bytes_ = 0;
  }
  if (second_messages_ >= kMessagesPerSecond || second_bytes_ + size > kBytesPerSecond ||
      messages_ >= kMessages || bytes_ + size > kBytes) {
    ++left_out_;
    left_out_bytes_ += size;
    return false;
  }
  ++messages_;
  ++second_messages_;
  bytes_ += size;
  second_bytes_ += size;
  return true;
}

std::string RefusedQuota::Text() const {
  if (left_out_ == 0) return {};
  return fmt::format(
      "{} refused messages ({} bytes) were left out: at most {} and {} KiB a second are recorded, {} and {} "
      "MiB in a run",
      left_out_, left_out_bytes_, kMessagesPerSecond, kBytesPerSecond >> 10, kMessages, kBytes >> 20);
}

namespace {

constexpr size_t kChunkSize = 256u << 10;

struct Header {
  int64_t utime;
  bus::Clock::TimePoint arrived;
  uint32_t channel_size;
  uint32_t size;
};

}  // namespace

EventQueue::EventQueue(size_t limit) : limit_(std::max(limit, kChunkSize)) {
  // Reserved so that the lists of chunks are never reallocated.
  waiting_chunks_.reserve(limit_ / kChunkSize + 1);
  free_.reserve(limit_ / kChunkSize + 1);
}

int64_t EventQueue::Push(std::string_view channel, const void* data, size_t size, int64_t utime,
                         bus::Clock::TimePoint arrived) {
  const size_t needed = sizeof(Header) + channel.size() + size;
  const std::lock_guard lock(mutex_);
  if (waiting_chunks_.empty() || waiting_chunks_.back().size - waiting_chunks_.back().used < needed) {
    if (!MakeRoom(needed)) {
      ++dropped_;
      return 0;
    }
  }
  Chunk& chunk = waiting_chunks_.back();
  uint8_t* to = chunk.bytes.get() + chunk.used;
  const Header header{utime, arrived, static_cast<uint32_t>(channel.size()), static_cast<uint32_t>(size)};
  std::memcpy(to, &header, sizeof header);
  std::memcpy(to + sizeof header, channel.data(), channel.size());
  if (size > 0) std::memcpy(to + sizeof header + channel.size(), data, size);
  chunk.used += needed;
  ++chunk.events;
  return ++waiting_;
}

// Appends an empty chunk with room for `needed` bytes; returns false when the limit forbids it.
bool EventQueue::MakeRoom(size_t needed) {
  if (needed <= kChunkSize && !free_.empty()) {
    waiting_chunks_.push_back(std::move(free_.back()));
    free_.pop_back();
    return true;
  }
  const size_t size = std::max(needed, kChunkSize);
  while (memory_ + size > limit_ && !free_.empty()) {
    memory_ -= free_.back().size;
    free_.pop_back();
  }
  if (memory_ + size > limit_) return false;
  memory_ += size;
  waiting_chunks_.push_back({std::make_unique_for_overwrite<uint8_t[]>(size), size, 0, 0});
  return true;
}

EventQueue::Batch EventQueue::Take() {
  Batch batch;
  batch.queue_ = this;
  batch.chunks_.reserve(limit_ / kChunkSize + 1);
  const std::lock_guard lock(mutex_);
  batch.chunks_.swap(waiting_chunks_);
  return batch;
}

void EventQueue::GiveBack(std::vector<Chunk>* chunks) {
  const std::lock_guard lock(mutex_);
  for (Chunk& chunk : *chunks) {
    waiting_ -= chunk.events;
    if (chunk.size == kChunkSize) {
      chunk.used = 0;
      chunk.events = 0;
      free_.push_back(std::move(chunk));
    } else {
      memory_ -= chunk.size;  // a chunk made for one large event is freed
    }
  }
}

EventQueue::Batch::~Batch() {
  if (queue_ != nullptr && !chunks_.empty()) queue_->GiveBack(&chunks_);
}

size_t EventQueue::Batch::Read(const Chunk& chunk, size_t at, Event* event) {
  Header header;
  const uint8_t* from = chunk.bytes.get() + at;
  std::memcpy(&header, from, sizeof header);
  event->channel = {reinterpret_cast<const char*>(from + sizeof header), header.channel_size};
  event->data = from + sizeof header + header.channel_size;
  event->size = header.size;
  event->utime = header.utime;
  event->arrived = header.arrived;
  return at + sizeof header + header.channel_size + header.size;
}

int64_t EventQueue::waiting() const {
  const std::lock_guard lock(mutex_);
  return waiting_;
}
int64_t EventQueue::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}
size_t EventQueue::memory() const {
  const std::lock_guard lock(mutex_);
  return memory_;
}

}  // namespace hydro::logger
