// Stands in for a program of the stack. Its role comes from the name it is called by (hydro-plant: plant),
// what it does from the environment variable HYDRO_FAKE_<role>: commands separated by ';'. The bus is at
// HYDRO_FAKE_URL.
//   say TEXT           a line on stdout         complain TEXT   a line on stderr
//   quiet              says on stderr whether HYDRO_QUIET is set
//   pid                prints "pid N"           arguments       prints "arguments ..." as it was called
//   print N            N lines on each of stdout and stderr, cut at odd places
//   endless            one line without an end, and no newline
//   status NAME TEXT   announces ready, running, done or failed
//   statistics         one report of 1000 cycles
//   fault [CODE]       raises CODE (over_pressure)   gone [CODE]     says that it has gone
//   stop CODE TEXT     publishes HYDRO_STOP
//   await N            until N roles beside it have said that they are ready
//   wait               until HYDRO_STOP or SIGTERM, announcing its status; says which
//   wait-term          until SIGTERM; says so
//   deaf               SIGTERM is ignored from here on; says so
//   touch FILE         makes a file
//   exit N             raise N (kills itself by a signal)
// At the end of its commands it exits with 0.
#include <signal.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <hydro/fault_t.hpp>
#include <hydro/loop_statistics_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/stop_t.hpp>
#include <memory>
#include <set>
#include <sstream>
#include <string>

#include "bus/channels.h"
#include "bus/clock.h"
#include "bus/session.h"
#include "bus/udpm/open_udpm_bus.h"

namespace hydro::launch {
namespace {

volatile sig_atomic_t terminated = 0;

void OnTerm(int) { terminated = 1; }

class FakeProgram {
 public:
  explicit FakeProgram(std::string role) : role_(std::move(role)) {}

  void Do(const std::string& command, int argc, char** argv) {
    std::istringstream in(command);
    std::string verb, first, rest;
    in >> verb;
    std::getline(in >> std::ws, rest);
    const std::string all = rest;
    std::istringstream words(rest);
    words >> first;
    std::getline(words >> std::ws, rest);
    if (verb == "say") Say(all);
    if (verb == "complain") dprintf(STDERR_FILENO, "%s\n", all.c_str());
    if (verb == "quiet")
      dprintf(STDERR_FILENO, "%s\n", getenv("HYDRO_QUIET") != nullptr ? "quiet" : "not quiet");
    if (verb == "pid") Say("pid " + std::to_string(getpid()));
    if (verb == "arguments") {
      std::string text = "arguments";
      for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
      Say(text);
    }
    if (verb == "print") Print(std::stoi(first));
    if (verb == "endless") dprintf(STDOUT_FILENO, "no end");
    if (verb == "status") Announce(first, rest);
    if (verb == "statistics") PublishStatistics();
    if (verb == "fault" || verb == "gone") {
      PublishFault(first.empty() ? "over_pressure" : first, verb == "fault");
    }
    if (verb == "stop") PublishStop(std::stoi(first), rest);
    if (verb == "await") Await(std::stoul(first));
    if (verb == "wait") Wait();
    if (verb == "wait-term") WaitTerm();
    if (verb == "deaf") {
      signal(SIGTERM, SIG_IGN);
      Say("deaf");
    }
    if (verb == "touch") std::ofstream(first) << "here\n";
    if (verb == "exit") _exit(std::stoi(first));
    if (verb == "raise") raise(std::stoi(first));
  }

 private:
  void Say(const std::string& text) { dprintf(STDOUT_FILENO, "%s\n", text.c_str()); }

  bus::Bus& bus() {
    if (!bus_) {
      bus_ = bus::OpenUdpmBus(std::getenv("HYDRO_FAKE_URL"));
      bus_->Subscribe<stop_t>(channels_.Of<stop_t>(), [this](const stop_t& stop) { stop_ = stop.reason; });
      bus_->Subscribe<process_status_t>(channels_.Of<process_status_t>(),
                                        [this](const process_status_t& status) {
                                          if (status.role != role_) ready_.insert(status.role);
                                        });
    }
    return *bus_;
  }

