#include "process/stderr_log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <spdlog/spdlog.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <string>

namespace hydro::process {
namespace {

using namespace std::chrono_literals;

// Standard error is a small pipe.
class StderrLogTest : public ::testing::Test {
 protected:
  StderrLogTest() : stderr_(dup(STDERR_FILENO)) {
    EXPECT_EQ(pipe2(pipe_, O_CLOEXEC), 0);
    fcntl(pipe_[1], F_SETPIPE_SZ, 4096);
    dup2(pipe_[1], STDERR_FILENO);
  }
  ~StderrLogTest() override {
    dup2(stderr_, STDERR_FILENO);
    for (const int fd : {stderr_, pipe_[0], pipe_[1]}) close(fd);
  }

  std::string Read() const {
    fcntl(pipe_[0], F_SETFL, O_NONBLOCK);
    std::string text(1 << 16, '\0');
    const ssize_t n = read(pipe_[0], text.data(), text.size());
    text.resize(n > 0 ? static_cast<size_t>(n) : 0);
    return text;
  }

  int stderr_;
  int pipe_[2] = {-1, -1};
};

// Tests that a name from the network cannot send control sequences to the terminal.
TEST_F(StderrLogTest, EscapesControlCharacters) {
  {
    const StderrLog log("hydro-test");
    spdlog::error("from \033[2J\r\nhydro-plant: \xff\xc2\x9b!");
  }
  const std::string line = Read();
  EXPECT_NE(line.find(" hydro-test: from \\x1b[2J\\x0d\\x0ahydro-plant: \\xff\\xc2\\x9b!\n"),
            std::string::npos)
      << line;
}

// Tests that what is no error stays out where hydro-launch --quiet asks for that.
TEST_F(StderrLogTest, Quiet) {
  // A line each, because the small pipe holds no more.
  const auto written = [this](spdlog::level::level_enum level) {
    {
      const StderrLog log("hydro-test");
      spdlog::log(level, "some words");
    }
    return Read().find("some words") != std::string::npos;
  };
  setenv(kQuiet, "1", 1);
  EXPECT_FALSE(written(spdlog::level::info));
  EXPECT_TRUE(written(spdlog::level::warn));
  unsetenv(kQuiet);
  EXPECT_TRUE(written(spdlog::level::info));
}

// Tests that a stopped terminal (nobody reads the pipe) does not keep a process from ending.
TEST_F(StderrLogTest, EndsThoughNobodyReads) {
  const auto start = std::chrono::steady_clock::now();
  {
    const StderrLog log("hydro-test");
    for (int i = 0; i < 100; ++i) spdlog::error("{}", std::string(200, 'x'));
  }
  const auto taken = std::chrono::steady_clock::now() - start;
  EXPECT_GE(taken, 900ms);  // it was given time
  EXPECT_LT(taken, 30s);    // where it waits for ever, the test's time limit ends it
  EXPECT_NE(Read().find("xxx"), std::string::npos);
}

}  // namespace
}  // namespace hydro::process
