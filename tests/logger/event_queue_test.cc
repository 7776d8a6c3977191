#include "logger/event_queue.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>
#include <vector>

namespace hydro::logger {
namespace {

int64_t Push(EventQueue& queue, const std::string& channel, const std::string& data, int64_t utime) {
  return queue.Push(channel, data.data(), data.size(), utime);
}

// Tests that events of all sizes come out as they went in, including empty ones and ones larger than a piece
// of memory.
TEST(EventQueueTest, KeepsEventsAndOrder) {
  EventQueue queue(4u << 20);
  const std::vector<size_t> sizes{0, 1, 128, 300'000, 7, 262'000, 65'000, 0};
  for (size_t i = 0; i < sizes.size(); ++i) {
    const std::string data(sizes[i], static_cast<char>('a' + i));
    EXPECT_EQ(Push(queue, "C" + std::to_string(i), data, static_cast<int64_t>(i)),
              static_cast<int64_t>(i) + 1);
  }
  size_t next = 0;
  queue.Take().ForEach([&](const EventQueue::Event& event) {
    EXPECT_EQ(event.channel, "C" + std::to_string(next));
    EXPECT_EQ(event.utime, static_cast<int64_t>(next));
    EXPECT_EQ(std::string(event.data, event.data + event.size),
              std::string(sizes[next], static_cast<char>('a' + next)));
    ++next;
  });
  EXPECT_EQ(next, sizes.size());
  EXPECT_EQ(queue.waiting(), 0);
  EXPECT_TRUE(queue.Take().empty());
}

// Tests that its memory, including what is being written, never exceeds the limit, that what does not fit is
// counted, and that writing makes room again.
TEST(EventQueueTest, IsBounded) {
  constexpr size_t kLimit = 1u << 20;
  EventQueue queue(kLimit);
  const std::string data(1000, 'x');
  int64_t kept = 0;
  for (int i = 0; i < 3000; ++i) kept += Push(queue, "CHANNEL", data, i) > 0 ? 1 : 0;
  EXPECT_LE(queue.memory(), kLimit);
  EXPECT_GT(kept, 900);
  EXPECT_EQ(queue.dropped(), 3000 - kept);
  {
    const EventQueue::Batch writing = queue.Take();
    EXPECT_EQ(Push(queue, "CHANNEL", data, 1), 0);  // not before the batch is written
    EXPECT_EQ(queue.waiting(), kept);
    int64_t next = 0;
    writing.ForEach(
        [&](const EventQueue::Event& event) { EXPECT_EQ(event.utime, next++); });  // the newest were left out
    EXPECT_EQ(next, kept);
  }
  EXPECT_EQ(queue.waiting(), 0);
  EXPECT_EQ(Push(queue, "CHANNEL", data, 1), 1);
  EXPECT_EQ(Push(queue, "CHANNEL", std::string(2 * kLimit, 'x'), 1), 0);  // larger than all of it
  EXPECT_EQ(Push(queue, "CHANNEL", data, 1), 2);
  EXPECT_LE(queue.memory(), kLimit);
}

// Tests that one thread may write while another receives: all that was taken arrives once and in order.
TEST(EventQueueTest, TwoThreads) {
  EventQueue queue(8u << 20);
  constexpr int64_t kEvents = 50'000;
  std::vector<int64_t> seen;
  std::thread writer([&] {
    while (seen.empty() || seen.back() < kEvents - 1) {
      queue.Take().ForEach([&](const EventQueue::Event& event) { seen.push_back(event.utime); });
    }
  });
  for (int64_t i = 0; i < kEvents;) {
    if (Push(queue, "CHANNEL", "some data", i) > 0) ++i;
  }
  writer.join();
  ASSERT_EQ(seen.size(), static_cast<size_t>(kEvents));
  for (int64_t i = 0; i < kEvents; ++i) ASSERT_EQ(seen[static_cast<size_t>(i)], i);
}

}  // namespace
}  // namespace hydro::logger
