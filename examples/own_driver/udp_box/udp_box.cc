// A driver for an I/O box on Ethernet. What is particular to the box is here; the rest is hydro's
// (docs/own_driver.md).
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>

#include "frames.h"
#include "plant/driver/driver_main.h"
#include "settings/urls.h"

namespace {

using hydro::plant::DeviceInput;

constexpr auto kAnswerTime = std::chrono::microseconds(300);
constexpr uint32_t kRemembered = 64;  // of the newest commands it is known when they were sent
constexpr int kMostAtOnce = 64;       // datagrams that one turn takes, however many come

// The socket to "udp://HOST:PORT". Throws InputError.
int Connect(const hydro::plant::DeviceSettings& settings) {
  const std::string& url = settings.device;
  const auto refuse = [&](const std::string& why, const std::string& allowed) {
    return hydro::settings::KeyError(settings.config.file, "driver.device", "\"" + url + "\"" + why, allowed);
  };
  const std::string usual = "udp://HOST:PORT, e.g. udp://192.168.1.7:5005";
  if (!url.starts_with("udp://")) throw refuse("", usual);
  hydro::settings::FrontEndUrl address;
  const std::string allowed = hydro::settings::WhatIsWrongWithFrontEndUrl(url, &address);
  if (!allowed.empty()) throw refuse("", allowed);
  addrinfo hints{}, *found = nullptr;
  hints.ai_socktype = SOCK_DGRAM;
  const int error = getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &found);
  if (error != 0) throw refuse(std::string(" (") + gai_strerror(error) + ")", usual);
  const int socket = ::socket(found->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  const bool connected = socket >= 0 && connect(socket, found->ai_addr, found->ai_addrlen) == 0;
  freeaddrinfo(found);
  if (connected) return socket;
  const int reason = errno;
  if (socket >= 0) close(socket);
  throw refuse(std::string(" (") + std::strerror(reason) + ")", usual);
}

class UdpBox : public hydro::plant::Device {
 public:
  explicit UdpBox(hydro::plant::DeviceSettings& settings)
      : name_(settings.device), clock_(settings.clock), socket_(Connect(settings)) {
    int patience = 1000;  // ms, of [driver.own]; a key that nobody asks for is refused
    settings.own.Integer("answer_ms", &patience, 1, 10000);
    Send(Command{});  // --check-sensors too: the box answers only to commands, and at the start it is at zero
    if (WaitForAnswer(std::chrono::milliseconds(patience))) return;
    close(socket_);
    throw hydro::plant::DeviceError(
        name_ + " has not answered within " + std::to_string(patience) +
        " ms (driver.own.answer_ms): is it on, and is driver.device its address?");
  }
  ~UdpBox() override { close(socket_); }

  hydro::plant::DeviceDescription Describe() const override {
    hydro::plant::DeviceDescription box{.name = name_, .files = {socket_}};
    for (const char* name : {"ai0", "ai1", "ai2", "ai3"}) {
      box.inputs.push_back({.name = name, .low = -10, .high = 10});
    }
    box.inputs.push_back(
        {.name = "encoder", .kind = DeviceInput::Kind::kCount, .highest_count = kHighestCount});
    box.output = {.low = -10, .high = 10, .tolerance = 0.02};
    return box;
  }

  void Read(hydro::plant::DeviceReadings& readings) override {
    // It measures when it is asked. Its answer is awaited for a small part of a tick; one that comes later
    // counts next time.
    Send({.sequence = ++sequence_, .output = output_});
    WaitForAnswer(kAnswerTime);
    for (size_t i = 0; i < 4; ++i) readings.inputs[i] = {answer_.inputs[i], answered_};
    readings.inputs[4] = {static_cast<double>(answer_.count), answered_};
    readings.output = {answer_.output, answered_};
    readings.fault = answer_.fault == 0 ? "" : "fault " + std::to_string(answer_.fault);
  }

  // What is lost on the way is not noticed here, but by the answers that do not come.
  void Drive(double output) override {
    output_ = static_cast<float>(output);
    if (!Send({.sequence = ++sequence_, .output = output_}) && errno != ECONNREFUSED && errno != EAGAIN)
      throw hydro::plant::DeviceError(name_ + ": " + std::strerror(errno));
  }

  bool Zero(double output) noexcept override {
    output_ = static_cast<float>(output);
    return Send({.output = output_});
  }

  // The newest answer, if there is one; a box that never ends to send must not hold the end of a run.
  double ReadBack() noexcept override {
    bool answered = false;
    for (int i = 0; i < 5 && WaitForAnswer(std::chrono::milliseconds(20)); ++i) answered = true;
    return answered ? answer_.output : std::nan("");
  }

 private:
  bool Send(const Command& command) noexcept {
    sent_at_[command.sequence % kRemembered] = clock_.Now();
    return send(socket_, &command, sizeof command, 0) == sizeof command;
  }

  // The box measures as it answers, so a reading is as old as the question.
  hydro::bus::Clock::TimePoint AskedAt(uint32_t sequence) const noexcept {
    return sequence_ - sequence < kRemembered ? sent_at_[sequence % kRemembered] : answered_;
  }

  // Takes all that has come; the newest counts. An error of the socket says no more than that nothing came.
  bool Receive() noexcept {
    bool received = false;
    Answer answer;
    for (int i = 0; i < kMostAtOnce; ++i) {
      const ssize_t got = recv(socket_, &answer, sizeof answer, MSG_TRUNC);
      if (got < 0 && errno != EINTR) break;
      if (got != sizeof answer || answer.magic != Answer{}.magic) continue;
      answer_ = answer;
      answered_ = AskedAt(answer.sequence);
      received = true;
    }
    return received;
  }

  // Anybody may send to the port, so what is no answer does not end the wait.
  bool WaitForAnswer(std::chrono::nanoseconds patience) noexcept {
    const auto until = clock_.Now() + patience;
    for (std::chrono::nanoseconds left = patience; left.count() > 0; left = until - clock_.Now()) {
      pollfd waits{.fd = socket_, .events = POLLIN, .revents = 0};
      const timespec limit{left.count() / 1000000000, left.count() % 1000000000};
      if (ppoll(&waits, 1, &limit, nullptr) > 0 && Receive()) return true;
    }
    return false;
  }

  std::string name_;
  const hydro::bus::Clock& clock_;
  int socket_;
  float output_ = 0;  // V, put out
  uint32_t sequence_ = 0;
  Answer answer_;
  hydro::bus::Clock::TimePoint sent_at_[kRemembered]{}, answered_{};
};

}  // namespace

int main(int argc, char** argv) {
  return hydro::plant::RunDriver(
      argc, argv, "Drives a machine behind an I/O box on Ethernet.",
      [](hydro::plant::DeviceSettings& settings) { return std::make_unique<UdpBox>(settings); });
}
