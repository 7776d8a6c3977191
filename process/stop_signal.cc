#include "process/stop_signal.h"

#include <csignal>
#include <initializer_list>

namespace hydro::process {
namespace {

volatile std::sig_atomic_t caught_signal = 0;

void Remember(int signal) { caught_signal = signal; }

}  // namespace

void CatchStopSignals() {
  struct sigaction action = {};
  action.sa_handler = Remember;  // without SA_RESTART: a waiting poll returns
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaction(signal, &action, nullptr);
  // A file at its size limit is an error of write(), like a full disk, and does not end the process.
  std::signal(SIGXFSZ, SIG_IGN);
}

int StopSignal() { return caught_signal; }

}  // namespace hydro::process
