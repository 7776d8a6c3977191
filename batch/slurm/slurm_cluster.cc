#include "batch/slurm/slurm_cluster.h"

#include <poll.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <string>

#include "base/descriptor.h"
#include "base/input_error.h"
#include "base/text_file.h"
#include "batch/slurm/slurm_answers.h"
#include "process/own_program.h"
#include "process/spawn.h"

namespace hydro::batch {
namespace {

using Clock = std::chrono::steady_clock;

Descriptor Opened(int number) {
  if (number < 0) throw std::runtime_error(std::string("no descriptor: ") + std::strerror(errno));
  return Descriptor(number);
}

std::string ContentsOf(const Descriptor& file) {
  std::string text;
  std::array<char, 65536> part;
  for (ssize_t size;
       (size = pread(file.number(), part.data(), part.size(), static_cast<off_t>(text.size()))) > 0;)
    text.append(part.data(), static_cast<size_t>(size));
  return text;
}

bool EndsWithin(const Descriptor& child, Clock::time_point deadline, const std::function<bool()>& stop) {
  while (!stop() && Clock::now() < deadline) {
    pollfd wait{child.number(), POLLIN, 0};
    if (poll(&wait, 1, 100) > 0) return true;
  }
  return false;
}

// A busy slurmctld answers late. sbatch even retries for minutes when slurmctld has as many jobs as it may
// have.
constexpr std::chrono::seconds kPatience{60};

std::string LastLineOf(const std::string& text) {
  std::string last;
  size_t start = 0;
  while (start < text.size()) {
    const size_t end = std::min(text.find('\n', start), text.size());
    if (end > start) last = text.substr(start, end - start);
    start = end + 1;
  }
  return last;
}

Answer Ask(std::vector<std::string> argv, const std::function<bool()>& stop) {
  const std::string program = process::ProgramOnPath(argv[0]);
  if (program.empty()) throw ClusterError("found no " + argv[0] + " on this machine", true);
  argv[0] = program;
  return AskCommand(argv, kPatience, stop);
}

[[noreturn]] void Refuse(const std::string& program, const Answer& answer) {
  if (!answer.ended_itself) throw ClusterError(program + ": no answer", false);
  const std::string line = LastLineOf(answer.err.empty() ? answer.out : answer.err);
  // For now, slurmctld is unreachable or has too many jobs.
  const bool later = line.find("contact") != std::string::npos ||
                     line.find("timed out") != std::string::npos ||
                     line.find("temporarily unavailable") != std::string::npos;
  std::string said = line.starts_with(program) ? Printable(line) : program + ": " + Printable(line);
  if (const std::string way = WayOut(answer.err); !later && !way.empty()) said += "; " + way;
  throw ClusterError(said, !later);
}

bool Never() { return false; }

// A job that has ended in the meantime counts as cancelled.
void CheckCancelled(const Answer& answer) {
  if (answer.exit_code != 0 && answer.err.find("Invalid job id") == std::string::npos)
    Refuse("scancel", answer);
}

}  // namespace

Answer AskCommand(const std::vector<std::string>& argv, std::chrono::seconds limit,
                  const std::function<bool()>& stop) {
  // Uses files in memory rather than pipes, which would have to be emptied while the command runs.
  const Descriptor out = Opened(memfd_create("out", MFD_CLOEXEC)),
                   err = Opened(memfd_create("err", MFD_CLOEXEC));
  const process::Spawned spawned = process::Spawn({.argv = argv, .out = out.number(), .err = err.number()});
  const Descriptor child = Opened(static_cast<int>(syscall(SYS_pidfd_open, spawned.pid, 0)));
  Answer answer;
  answer.ended_itself = EndsWithin(child, Clock::now() + limit, stop);
  if (!answer.ended_itself) kill(-spawned.pid, SIGKILL);
  int status = 0;
  while (waitpid(spawned.pid, &status, 0) < 0 && errno == EINTR) {
  }
  answer.ended_itself = answer.ended_itself && WIFEXITED(status);
  if (answer.ended_itself) answer.exit_code = WEXITSTATUS(status);
  answer.out = ContentsOf(out);
  answer.err = ContentsOf(err);
  return answer;
}

SlurmCluster::SlurmCluster(std::function<bool()> stop) : stop_(std::move(stop)) {
  if (!process::ProgramOnPath("sbatch").empty()) return;
  throw InputError(
      "--slurm: found no sbatch on this machine, allowed where Slurm's commands are (Debian: slurm-client)");
}

std::vector<std::string> SbatchArguments(const ArrayRequest& request) {
  std::string array = "--array=0-" + std::to_string(request.jobs - 1);
  if (request.at_once > 0) array += "%" + std::to_string(request.at_once);
  // The script decides where a job's output goes. A job whose node is lost begins again, unless a later
  // argument says otherwise.
  std::vector<std::string> arguments = {"sbatch",
                                        "--parsable",
                                        "--requeue",
                                        "--output=/dev/null",
                                        "--job-name=" + request.name,
                                        "--chdir=" + request.folder};
  arguments.insert(arguments.end(), request.arguments.begin(), request.arguments.end());
  arguments.insert(arguments.end(), {"--hold", array, request.script});
  return arguments;
}

ClusterLimits SlurmCluster::Limits(const std::string& partition) {
  const Answer answer = Ask({"scontrol", "show", "config"}, Never);
  if (answer.exit_code != 0) Refuse("scontrol", answer);
  ClusterLimits limits = ParseLimits(answer.out);
  const Answer nodes = Ask({"sinfo", "--noheader", std::string("--format=") + kPartitionFormat}, Never);
  if (nodes.exit_code == 0) limits.processors = ParseProcessors(nodes.out, partition);
  return limits;
}

int64_t SlurmCluster::SubmitHeld(const ArrayRequest& request) {
  const Answer answer = Ask(SbatchArguments(request), stop_);
  const auto id = answer.exit_code == 0 ? ParseSubmitted(answer.out) : std::nullopt;
  if (!id) Refuse("sbatch", answer);
  return *id;
}

void SlurmCluster::Release(int64_t id) {
  const Answer answer = Ask({"scontrol", "release", std::to_string(id)}, Never);
  if (answer.exit_code != 0) Refuse("scontrol", answer);
}

std::optional<std::vector<QueuedArray>> SlurmCluster::Queue() {
  const Answer answer =
      Ask({"squeue", "--me", "--noheader", "--array", std::string("--format=") + kQueueFormat}, Never);
  if (answer.exit_code != 0) return std::nullopt;
  return ParseQueue(answer.out);
}

void SlurmCluster::Cancel(int64_t id) { CheckCancelled(Ask({"scancel", std::to_string(id)}, Never)); }

void SlurmCluster::CancelPending(int64_t id) {
  CheckCancelled(Ask({"scancel", "--state=PENDING", std::to_string(id)}, Never));
}

}  // namespace hydro::batch
