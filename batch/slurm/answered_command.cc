#include "batch/slurm/answered_command.h"

#include <poll.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include "process/spawn.h"

namespace hydro::batch {
namespace {

using Clock = std::chrono::steady_clock;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {
    if (number_ < 0) throw std::runtime_error(std::string("no descriptor: ") + std::strerror(errno));
  }
  ~Descriptor() { close(number_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }

 private:
  int number_;
};

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

}  // namespace

std::string ProgramInPath(const std::string& name) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string program = (folder.empty() ? "." : folder) + "/" + name;
    if (access(program.c_str(), X_OK) == 0) return program;
  }
  return "";
}

Answer AskCommand(const std::vector<std::string>& argv, std::chrono::seconds limit,
                  const std::function<bool()>& stop) {
  // Uses files in memory rather than pipes, which would have to be emptied while the command runs.
  const Descriptor out(memfd_create("out", MFD_CLOEXEC)), err(memfd_create("err", MFD_CLOEXEC));
  const process::Spawned spawned = process::Spawn({.argv = argv, .out = out.number(), .err = err.number()});
  const Descriptor child(static_cast<int>(syscall(SYS_pidfd_open, spawned.pid, 0)));
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

}  // namespace hydro::batch
