#include "process/words.h"

#include <pthread.h>
#include <spdlog/async.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <csignal>

namespace hydro {
namespace {

constexpr size_t kMostLines = 256;

void OnThreadStart() {
  sigset_t all;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, nullptr);
  pthread_setname_np(pthread_self(), "words");
}

}  // namespace

Words::Words(const std::string& name) {
  spdlog::init_thread_pool(kMostLines, 1, OnThreadStart);
  spdlog::set_default_logger(spdlog::create_async_nb<spdlog::sinks::stderr_color_sink_mt>(name));
  spdlog::set_pattern("%H:%M:%S.%e %n: %v");
}

Words::~Words() {
  spdlog::shutdown();  // writes what waits
}

}  // namespace hydro
