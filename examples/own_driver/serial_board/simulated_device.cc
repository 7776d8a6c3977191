// simulated_device LINK MODEL.toml: a board on a pseudo terminal, which LINK names, that runs sketch.ino as
// it is, with this project's model of the machine behind its pins.
#include "plant/driver/simulated_device.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <string>

namespace {

using Clock = std::chrono::steady_clock;
using hydro::plant::DeviceTrouble;

constexpr double kVoltsPerOutput = 2;    // the amplifier's, V of eq. (1) per V
constexpr double kCodesPerVolt = 13107;  // of the inputs, 0 to 5 V

// What the pins are connected to.
struct Pins {
  hydro::plant::SimulatedDevice* machine = nullptr;
  hydro::model::Measurement measured{};
  int port = -1;
  int output = 2048;      // the converter's code
  std::string line = {};  // of the answer, as far as it is printed
  Clock::time_point answered{};
} pins;

int Code(double volts) { return std::clamp(static_cast<int>(std::lround(kCodesPerVolt * volts)), 0, 65535); }

// ---- as much of Arduino's library as the sketch calls ----
using std::isfinite;
enum : int { A0 = 14, A1, A2, A3, DAC0 };
constexpr Clock::time_point kStart{};

unsigned long millis() {
  return static_cast<unsigned long>(
      std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - kStart).count());
}
int constrain(int value, int low, int high) { return std::clamp(value, low, high); }
void analogReadResolution(int) {}
void analogWriteResolution(int) {}
void analogWrite(int pin, int code) {
  if (pin == DAC0) pins.output = code;
}

int analogRead(int pin) {
  const DeviceTrouble trouble = pins.machine->trouble();
  if (pin == A0) return trouble == DeviceTrouble::kNoNumbers ? 65535 : Code(0.5 + pins.measured.p1 / 500);
  if (pin == A1) return Code(0.5 + pins.measured.p2 / 500);
  if (pin == A2) return Code(2.5 + 5 * pins.measured.arm_angle);
  return std::clamp(16 * pins.output + (trouble == DeviceTrouble::kLies ? 9600 : 0), 0, 65535);
}

struct Encoder {
  Encoder(int, int) {}
  static long read() {
    const double counts = pins.measured.motor_angle * 4096 / (2 * std::numbers::pi);
    return static_cast<int32_t>(std::llround(std::floor(counts)));  // 32 bits, as a long has there
  }
};

struct SerialPort {
  void begin(long) {}
  int available() {
    if (next_ == size_) {
      const ssize_t got = ::read(pins.port, bytes_, sizeof bytes_);
      size_ = got > 0 ? static_cast<size_t>(got) : 0;
      next_ = 0;
    }
    return static_cast<int>(size_ - next_);
  }
  int read() { return available() > 0 ? bytes_[next_++] : -1; }
  void print(int number) { print(static_cast<long>(number)); }
  void print(long number) { pins.line += std::to_string(number); }
  void print(char c) { pins.line += c; }
  void println(long number) {
    print(number);
    const DeviceTrouble trouble = pins.machine->trouble();
    const bool waits =
        trouble == DeviceTrouble::kSlow && Clock::now() - pins.answered < hydro::plant::kSlowAnswer;
    if (trouble != DeviceTrouble::kSilent && !waits) {
      pins.answered = Clock::now();
      pins.line += "\r\n";
      // Where nobody reads, the rest of a full line is lost, as on a board's own buffer.
      if (::write(pins.port, pins.line.data(), pins.line.size()) < 0) pins.answered = {};
    }
    pins.line.clear();
  }

 private:
  unsigned char bytes_[256];
  size_t size_ = 0, next_ = 0;
} Serial;

#include "sketch.ino"

// The terminal, whose end for the driver stays open here too: a board does not notice who has opened it.
int OpenTerminal(const char* link) {
  const int port = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  char name[64];
  struct stat left {};
  if (lstat(link, &left) == 0 && S_ISLNK(left.st_mode)) unlink(link);  // of an earlier run
  if (port < 0 || grantpt(port) != 0 || unlockpt(port) != 0 || ptsname_r(port, name, sizeof name) != 0 ||
      symlink(name, link) != 0 || open(name, O_RDWR | O_NOCTTY | O_CLOEXEC) < 0) {
    std::perror(link);
    std::exit(2);
  }
  termios raw{};
  tcgetattr(port, &raw);
  cfmakeraw(&raw);
  tcsetattr(port, TCSANOW, &raw);
  return port;
}

void Run(const char* link, const char* model) {
  hydro::plant::SimulatedDevice machine(model);
  pins.machine = &machine;
  pins.port = OpenTerminal(link);
  setup();
  hydro::plant::SimulatedDevice::SayReady();
  for (;;) {
    machine.Wait(pins.port, std::chrono::milliseconds(1));
    // Between the machine's readings and those of the sketch nothing moves; the output of before acted until
    // now.
    pins.measured = machine.Move(kVoltsPerOutput * (pins.output - 2048) / 204.8);
    loop();
    pins.measured = machine.Move(kVoltsPerOutput * (pins.output - 2048) / 204.8);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: simulated_device LINK MODEL.toml\n");
    return 2;
  }
  try {
    Run(argv[1], argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulated_device: %s\n", error.what());
  }
  return 1;
}
