#include "process/child_lines.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <string_view>
#include <thread>

namespace hydro::process {
namespace {

using namespace std::chrono_literals;
using Got = ChildLines::Got;

class ChildLinesTest : public ::testing::Test {
 protected:
  ChildLinesTest() {
    int ends[2];
    EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
    out_ = ends[0];
    in_ = ends[1];
  }
  ~ChildLinesTest() override {
    CloseIn();
    close(out_);
  }
  void CloseIn() {
    if (in_ >= 0) close(in_);
    in_ = -1;
  }
  void Say(std::string_view text) const {
    ASSERT_EQ(write(in_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  static ChildLines::TimePoint Soon(std::chrono::milliseconds time = 20s) {
    return std::chrono::steady_clock::now() + time;
  }

  int out_ = -1, in_ = -1;
};

// Tests that lines come one by one, in however many pieces they were said, and that the end is told from
// silence.
TEST_F(ChildLinesTest, Lines) {
  ChildLines lines(out_);
  std::string line;
  Say("a banner\nrea");
  EXPECT_EQ(lines.Next(Soon(), &line), Got::kLine);
  EXPECT_EQ(line, "a banner");
  EXPECT_EQ(lines.Next(Soon(1ms), &line), Got::kNothing);
  Say("dy\n\nunfinished");
  EXPECT_EQ(lines.Next(Soon(), &line), Got::kLine);
  EXPECT_EQ(line, "ready");
  EXPECT_EQ(lines.Next(Soon(), &line), Got::kLine);
  EXPECT_EQ(line, "");
  CloseIn();
  EXPECT_EQ(lines.Next(Soon(), &line), Got::kEnd);
}

// Tests that a word is waited for behind other lines, and only as a whole line.
TEST_F(ChildLinesTest, Await) {
  Say("udp box 1.0\nnot ready\nready\n");
  ChildLines lines(out_);
  EXPECT_EQ(lines.Await("ready", Soon()), "");
  Say("already\n");
  EXPECT_EQ(lines.Await("ready", Soon(1ms)), "has not said it in time");
  CloseIn();
  EXPECT_EQ(lines.Await("ready", Soon()), "ended before");
}

// Tests that a line of 10 MB is given up at once, with or without an end.
TEST_F(ChildLinesTest, EndlessLine) {
  std::thread talker([this] {
    const std::string much(10'000'000, 'x');
    static_cast<void>(!write(in_, much.data(), much.size()));
  });
  ChildLines lines(out_);
  EXPECT_EQ(lines.Await("ready", Soon()), "says a line of more than 4096 bytes");
  char text[65536];
  for (size_t got = 0; got < 9'000'000;) got += static_cast<size_t>(read(out_, text, sizeof text));
  CloseIn();
  while (read(out_, text, sizeof text) > 0) {
  }
  talker.join();
}

// Tests that a child which says a byte now and then, or line after line, is not waited for beyond the
// deadline.
TEST_F(ChildLinesTest, DoesNotWaitForAChatterer) {
  for (const std::string_view word : {"x", "not yet\n"}) {
    std::atomic<bool> ended = false;
    std::thread talker([&] {
      fcntl(in_, F_SETFL, O_NONBLOCK);
      while (!ended) {
        static_cast<void>(!write(in_, word.data(), word.size()));
        std::this_thread::sleep_for(1ms);
      }
    });
    ChildLines lines(out_);
    EXPECT_NE(lines.Await("ready", Soon(100ms)), "");
    ended = true;
    talker.join();
  }
}

}  // namespace
}  // namespace hydro::process
