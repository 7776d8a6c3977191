#include "base/ring_queue.h"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace hydro {
namespace {

// Tests that it is a queue, even while it grows and wraps around: it behaves like std::deque under random
// use.
TEST(RingQueueTest, IsAQueue) {
  std::mt19937 random(1);
  RingQueue<int> ring(2);
  std::deque<int> reference;
  for (int i = 0; i < 20'000; ++i) {
    // For a while more goes in than comes out, then less: it grows, then wraps.
    const bool put = random() % 100 < (i % 2000 < 1000 ? 60u : 40u);
    if (put || reference.empty()) {
      ring.push_back(i);
      reference.push_back(i);
    } else {
      ring.pop_front();
      reference.pop_front();
    }
    if (i % 5000 == 4999) {
      ring.clear();
      reference.clear();
    }
    ASSERT_EQ(ring.size(), reference.size());
    ASSERT_EQ(ring.empty(), reference.empty());
    if (reference.empty()) continue;
    ASSERT_EQ(ring.front(), reference.front());
    ASSERT_EQ(ring.back(), reference.back());
  }
}

}  // namespace
}  // namespace hydro
