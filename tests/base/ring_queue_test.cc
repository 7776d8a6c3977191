#include "base/ring_queue.h"

#include <gtest/gtest.h>

#include <deque>
#include <random>
#include <string>

#include "base/bytes.h"

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

struct Words {
  double number;
  int64_t whole;
  int8_t first, second;
};

// Tests that a copy is one: of words and parts of words, and of what is more than words.
TEST(CopyWordsTest, CopiesAll) {
  Words to{};
  CopyFresh(&to, Words{0.5, -7, 1, -2});
  EXPECT_EQ(to.number, 0.5);
  EXPECT_EQ(to.whole, -7);
  EXPECT_EQ(to.first, 1);
  EXPECT_EQ(to.second, -2);
  std::string text = "short";
  CopyFresh(&text, std::string(100, 'x'));
  EXPECT_EQ(text, std::string(100, 'x'));
}

}  // namespace

}  // namespace hydro
