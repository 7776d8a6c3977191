#include "batch/run/case_command.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/eventfd.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/descriptor.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "batch/store/small_file.h"
#include "process/own_program.h"
#include "process/process_end.h"
#include "process/spawn.h"

namespace hydro::batch {
namespace {

std::string Filled(const std::string& name, const std::vector<std::string>& keys,
                   const std::vector<Value>& values, const CasePlace& place) {
  if (name == "case") return std::to_string(place.index);
  if (name == "folder") return place.folder;
  if (name == "inputs") return place.inputs;
  std::vector<std::string> known = {"case", "folder", "inputs"};
  for (size_t i = 0; i < keys.size(); ++i) {
    if (name == "value:" + keys[i]) return PlainText(values[i]);
    known.push_back("value:" + keys[i]);
  }
  throw InputError("step.run: found {" + name + "}, allowed in braces " + QuotedList(known) +
                   DidYouMean(name, known));
}

bool IsName(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == ':' || c == '.' || c == '_' || c == '*' || c == '-';
  });
}

// Braces around anything but a name belong to the command itself, as in JSON or awk, and so does ${...}.
std::string Replaced(const std::string& text, const std::vector<std::string>& keys,
                     const std::vector<Value>& values, const CasePlace& place) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    const bool opens = text[i] == '{' && (i == 0 || text[i - 1] != '$');
    const size_t end = opens ? text.find('}', i) : std::string::npos;
    const std::string name = end == std::string::npos ? "" : text.substr(i + 1, end - i - 1);
    if (IsName(name)) {
      result += Filled(name, keys, values, place);
      i = end + 1;
    } else {
      result += text[i++];
    }
  }
  return result;
}

using Clock = std::chrono::steady_clock;

int OpenOutput(const std::string& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) ThrowCannotWrite(path);
  return descriptor;
}

// A child's message about a full disk must not fail for lack of room, and another case beside it may take the
// space that was just freed.
void ReserveLastWords(int descriptor, const std::string& path) {
  constexpr off_t kRoom = 4096;
  if (fallocate(descriptor, FALLOC_FL_KEEP_SIZE, 0, kRoom) == 0) return;
  if (errno == ENOSPC || errno == EDQUOT) ThrowCannotWrite(path);  // other file systems cannot reserve space
}

int Milliseconds(Clock::time_point until) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
  return static_cast<int>(std::clamp<int64_t>(left, 0, 1'000'000'000));
}

bool HasEnded(pid_t pid) {
  siginfo_t info = {};
  return waitid(P_PID, static_cast<id_t>(pid), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid == pid;
}

// A child and its pidfd, which is -1 where the kernel provides none.
struct Child {
  pid_t pid;
  int descriptor;
};

// Returns true when the child has ended; `bell` may end the wait.
bool WaitFor(const Child& child, int bell, std::optional<Clock::time_point> until) {
  constexpr int kLook = 5;  // ms between checks without a pidfd
  for (;;) {
    std::array<pollfd, 2> waits = {pollfd{bell, POLLIN, 0}, pollfd{child.descriptor, POLLIN, 0}};
    int left = until ? Milliseconds(*until) : -1;
    if (child.descriptor < 0) left = left < 0 ? kLook : std::min(left, kLook);
    const int count = poll(waits.data(), waits.size(), left);
    if (count < 0 && errno == EINTR) continue;
    if (child.descriptor < 0 ? HasEnded(child.pid) : waits[1].revents != 0) return true;
    if (waits[0].revents != 0 || (until && Clock::now() >= *until)) return false;
  }
}

int Reap(pid_t pid) {
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  return status;
}

void EndGroup(const Child& child) {
  kill(-child.pid, SIGTERM);
  if (!WaitFor(child, -1, Clock::now() + std::chrono::seconds(2))) kill(-child.pid, SIGKILL);
}

}  // namespace

std::vector<std::string> CaseCommand(const Step& step, const std::vector<std::string>& keys,
                                     const std::vector<Value>& values, const CasePlace& place) {
  std::vector<std::string> argv;
  for (const std::string& text : step.argv) argv.push_back(Replaced(text, keys, values, place));
  return argv;
}

std::string ProgramPath(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  std::error_code failed;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
  if (!failed && access((own / name).c_str(), X_OK) == 0) return own / name;
  if (std::string found = process::ProgramOnPath(name, "/usr/bin:/bin"); !found.empty()) return found;
  throw InputError("step.run: found " + Quoted(name) +
                   ", allowed a program beside hydro-batch, in PATH, or with its path");
}

void CheckCommands(const Study& study) {
  for (const Step& step : study.steps) {
    try {
      const std::string program = CaseCommand(step, study.Keys(), study.Values(0), {}).front();
      if (program == step.argv.front()) ProgramPath(program);
    } catch (const InputError& error) {
      throw InputError(step.place + ": " + error.what());
    }
  }
}

StopBell::StopBell() : descriptor_(eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) throw std::runtime_error(std::string("no event descriptor: ") + std::strerror(errno));
}
StopBell::~StopBell() { close(descriptor_); }
void StopBell::Ring() const { eventfd_write(descriptor_, 1); }
bool StopBell::Rings() const { return RingsWithin(std::chrono::milliseconds(0)); }
bool StopBell::RingsWithin(std::chrono::milliseconds time) const {
  pollfd wait{descriptor_, POLLIN, 0};
  return poll(&wait, 1, static_cast<int>(time.count())) > 0;
}

ChildResult RunChild(const ChildRequest& request, const StopBell& bell) {
  process::Spawned spawned;
  {
    const Descriptor out(OpenOutput(request.out)), err(OpenOutput(request.err));
    ReserveLastWords(err.number(), request.err);
    spawned = process::Spawn(
        {.argv = request.argv, .folder = request.folder, .out = out.number(), .err = err.number()});
  }
  const Descriptor descriptor(static_cast<int>(syscall(SYS_pidfd_open, spawned.pid, 0)));
  const Child child{spawned.pid, descriptor.number()};
  ChildResult result;
  if (!WaitFor(child, bell.descriptor(), request.deadline)) {
    result.end = bell.Rings() ? ChildEnd::kStopped : ChildEnd::kLate;
    EndGroup(child);
  }
  result.wait_status = Reap(spawned.pid);
  return result;
}

}  // namespace hydro::batch
