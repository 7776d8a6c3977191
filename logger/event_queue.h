// The queue between a logger's receiving and its writing thread, and how much of it refused messages may be.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "bus/clock.h"

namespace hydro::logger {

// Limits how many refused messages (docs/security.md) are recorded: an intruder must not fill the disk.
// Admits the first messages of each second, and of the run, up to a number and a size; counts the rest.
class RefusedQuota {
 public:
  static constexpr int64_t kMessagesPerSecond = 1000;
  static constexpr int64_t kBytesPerSecond = 256 << 10;
  static constexpr int64_t kMessages = 20000;
  static constexpr int64_t kBytes = 8 << 20;

  static bool IsRefused(std::string_view channel) { return channel.starts_with("REFUSED_"); }

  // Returns whether a refused message that came at `now` is to be recorded; counts it if not.
  bool Admit(size_t bytes, bus::Clock::TimePoint now);

  int64_t left_out() const { return left_out_; }
  // One line about what was left out; empty when nothing was.
  std::string Text() const;

 private:
  int64_t messages_ = 0, bytes_ = 0;                // recorded so far
  int64_t second_messages_ = 0, second_bytes_ = 0;  // in the second that began at begin_
  bus::Clock::TimePoint begin_{};
  int64_t left_out_ = 0, left_out_bytes_ = 0;
};

// Received events that wait to be written. Never holds more memory than its limit. When the disk is slower
// than the bus for longer than that memory lasts, new events are refused and counted. Memory is allocated in
// chunks as needed and reused.
class EventQueue {
 public:
  // `limit` is in bytes, including what is being written; at least one chunk.
  explicit EventQueue(size_t limit);

  struct Event {
    std::string_view channel;
    const uint8_t* data = nullptr;
    size_t size = 0;
    int64_t utime = 0;
    bus::Clock::TimePoint arrived{};  // monotonic, unaffected by changes of utime's clock
  };

  // Copies the event and returns the number of events that now wait; 0 when there was no room and the event
  // was counted as dropped.
  int64_t Push(std::string_view channel, const void* data, size_t size, int64_t utime,
               bus::Clock::TimePoint arrived = {});

  int64_t waiting() const;  // events that were pushed and not yet written
  int64_t dropped() const;
  size_t memory() const;  // bytes allocated now

  // Events taken from the queue, in order. Its destructor returns the memory to the queue.
  class Batch {
   public:
    Batch() = default;
    Batch(Batch&& other) noexcept = default;
    Batch& operator=(Batch&&) = delete;
    ~Batch();

    bool empty() const { return chunks_.empty(); }
    // Calls `use(event)` for each event.
    template <class Use>
    void ForEach(Use&& use) const {
      for (const Chunk& chunk : chunks_) {
        for (size_t at = 0; at < chunk.used;) {
          Event event;
          at = Read(chunk, at, &event);
          use(event);
        }
      }
    }

   private:
    friend class EventQueue;
    struct Chunk {
      std::unique_ptr<uint8_t[]> bytes;
      size_t size = 0;
      size_t used = 0;
      int64_t events = 0;
    };
    static size_t Read(const Chunk& chunk, size_t at, Event* event);

    EventQueue* queue_ = nullptr;
    std::vector<Chunk> chunks_;
  };

  // Takes all events that wait now, possibly none. One batch at a time.
  Batch Take();

 private:
  using Chunk = Batch::Chunk;
  bool MakeRoom(size_t needed);
  void GiveBack(std::vector<Chunk>* chunks);

  const size_t limit_;
  mutable std::mutex mutex_;  // guards all below
  std::vector<Chunk> waiting_chunks_;
  std::vector<Chunk> free_;
  size_t memory_ = 0;
  int64_t waiting_ = 0;
  int64_t dropped_ = 0;
};

}  // namespace hydro::logger
