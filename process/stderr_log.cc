#include "process/stderr_log.h"

#include <limits.h>
#include <poll.h>
#include <pthread.h>
#include <spdlog/async.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <string_view>

#include "base/text_file.h"

namespace hydro::process {
namespace {

using namespace std::chrono_literals;

constexpr size_t kMostLines = 256;
constexpr auto kFinalWriteTime = 1s;
constexpr int kRetryPeriod_ms = 50;  // how often a thread that cannot write checks whether to give up

void OnThreadStart() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, nullptr);
  pthread_setname_np(pthread_self(), "stderr_log");
}

}  // namespace

// Unlike spdlog's own sinks, this one can give up, and it escapes control characters.
class StderrLog::Sink : public spdlog::sinks::base_sink<std::mutex> {
 public:
  void GiveUpAt(std::chrono::steady_clock::time_point time) { give_up_ = time; }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t formatted;
    formatter_->format(message, formatted);
    const std::string_view line(formatted.data(), formatted.size());
    Write(Printable(line.substr(0, line.find_last_not_of('\n') + 1)) + "\n");
  }
  void flush_() override {}

 private:
  void Write(std::string_view text) {
    while (!text.empty()) {
      pollfd writable{STDERR_FILENO, POLLOUT, 0};
      const bool last_chance = std::chrono::steady_clock::now() >= give_up_.load();
      if (poll(&writable, 1, last_chance ? 0 : kRetryPeriod_ms) == 0) {
        if (last_chance) return;
        continue;
      }
      // A pipe that polls as writable has room for PIPE_BUF bytes.
      const ssize_t written = write(STDERR_FILENO, text.data(), std::min<size_t>(text.size(), PIPE_BUF));
      if (written >= 0) {
        text.remove_prefix(static_cast<size_t>(written));
      } else if (errno != EINTR && errno != EAGAIN) {
        return;  // the reader has gone
      }
    }
  }

  std::atomic<std::chrono::steady_clock::time_point> give_up_{std::chrono::steady_clock::time_point::max()};
};

StderrLog::StderrLog(const std::string& name) : sink_(std::make_shared<Sink>()) {
  spdlog::init_thread_pool(kMostLines, 1, OnThreadStart);
  spdlog::set_default_logger(std::make_shared<spdlog::async_logger>(
      name, sink_, spdlog::thread_pool(), spdlog::async_overflow_policy::overrun_oldest));
  spdlog::set_pattern("%H:%M:%S.%e %n: %v");
  spdlog::set_level(std::getenv(kQuiet) != nullptr ? spdlog::level::warn : spdlog::level::info);
}

StderrLog::~StderrLog() {
  sink_->GiveUpAt(std::chrono::steady_clock::now() + kFinalWriteTime);
  spdlog::shutdown();  // writes what still waits
}

}  // namespace hydro::process
