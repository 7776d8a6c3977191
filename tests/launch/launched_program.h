// Runs a program and reads its output as it comes, for tests of whole processes.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "launch/child_process.h"

namespace hydro::launch {

class LaunchedProgram {
 public:
  static constexpr std::chrono::seconds kPatience{60};  // only a broken program takes that long

  LaunchedProgram(std::vector<std::string> argv, const std::map<std::string, std::string>& environment) {
    int out[2], err[2];
    if (pipe2(out, O_CLOEXEC) != 0 || pipe2(err, O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    pid_ = fork();
    if (pid_ == 0) {
      setpgid(0, 0);
      prctl(PR_SET_PDEATHSIG, SIGKILL);
      dup2(out[1], STDOUT_FILENO);
      dup2(err[1], STDERR_FILENO);
      for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
      std::vector<char*> arguments;
      for (std::string& argument : argv) arguments.push_back(argument.data());
      arguments.push_back(nullptr);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    close(out[1]);
    close(err[1]);
    streams_[0].fd = out[0];
    streams_[1].fd = err[0];
  }

  ~LaunchedProgram() {
    if (pid_ > 0) {
      kill(pid_, SIGTERM);  // lets it end its children; SIGKILL would only show that they end by themselves
      WaitForExit();
    }
    for (Stream& stream : streams_) {
      if (stream.fd >= 0) close(stream.fd);
    }
  }
  LaunchedProgram(const LaunchedProgram&) = delete;
  LaunchedProgram& operator=(const LaunchedProgram&) = delete;

  pid_t pid() const { return pid_; }
  void Signal(int number) { kill(pid_, number); }

  // From here on nobody reads what it prints.
  void CloseOutput() {
    for (Stream& stream : streams_) {
      close(stream.fd);
      stream.fd = -1;
    }
  }

  const std::vector<std::string>& out() const { return streams_[0].lines; }
  const std::vector<std::string>& err() const { return streams_[1].lines; }
  std::string text() const {
    std::string all;
    for (const Stream& stream : streams_) {
      for (const std::string& line : stream.lines) all += line + "\n";
    }
    return all;
  }

  // Reads until a line of either stream contains `part`, and returns that line. Throws when the program ends
  // first.
  std::string WaitForLine(const std::string& part) {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (true) {
      for (const Stream& stream : streams_) {
        for (const std::string& line : stream.lines) {
          if (line.find(part) != std::string::npos) return line;
        }
      }
      if (!Read(deadline)) throw std::runtime_error("no line with \"" + part + "\" in:\n" + text());
    }
  }

  // Reads what is left and returns the exit code; 128 + n when it was killed by signal n.
  int WaitForExit() {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (Read(deadline)) {
    }
    if (std::chrono::steady_clock::now() >= deadline) kill(pid_, SIGKILL);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
  }

 private:
  struct Stream {
    int fd = -1;
    LineAssembler assembler;
    std::vector<std::string> lines;
  };

  // False when both streams have ended or the deadline has passed.
  bool Read(std::chrono::steady_clock::time_point deadline) {
    pollfd polled[2] = {{streams_[0].fd, POLLIN, 0}, {streams_[1].fd, POLLIN, 0}};
    if (polled[0].fd < 0 && polled[1].fd < 0) return false;
    const auto left =
        std::chrono::ceil<std::chrono::milliseconds>(deadline - std::chrono::steady_clock::now()).count();
    if (left <= 0 || poll(polled, 2, static_cast<int>(left)) <= 0) return false;
    for (int i = 0; i < 2; ++i) {
      if (polled[i].revents == 0) continue;
      Stream& stream = streams_[i];
      const auto keep = [&](std::string_view line) { stream.lines.emplace_back(line); };
      char buffer[65536];
      const ssize_t n = read(stream.fd, buffer, sizeof buffer);
      if (n > 0) {
        stream.assembler.Feed({buffer, static_cast<std::size_t>(n)}, keep);
      } else {
        stream.assembler.Finish(keep);
        close(stream.fd);
        stream.fd = -1;
      }
    }
    return true;
  }

  pid_t pid_ = -1;
  Stream streams_[2];
};

}  // namespace hydro::launch