  void Announce(const std::string& name, const std::string& text) {
    process_status_t status;
    status.utime = bus::WallClock().Utime();
    status.session = session_;
    status.role = role_;
    status.host = "here";
    status.version = "test";
    status.pid = getpid();
    status.state = name == "ready"     ? process_status_t::READY
                   : name == "running" ? process_status_t::RUNNING
                   : name == "done"    ? process_status_t::DONE
                                       : process_status_t::FAILED;
    status.text = text;
    bus().Publish(channels_.Of<process_status_t>(), status);
    status_ = name;
  }

  void PublishStatistics() {
    loop_statistics_t report{};
    report.session = session_;
    report.role = role_;
    report.whole_run = true;
    report.interval_s = 1;
    report.cycles = 1000;
    report.period_p50_us = 1001;
    report.latency_max_us = 345;
    report.missed_deadlines = 7;
    report.lost_messages = 3;
    bus().Publish(channels_.Of<loop_statistics_t>(), report);
  }

  void PublishFault(const std::string& code, bool active) {
    fault_t fault{};
    fault.session = session_;
    fault.source = role_;
    fault.code = code;
    fault.text = "p1 is 2100 psi, allowed are 2000 psi";
    fault.active = active;
    bus().Publish(channels_.Of<fault_t>(), fault);
  }

  void PublishStop(int code, const std::string& reason) {
    stop_t stop{};
    stop.session = session_;
    stop.source = role_;
    stop.reason = reason;
    stop.exit_code = code;
    bus().Publish(channels_.Of<stop_t>(), stop);
  }

  // A program that is heavy on output: pieces of lines, on both streams in turn.
  void Print(int lines) {
    std::string text;
    for (int i = 0; i < lines; ++i) text += role_ + " line " + std::to_string(i) + " of the test's output\n";
    std::size_t piece = 1;
    std::size_t done[2] = {0, 0};
    while (done[0] < text.size() || done[1] < text.size()) {
      for (const int stream : {0, 1}) {
        piece = piece * 7 % 4093 + 1;
        const std::size_t n = std::min(piece, text.size() - done[stream]);
        if (n > 0)
          done[stream] += write(stream == 0 ? STDOUT_FILENO : STDERR_FILENO, text.data() + done[stream], n);
      }
    }
  }

  void Await(std::size_t others) {
    bus();
    while (!terminated && ready_.size() < others) {
      if (status_ == "ready") Announce("ready", "");
      bus().HandleUntil(std::chrono::steady_clock::now() + std::chrono::milliseconds(50));
    }
  }

  void Wait() {
    bus();
    while (!terminated && stop_.empty()) {
      if (status_ == "ready") Announce("ready", "");
      bus().HandleUntil(std::chrono::steady_clock::now() + std::chrono::milliseconds(50));
    }
    Say(stop_.empty() ? "got SIGTERM" : "got stop: " + stop_);
  }

  void WaitTerm() {
    sigset_t term, before;
    sigemptyset(&term);
    sigaddset(&term, SIGTERM);
    sigprocmask(SIG_BLOCK, &term, &before);
    while (!terminated) sigsuspend(&before);
    sigprocmask(SIG_SETMASK, &before, nullptr);
    Say("got SIGTERM");
  }

  const std::string role_;
  const int64_t session_ = bus::RandomSession();
  const bus::Channels channels_;
  std::unique_ptr<bus::UdpmBus> bus_;
  std::string status_;
  std::string stop_;
  std::set<std::string> ready_;
};

}  // namespace
}  // namespace hydro::launch

int main(int argc, char** argv) {
  struct sigaction action = {};
  action.sa_handler = hydro::launch::OnTerm;
  sigaction(SIGTERM, &action, nullptr);
  std::string role = argv[0];
  role = role.substr(role.rfind('/') + 1).substr(6);
  for (char& c : role) c = c == '-' ? '_' : c;
  hydro::launch::FakeProgram program(role);
  const char* script = std::getenv(("HYDRO_FAKE_" + role).c_str());
  std::istringstream commands(script ? script : "");
  for (std::string command; std::getline(commands, command, ';');) program.Do(command, argc, argv);
  return 0;
}
