// simulated_device PORT MODEL.toml: a box that answers as the real one does, with this project's model of the
// machine behind it.
#include "plant/driver/simulated_device.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <numbers>

#include "frames.h"

namespace {

using Clock = std::chrono::steady_clock;
using hydro::plant::DeviceTrouble;

constexpr double kVoltsPerOutput = 2;  // the amplifier's, V of eq. (1) per V
constexpr auto kWatchdog =
    std::chrono::milliseconds(500);  // without a command for so long the box goes to zero

Answer AnswerTo(const Command& command, const hydro::model::Measurement& measured, DeviceTrouble trouble) {
  Answer answer{.sequence = command.sequence, .output = command.output};
  // How the sensors are wired: the scales of the configuration are the inverses of these.
  const double inputs[] = {0.5 + measured.p1 / 500, 0.5 + measured.p2 / 500, 0.01 * measured.motor_speed,
                           2.5 + 5 * measured.arm_angle};
  for (int i = 0; i < 4; ++i) answer.inputs[i] = static_cast<float>(std::clamp(inputs[i], -10.0, 10.0));
  const auto count = std::llround(std::floor(measured.motor_angle * 4096 / (2 * std::numbers::pi)));
  answer.count = static_cast<uint32_t>(count) & kHighestCount;
  if (trouble == DeviceTrouble::kNoNumbers) answer.inputs[0] = std::numeric_limits<float>::quiet_NaN();
  if (trouble == DeviceTrouble::kLies) answer.output += 3;
  return answer;
}

void Run(int port, const char* model) {
  hydro::plant::SimulatedDevice device(model);
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(static_cast<uint16_t>(port));
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (bind(socket, reinterpret_cast<sockaddr*>(&here), sizeof here) != 0) {
    std::fprintf(stderr,
                 "simulated_device: port %d of 127.0.0.1 cannot be taken: %s; end what has it, or give "
                 "another one here and in driver.device\n",
                 port, std::strerror(errno));
    std::exit(2);
  }
  device.SayReady();
  double output = 0;
  Clock::time_point commanded = Clock::now(), answered{};
  for (;;) {
    const bool asked = device.Wait(socket, std::chrono::milliseconds(1));
    Command command;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const bool valid = asked &&
                       recvfrom(socket, &command, sizeof command, 0, reinterpret_cast<sockaddr*>(&from),
                                &size) == sizeof command &&
                       command.magic == Command{}.magic;
    if (valid) {
      output = std::clamp(static_cast<double>(command.output), -10.0, 10.0);
      commanded = Clock::now();
    }
    if (Clock::now() - commanded > kWatchdog) output = 0;
    const hydro::model::Measurement measured = device.Move(kVoltsPerOutput * output);
    if (!valid || device.trouble() == DeviceTrouble::kSilent) continue;
    if (device.trouble() == DeviceTrouble::kSlow && Clock::now() - answered < hydro::plant::kSlowAnswer)
      continue;
    answered = Clock::now();
    const Answer answer = AnswerTo(command, measured, device.trouble());
    sendto(socket, &answer, sizeof answer, 0, reinterpret_cast<sockaddr*>(&from), size);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int port = argc == 3 ? std::atoi(argv[1]) : 0;
  if (port < 1 || port > 65535) {
    std::fprintf(stderr, "usage: simulated_device PORT MODEL.toml, PORT from 1 to 65535\n");
    return 2;
  }
  try {
    Run(port, argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulated_device: %s\n", error.what());
  }
  return 1;
}
