// Starts a program as a child that does not outlive this process.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

namespace hydro::process {

struct SpawnRequest {
  std::vector<std::string> argv;  // argv[0] is the path of the program
  // "NAME=value"; absent: this process's environment.
  std::optional<std::vector<std::string>> environment = std::nullopt;
  std::string folder = {};          // working folder; empty: this process's
  int in = -1, out = -1, err = -1;  // its descriptors 0, 1, 2; -1: nothing to read, and this process's output
  int cpu = -1;                     // processor to run on; -1: any
  int priority = 0;                 // SCHED_FIFO priority 1..99; 0: ordinary scheduling
};

struct Spawned {
  pid_t pid = -1;
  std::vector<std::string> warnings;  // one line each if the system refuses cpu or priority
};

// Starts the program in its own process group (a terminal's Ctrl-C does not reach it), with all signals
// unblocked. The kernel sends it SIGTERM when the calling thread ends, however that happens. The program
// ignores SIGPIPE, so that a line which it prints on its way out after that does not kill it. Throws
// StartError.
Spawned Spawn(const SpawnRequest& request);

// Why there is no process, pipe or file, of such a call's errno: "Too many open files: 12 are allowed, allow
// more with `ulimit -n`".
std::string ReasonOf(int error);

}  // namespace hydro::process
