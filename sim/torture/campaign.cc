#include "sim/torture/campaign.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <new>

#include "base/new_file.h"
#include "base/output_folder.h"
#include "process/stop_signal.h"

namespace hydro::torture {
namespace {

using Clock = std::chrono::steady_clock;

struct Child {
  pid_t pid = -1;
  int pipe = -1;
  std::string report;
};

// Memory that stays shared across a fork.
WorkerState* SharedStates(int count) {
  void* memory = mmap(nullptr, sizeof(WorkerState) * static_cast<size_t>(count), PROT_READ | PROT_WRITE,
                      MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  return static_cast<WorkerState*>(memory);
}

Child StartWorker(const CampaignOptions& options, int index, WorkerState* states) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("no pipe for a worker");
  Child child;
  child.pid = fork();
  if (child.pid < 0) throw std::runtime_error("no process for a worker");
  if (child.pid == 0) {
    close(ends[0]);
    signal(SIGPIPE, SIG_IGN);
    int code = 1;
    try {
      code = RunWorker(options, index, states, ends[1]);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "hydro-torture: seed %llu: %s\n",
                   static_cast<unsigned long long>(states[index].seed), error.what());
    }
    _exit(code);
  }
  close(ends[1]);
  child.pipe = ends[0];
  return child;
}

// A caught signal is for all workers: each ends its current run, and reports.
void ReadAll(Child* child) {
  char buffer[65536];
  while (true) {
    const ssize_t size = read(child->pipe, buffer, sizeof buffer);
    if (size < 0 && errno == EINTR) {
      kill(child->pid, SIGTERM);
      continue;
    }
    if (size <= 0) break;
    child->report.append(buffer, static_cast<size_t>(size));
  }
  close(child->pipe);
}

// The finding for a run that crashed the whole program.
Finding Crash(const CampaignOptions& options, const WorkerState& state, int status) {
  Finding finding;
  finding.seed = state.seed;
  finding.after_s = state.began_s;
  finding.violation.invariant = "nothing crashes";
  finding.violation.text = WIFSIGNALED(status) ? fmt::format("signal {}", WTERMSIG(status))
                                               : fmt::format("exit code {}", WEXITSTATUS(status));
  finding.schedule = DrawSchedule(state.seed);
  finding.file = fmt::format("{}/seed_{}.torture", options.out, state.seed);
  WriteWholeFile(finding.file, ScheduleText(finding.schedule));
  return finding;
}

}  // namespace

CampaignResult RunCampaign(const CampaignOptions& options) {
  const OutputFolder folder(options.out, "--out");  // it stays where it has a schedule
  const auto start = Clock::now();
  WorkerState* const states = SharedStates(options.jobs);
  std::vector<Child> children;
  children.reserve(static_cast<size_t>(options.jobs));
  for (int i = 0; i < options.jobs; ++i) children.push_back(StartWorker(options, i, states));
  CampaignResult result;
  for (int i = 0; i < options.jobs; ++i) {
    Child& child = children[static_cast<size_t>(i)];
    if (process::StopSignal() != 0) kill(child.pid, SIGTERM);
    ReadAll(&child);
    int status = 0;
    while (waitpid(child.pid, &status, 0) < 0 && errno == EINTR) {
    }
    if (status == 0) {
      AddReport(child.report, &result);
    } else {
      ++result.failed_runs;
      result.findings.push_back(Crash(options, states[i], status));
    }
  }
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  result.cpu_s = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                 1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  munmap(states, sizeof(WorkerState) * static_cast<size_t>(options.jobs));
  result.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  return result;
}

}  // namespace hydro::torture
