#include "board.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace serial_board {
namespace {

using hydro::plant::DeviceError;
using hydro::plant::DeviceInput;
using std::chrono::milliseconds;

constexpr double kCodesPerVolt = 3276.8;  // of the output, which A3 measures
constexpr int kZeroCode = 32768;
constexpr double kHighestOutput = 2047 / 204.8;  // V, the last code of 12 bits
constexpr milliseconds kPatience{5};             // an answer that takes longer is lost
constexpr milliseconds kAskAgain{100};
constexpr int kReadBackTries = 20;
constexpr int kMostAtOnce = 64;  // reads in one turn, however much comes

constexpr std::pair<int, speed_t> kRates[] = {{115200, B115200},   {230400, B230400},   {460800, B460800},
                                              {500000, B500000},   {921600, B921600},   {1000000, B1000000},
                                              {2000000, B2000000}, {3000000, B3000000}, {4000000, B4000000}};

std::string WhatToDo(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
      return "a port that you may use: sudo usermod -aG dialout \"$USER\", then log in again";
    case EBUSY:
    case EWOULDBLOCK:
      return "a port that no other program has open: fuser -v names it (often a serial monitor)";
    case ENOTTY:
      return "a serial port";
    default:
      return "a serial port: is the board plugged in? ls -l /dev/serial/by-id";
  }
}

// Raw bytes at this rate. Closing leaves DTR alone: many boards reset themselves when it falls.
bool SetUp(int port, speed_t rate) {
  termios line{};
  if (tcgetattr(port, &line) != 0) return false;
  cfmakeraw(&line);
  line.c_cflag |= CLOCAL | CREAD;
  line.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CRTSCTS | CSTOPB);
  return cfsetspeed(&line, rate) == 0 && tcsetattr(port, TCSANOW, &line) == 0 &&
         tcflush(port, TCIOFLUSH) == 0;
}

}  // namespace

std::optional<unsigned> RateOf(int baud) {
  for (const auto& [known, rate] : kRates)
    if (known == baud) return rate;
  return std::nullopt;
}

std::string AllowedRates() {
  std::string all;
  for (const auto& [baud, rate] : kRates) all += (all.empty() ? "" : ", ") + std::to_string(baud);
  return all;
}

int OpenPort(const std::string& path, unsigned rate, std::string* todo) {
  const int port = open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (port >= 0 && flock(port, LOCK_EX | LOCK_NB) == 0 && SetUp(port, rate)) return port;
  const int error = errno;
  if (port >= 0) close(port);
  *todo = WhatToDo(error);
  errno = error;
  return -1;
}

SerialBoard::SerialBoard(int port, std::string name, const hydro::bus::Clock& clock, bool drives,
                         milliseconds patience)
    : port_(port), name_(std::move(name)), clock_(clock), drives_(drives) {
  // Opening the port resets many boards, and their boot loader takes a second or two.
  for (const auto end = clock_.Now() + patience; clock_.Now() < end;) {
    Send(0);  // the board answers only to commands, and at the start it is at zero
    if (Wait(kAskAgain) && Receive()) return;
  }
  close(port_);
  throw DeviceError(name_ + " has not answered within " + std::to_string(patience.count()) +
                    " ms (driver.own.answer_ms): has it this sketch, and is driver.own.baud its rate?");
}

SerialBoard::~SerialBoard() { close(port_); }

hydro::plant::DeviceDescription SerialBoard::Describe() const {
  hydro::plant::DeviceDescription board{.name = name_, .files = {port_}};
  for (const char* name : {"A0", "A1", "A2"})
    board.inputs.push_back({.name = name, .unit = "codes", .low = 0, .high = 65535});
  board.inputs.push_back({.name = "encoder", .kind = DeviceInput::Kind::kCount, .highest_count = 0xffffffff});
  board.output = {.low = -10, .high = kHighestOutput, .tolerance = 0.03};
  return board;
}

void SerialBoard::Read(hydro::plant::DeviceReadings& readings) {
  Receive();
  if (!drives_) Ask();  // --check-sensors: nobody else asks the board to speak
  for (size_t i = 0; i < 3; ++i) readings.inputs[i] = {static_cast<double>(answer_.inputs[i]), measured_};
  readings.inputs[3] = {static_cast<double>(static_cast<uint32_t>(answer_.count)), measured_};
  readings.output = {Output(), measured_};
}

void SerialBoard::Drive(double output) {
  output_ = output;
  Receive();
  Ask();
}

// At once, whatever is on its way: a V begins the sketch's command anew.
bool SerialBoard::Zero(double output) noexcept {
  output_ = output;
  return Send(output);
}

double SerialBoard::ReadBack() noexcept {
  // Answers to earlier commands may still be on their way: the newest counts, once none is.
  Wait(kPatience);
  for (int i = 0; i < kReadBackTries; ++i) {
    Receive();
    Send(output_);
    Wait(kPatience);
    if (Receive() && unanswered_ == 0) return Output();
  }
  return std::nan("");
}

// A command goes out once the one before it is answered, or lost. So a slow line cannot fill with old
// answers, and each answer is as old as its command.
void SerialBoard::Ask() {
  if (unanswered_ > 0 && clock_.Now() - asked_ < kPatience) return;
  unanswered_ = 0;
  if (!Send(output_) && errno != EAGAIN) throw DeviceError(name_ + ": " + std::strerror(errno));
}

bool SerialBoard::Send(double volts) noexcept {
  const Command command = CommandFor(volts);
  asked_ = clock_.Now();
  ++unanswered_;
  return write(port_, command.text, command.size) == static_cast<ssize_t>(command.size);
}

bool SerialBoard::Receive() noexcept {
  bool answered = false;
  char bytes[512];
  for (int reads = 0; reads < kMostAtOnce; ++reads) {
    const ssize_t got = read(port_, bytes, sizeof bytes);
    if (got == 0 || (got < 0 && errno != EINTR)) break;
    for (ssize_t i = 0; i < got; ++i) answered = Take(bytes[i]) || answered;
  }
  return answered;
}

bool SerialBoard::Take(char c) noexcept {
  if (c != '\n') {
    if (length_ < sizeof line_) line_[length_++] = c;
    return false;
  }
  const auto answer = length_ < sizeof line_ ? AnswerIn({line_, length_}) : std::nullopt;
  length_ = 0;
  if (!answer) return false;
  answer_ = *answer;
  measured_ = asked_;
  if (unanswered_ > 0) --unanswered_;
  return true;
}

bool SerialBoard::Wait(milliseconds patience) const noexcept {
  pollfd waits{.fd = port_, .events = POLLIN, .revents = 0};
  return poll(&waits, 1, static_cast<int>(patience.count())) > 0;
}

double SerialBoard::Output() const noexcept { return (answer_.inputs[3] - kZeroCode) / kCodesPerVolt; }

}  // namespace serial_board
