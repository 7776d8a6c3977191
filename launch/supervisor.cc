#include "launch/supervisor.h"

#include <poll.h>
#include <signal.h>
#include <string.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>

namespace hydro::launch {
namespace {

using Stream = LabelledOutput::Stream;

sigset_t WatchedSignals() {
  sigset_t set;
  sigemptyset(&set);
  for (const int s : {SIGINT, SIGTERM, SIGHUP, SIGCHLD}) sigaddset(&set, s);
  return set;
}

int PollTimeoutMs(Supervisor::TimePoint until) {
  using std::chrono::milliseconds;
  const auto left = std::chrono::ceil<milliseconds>(until - Supervisor::Clock::now()).count();
  return static_cast<int>(std::clamp<int64_t>(left, 0, 60'000));
}

}  // namespace

Supervisor::Supervisor(LabelledOutput& output, Grace grace) : output_(output), stop_(grace) {
  const sigset_t set = WatchedSignals();
  sigprocmask(SIG_BLOCK, &set, nullptr);
  // When the reader of this output goes away, that must not end the launcher and leave the motor running.
  signal(SIGPIPE, SIG_IGN);
  // If the parent process ignored SIGCHLD, children would vanish without a status.
  signal(SIGCHLD, SIG_DFL);
  signal_fd_ = signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
  if (signal_fd_ < 0) throw StartError(std::string("signalfd: ") + strerror(errno));
}

Supervisor::~Supervisor() {
  Stop(Clock::now());
  while (running() > 0) Wait(TimePoint::max());
  close(signal_fd_);
}

int32_t Supervisor::Start(const ChildSpec& spec) {
  children_.push_back(std::make_unique<Child>(spec));
  stop_.Add(&children_.back()->process);
  for (const std::string& warning : children_.back()->process.warnings()) {
    output_.Line(Stream::kErr, spec.label, warning);
  }
  return children_.back()->process.pid();
}

void Supervisor::Wait(TimePoint deadline) {
  stop_.TakeSteps(Clock::now());
  for (const auto& child : children_) child->process.Beat();

  std::vector<pollfd> polled{{signal_fd_, POLLIN, 0}, {output_.waiting_fd(), POLLOUT, 0}};
  std::vector<std::pair<Child*, Stream>> readers;
  if (!output_.full()) {
    for (const auto& child : children_) {
      for (const Stream stream : {Stream::kOut, Stream::kErr}) {
        const int fd = stream == Stream::kOut ? child->process.out_fd() : child->process.err_fd();
        if (fd < 0) continue;
        polled.push_back({fd, POLLIN, 0});
        readers.emplace_back(child.get(), stream);
      }
    }
  }
  if (poll(polled.data(), polled.size(), PollTimeoutMs(std::min(deadline, stop_.NextStep()))) < 0) return;

  for (std::size_t i = 0; i < readers.size(); ++i) {
    if (polled[2 + i].revents != 0) Read(*readers[i].first, readers[i].second);
  }
  if (polled[1].revents != 0) output_.WriteSome();
  ReadSignals();
  Reap();
  stop_.TakeSteps(Clock::now());
}

void Supervisor::ReadSignals() {
  signalfd_siginfo info;
  while (read(signal_fd_, &info, sizeof info) == sizeof info) {
    if (info.ssi_signo != SIGCHLD) signals_.push_back(static_cast<int>(info.ssi_signo));
  }
}

void Supervisor::Read(Child& child, Stream stream) {
  const bool out = stream == Stream::kOut;
  const int fd = out ? child.process.out_fd() : child.process.err_fd();
  LineAssembler& lines = out ? child.out_lines : child.err_lines;
  const auto pass_on = [&](std::string_view line) { output_.Line(stream, child.process.spec().label, line); };
  std::array<char, 16 * 1024> buffer;
  const ssize_t n = read(fd, buffer.data(), buffer.size());
  if (n > 0) {
    lines.Feed({buffer.data(), static_cast<std::size_t>(n)}, pass_on);
  } else if (n == 0 || (errno != EAGAIN && errno != EINTR)) {
    lines.Finish(pass_on);
    out ? child.process.CloseOut() : child.process.CloseErr();
  }
}

// Reads what an ended child left in the pipe. A pipe holds 64 KiB. More can only come from a process that the
// child started and that inherited the pipe; the supervisor does not wait for such processes.
void Supervisor::ReadRest(Child& child, Stream stream) {
  const auto fd = [&] { return stream == Stream::kOut ? child.process.out_fd() : child.process.err_fd(); };
  for (int i = 0; i < 16 && fd() >= 0; ++i) {
    pollfd waiting{fd(), POLLIN, 0};
    if (poll(&waiting, 1, 0) <= 0) break;
    Read(child, stream);
  }
  const auto pass_on = [&](std::string_view line) { output_.Line(stream, child.process.spec().label, line); };
  (stream == Stream::kOut ? child.out_lines : child.err_lines).Finish(pass_on);
  stream == Stream::kOut ? child.process.CloseOut() : child.process.CloseErr();
}

void Supervisor::Reap() {
  for (const auto& child : children_) {
    if (!child->process.TryReap()) continue;
    ReadRest(*child, Stream::kOut);
    ReadRest(*child, Stream::kErr);
    const ChildSpec& spec = child->process.spec();
    ended_.push_back({spec.label, spec.program(), spec.role(), child->process.pid(), *child->process.end(),
                      stop_.terminated(&child->process), stop_.hung(&child->process)});
  }
}

std::optional<Ended> Supervisor::NextEnded() {
  if (ended_.empty()) return std::nullopt;
  Ended ended = ended_.front();
  ended_.pop_front();
  return ended;
}

std::optional<int> Supervisor::NextSignal() {
  if (signals_.empty()) return std::nullopt;
  const int number = signals_.front();
  signals_.pop_front();
  return number;
}

void Supervisor::KillAll() {
  Stop(Clock::now());
  for (const auto& child : children_) child->process.Signal(SIGKILL);
}

}  // namespace hydro::launch
