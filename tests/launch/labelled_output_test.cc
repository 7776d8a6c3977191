#include "launch/labelled_output.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <limits.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string>

namespace hydro::launch {
namespace {

using Stream = LabelledOutput::Stream;

class LabelledOutputTest : public ::testing::Test {
 protected:
  LabelledOutputTest() {
    EXPECT_EQ(pipe2(pipe_, O_CLOEXEC), 0);
    fcntl(pipe_[0], F_SETFL, O_NONBLOCK);
  }
  ~LabelledOutputTest() override {
    if (pipe_[0] >= 0) close(pipe_[0]);
    close(pipe_[1]);
  }
  std::string Read() {
    std::string text(1 << 20, '\0');
    const ssize_t n = read(pipe_[0], text.data(), text.size());
    text.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return text;
  }

  int pipe_[2] = {-1, -1};
};

// Tests that labels are aligned and that lines leave in the order of arrival, across both streams.
TEST_F(LabelledOutputTest, AlignsAndKeepsOrder) {
  LabelledOutput output(pipe_[1], pipe_[1], false);
  output.AnnounceLabel("plant");
  output.AnnounceLabel("position_ctrl");
  output.Line(Stream::kOut, "plant", "one");
  output.Line(Stream::kErr, "position_ctrl", "two");
  output.Line(Stream::kOut, "plant", "");
  output.Flush();
  EXPECT_EQ(Read(), "[plant]         one\n[position_ctrl] two\n[plant]         \n");
  EXPECT_EQ(output.waiting_fd(), -1);
}

// Tests that a line longer than one write is finished before the other stream's line begins.
TEST_F(LabelledOutputTest, LinesOfTwoStreamsDoNotMix) {
  LabelledOutput output(pipe_[1], pipe_[1], false);
  const std::string longer(3 * PIPE_BUF, 'o');
  output.Line(Stream::kOut, "a", longer);
  output.Line(Stream::kErr, "b", "short");
  output.Line(Stream::kOut, "a", longer);
  output.Flush();
  EXPECT_EQ(Read(), "[a] " + longer + "\n[b] short\n[a] " + longer + "\n");
}

// Tests that a full disk is told from a reader that has gone, and from one of the other stream.
TEST_F(LabelledOutputTest, KnowsWhatIsLost) {
  const int full = open("/dev/full", O_WRONLY | O_CLOEXEC);
  LabelledOutput good(pipe_[1], full, false);
  good.Line(Stream::kOut, "a", "one");
  good.Line(Stream::kErr, "a", "two");
  good.Flush();
  EXPECT_EQ(good.lost(), 0);
  LabelledOutput lost(full, pipe_[1], false);
  lost.Line(Stream::kOut, "a", "one");
  lost.Flush();
  EXPECT_EQ(lost.lost(), ENOSPC);
  signal(SIGPIPE, SIG_IGN);
  close(pipe_[0]);
  pipe_[0] = -1;
  LabelledOutput gone(pipe_[1], pipe_[1], false);
  gone.Line(Stream::kOut, "a", "one");
  gone.Flush();
  EXPECT_EQ(gone.lost(), 0);
  close(full);
}

// Tests that text from the network can neither control the terminal nor pass for another process's line.
TEST_F(LabelledOutputTest, EscapesControlCharacters) {
  LabelledOutput output(pipe_[1], pipe_[1], false);
  output.Line(Stream::kOut, "a", "\033[2Jx\n[b] y");
  output.Flush();
  EXPECT_EQ(Read(), "[a] \\x1b[2Jx\\x0a[b] y\n");
}

// Tests that the status stays below all other lines, and is drawn anew only where it changed.
TEST_F(LabelledOutputTest, StatusStaysBelow) {
  LabelledOutput output(pipe_[1], pipe_[1], false);
  output.SetStatus({"one", "two"});
  output.SetStatus({"one", "two"});
  output.Flush();
  EXPECT_EQ(Read(), "one\ntwo\n");
  output.Line(Stream::kErr, "a", "text");
  output.Flush();
  EXPECT_EQ(Read(), "\033[2A\033[J[a] text\none\ntwo\n");
  output.SetStatus({"three"});
  output.SetStatus({});
  output.Line(Stream::kOut, "a", "end");
  output.Flush();
  EXPECT_EQ(Read(), "\033[2A\033[Jthree\n\033[1A\033[J[a] end\n");
}

TEST_F(LabelledOutputTest, QuietAndJson) {
  LabelledOutput quiet(pipe_[1], pipe_[1], false);
  quiet.set_quiet();
  quiet.SetStatus({"one"});
  quiet.Line(Stream::kOut, "a", "all is well");
  quiet.Line(Stream::kErr, "a", "it is not");
  quiet.Flush();
  EXPECT_EQ(Read(), "[a] it is not\n");
  LabelledOutput json(pipe_[1], pipe_[1], false);
  json.set_json();
  json.SetStatus({"one"});
  json.Line(Stream::kErr, "a", "say \"no\"\033");
  json.Json(R"({"exit_code":0})");
  json.Flush();
  EXPECT_EQ(Read(), R"({"source":"a","stream":"err","text":"say \"no\"\\x1b"})"
                    "\n"
                    R"({"exit_code":0})"
                    "\n");
}

// Tests that a child that prints what is not UTF-8, a surrogate here, does not end the launcher: a line of
// JSON says which bytes.
TEST_F(LabelledOutputTest, WhatIsNoUtf8StaysJson) {
  LabelledOutput output(pipe_[1], pipe_[1], false);
  output.set_json();
  output.Line(Stream::kOut, "pid.py", "\xed\xa0\x80 \xc0\xaf \xc3\xa4");
  output.Line(Stream::kOut, "\xff", "");
  output.Flush();
  EXPECT_EQ(Read(),
            "{\"source\":\"pid.py\",\"stream\":\"out\",\"text\":\"\\\\xed\\\\xa0\\\\x80 \\\\xc0\\\\xaf "
            "\xc3\xa4\"}\n"
            "{\"source\":\"\xef\xbf\xbd\",\"stream\":\"out\",\"text\":\"\"}\n");
}

// Tests that colours surround the label only.
TEST_F(LabelledOutputTest, ColoursTheLabel) {
  LabelledOutput output(pipe_[1], pipe_[1], true);
  output.Line(Stream::kOut, "plant", "text");
  output.Flush();
  const std::string text = Read();
  EXPECT_EQ(text.substr(0, 3), "\033[3");
  EXPECT_NE(text.find("m[plant]\033[0m text\n"), std::string::npos) << text;
}

// Tests that full() is true while much text waits, and false once it is written.
TEST_F(LabelledOutputTest, IsFullUntilWritten) {
  const int null = open("/dev/null", O_WRONLY | O_CLOEXEC);
  LabelledOutput output(null, null, false);
  for (int i = 0; i < 2000; ++i) output.Line(Stream::kOut, "plant", std::string(1000, 'x'));
  EXPECT_TRUE(output.full());
  output.Flush();
  EXPECT_FALSE(output.full());
  close(null);
}

// Tests that a reader that has gone neither ends this process nor blocks the output.
TEST_F(LabelledOutputTest, SurvivesAReaderThatIsGone) {
  signal(SIGPIPE, SIG_IGN);
  LabelledOutput output(pipe_[1], pipe_[1], false);
  close(pipe_[0]);
  pipe_[0] = -1;
  output.Line(Stream::kOut, "plant", "nobody hears this");
  output.Flush();
  EXPECT_EQ(output.waiting_fd(), -1);
}

}  // namespace
}  // namespace hydro::launch
