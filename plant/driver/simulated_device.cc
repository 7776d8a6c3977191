#include "plant/driver/simulated_device.h"

#include <poll.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

#include "settings/model_file.h"

namespace hydro::plant {
namespace {

constexpr std::pair<const char*, DeviceTrouble> kTroubles[] = {{"none", DeviceTrouble::kNone},
                                                               {"silent", DeviceTrouble::kSilent},
                                                               {"nan", DeviceTrouble::kNoNumbers},
                                                               {"lies", DeviceTrouble::kLies},
                                                               {"slow", DeviceTrouble::kSlow}};

constexpr size_t kLongestOrder = 100;  // no word is longer

void Say(const std::string& line) {
  std::puts(line.c_str());
  std::fflush(stdout);
}

}  // namespace

SimulatedDevice::SimulatedDevice(const std::string& model_file)
    : actuator_(settings::LoadModelFile(model_file), {}), start_(std::chrono::steady_clock::now()) {}

void SimulatedDevice::SayReady() { Say("ready"); }

bool SimulatedDevice::Wait(int file, std::chrono::milliseconds patience) {
  pollfd waits[] = {{.fd = file, .events = POLLIN, .revents = 0},
                    {.fd = orders_ ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0}};
  if (poll(waits, 2, static_cast<int>(patience.count())) <= 0) return false;
  if (waits[1].revents != 0) {
    char text[256];
    const ssize_t got = read(STDIN_FILENO, text, sizeof text);
    orders_ = got > 0;
    for (ssize_t i = 0; i < got; ++i) {
      if (text[i] == '\n') {
        Obey(std::exchange(line_, ""));
      } else if (line_.size() < kLongestOrder) {
        line_ += text[i];
      }
    }
  }
  return (waits[0].revents & POLLIN) != 0;
}

void SimulatedDevice::Obey(const std::string& line) {
  if (line == "output") {
    char text[64];
    std::snprintf(text, sizeof text, "output %.17g", voltage_);
    Say(text);
    return;
  }
  for (const auto& [word, trouble] : kTroubles) {
    if (line != word) continue;
    trouble_ = trouble;
    Say("ok");
    return;
  }
  Say("no");
}

model::Measurement SimulatedDevice::Move(double voltage) {
  const std::chrono::duration<double> now = std::chrono::steady_clock::now() - start_;
  if (now.count() > actuator_.time()) actuator_.Advance(voltage_, now.count());
  voltage_ = voltage;
  return actuator_.Measure();
}

}  // namespace hydro::plant
