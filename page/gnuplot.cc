#include "page/gnuplot.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <vector>

namespace hydro::page {
namespace {

// A file in memory. Unlike with pipes, nobody waits for anybody, and a child that ends early kills nobody.
class MemoryFile {
 public:
  explicit MemoryFile(const char* name) : fd_(memfd_create(name, MFD_CLOEXEC)) {
    if (fd_ < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
  }
  ~MemoryFile() { close(fd_); }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  int fd() const { return fd_; }

  void Fill(std::string_view text) {
    while (!text.empty()) {
      const ssize_t written = write(fd_, text.data(), text.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) throw std::system_error(errno, std::generic_category(), "the script for gnuplot");
      text.remove_prefix(static_cast<size_t>(written));
    }
    lseek(fd_, 0, SEEK_SET);
  }

  std::string Text() const {
    std::string text(static_cast<size_t>(lseek(fd_, 0, SEEK_END)), '\0');
    size_t have = 0;
    while (have < text.size()) {
      const ssize_t got = pread(fd_, text.data() + have, text.size() - have, static_cast<off_t>(have));
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) throw std::system_error(errno, std::generic_category(), "what gnuplot wrote");
      have += static_cast<size_t>(got);
    }
    return text;
  }

 private:
  int fd_;
};

class FileActions {
 public:
  FileActions() { posix_spawn_file_actions_init(&actions_); }
  ~FileActions() { posix_spawn_file_actions_destroy(&actions_); }
  FileActions(const FileActions&) = delete;
  FileActions& operator=(const FileActions&) = delete;
  void Use(const MemoryFile& file, int as) { posix_spawn_file_actions_adddup2(&actions_, file.fd(), as); }
  const posix_spawn_file_actions_t* get() const { return &actions_; }

 private:
  posix_spawn_file_actions_t actions_;
};

// Ours, but with the decimal point and the characters that the script is written with.
std::vector<std::string> Environment() {
  std::vector<std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view variable = *entry;
    if (!variable.starts_with("LC_") && !variable.starts_with("LANG=") && !variable.starts_with("GNUPLOT")) {
      variables.emplace_back(variable);
    }
  }
  variables.emplace_back("LC_ALL=C.UTF-8");
  return variables;
}

bool IsBlank(char c) { return c == ' ' || c == '\n' || c == '\t'; }

}  // namespace

std::string RunGnuplot(const std::string& script) {
  MemoryFile input("script");
  MemoryFile output("drawing");
  MemoryFile errors("complaints");
  input.Fill(script);
  FileActions actions;
  actions.Use(input, STDIN_FILENO);
  actions.Use(output, STDOUT_FILENO);
  actions.Use(errors, STDERR_FILENO);

  std::string program = "gnuplot";
  std::string defaults = "--default-settings";
  char* const argv[] = {program.data(), defaults.data(), nullptr};
  std::vector<std::string> variables = Environment();
  std::vector<char*> environment;
  environment.reserve(variables.size() + 1);
  for (std::string& variable : variables) environment.push_back(variable.data());
  environment.push_back(nullptr);

  pid_t pid = -1;
  const int error = posix_spawnp(&pid, program.c_str(), actions.get(), nullptr, argv, environment.data());
  if (error == ENOENT) {
    throw std::runtime_error(
        "gnuplot, which draws the figures, is not installed: apt-get install gnuplot-nox");
  }
  if (error != 0) throw std::system_error(error, std::generic_category(), "gnuplot could not be started");
  int status = 0;
  while (waitpid(pid, &status, 0) < 0) {
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "waiting for gnuplot");
  }
  if (status != 0) {
    std::string complaint = errors.Text();  // several lines: the command, a mark below it, what is wrong
    complaint.erase(std::unique(complaint.begin(), complaint.end(),
                                [](char a, char b) { return IsBlank(a) && IsBlank(b); }),
                    complaint.end());
    std::replace(complaint.begin(), complaint.end(), '\n', ' ');
    throw std::runtime_error("gnuplot failed: " + complaint);
  }
  return output.Text();
}

}  // namespace hydro::page
