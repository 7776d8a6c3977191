// simulated_converters URL MODEL.toml RATE: the machine behind the converters of an emulated front end
// (docs/front_end.md, the converter link): an actuator that moves by one period of the device for each
// OUTPUT, and its sensors. Says "ready" once the device is there, then once a second "TICK VOLTS P1 P2
// MOTOR_SPEED ARM_ANGLE", and at each tick in which the voltage becomes zero or ceases to be "zero TICK" or
// "drives TICK". Runs until a signal ends it. On SIGUSR1 it opens the interlock.
//
// How it is wired (the configuration under test must find the scales by itself):
//   analog input 0, 1   p1, p2: transducers of 0 to 2000 psi that give 0.5 to 4.5 V
//   analog input 2      the motor's tachometer, its wires crossed: -0.01 V per rad/s
//   analog input 3      the arm's potentiometer: 2.5 V at mid-stroke, 5 V per rad
//   counter 0           the motor's encoder, 4096 counts a turn, of 24 bits, just below its wrap at the start
//   output              the amplifier, inverting: -2 V of eq. (1) per V
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <thread>
#include <vector>

#include "firmware/frames.h"
#include "model/actuator.h"
#include "plant/front_end/link.h"
#include "settings/model_file.h"

namespace {

using namespace std::chrono_literals;

constexpr double kCountsPerRad = 4096 / (2 * std::numbers::pi);
constexpr uint32_t kCounterMask = 0xFFFFFF;
constexpr int64_t kFirstCount = kCounterMask - 20;

volatile std::sig_atomic_t opened = 0;

class Machine {
 public:
  Machine(const hydro::model::ModelDescription& model, double rate_hz)
      : actuator_(model, {}), rate_hz_(rate_hz) {}

  // The device's tick `tick`: until now the volts that were held acted, from now on these do. What the
  // sensors will read at the next tick follows from them, and has a period to get there: so the device reads
  // what is, like one with converters of its own.
  hydro_converters Answer(const hydro_output& output) {
    if (last_ && output.tick > *last_ + 1) Advance(output.tick - *last_ - 1);
    if ((output.volts == 0) != (volts_ == 0)) {
      std::printf("%s %llu\n", output.volts == 0 ? "zero" : "drives",
                  static_cast<unsigned long long>(output.tick));
      std::fflush(stdout);
    }
    const bool next = !last_ || output.tick != *last_;  // a device that was reset begins at 0
    volts_ = output.volts;
    last_ = output.tick;
    if (next) Advance(1);
    return Converters(output.tick);
  }

  hydro_converters Now() const { return Converters(last_.value_or(0)); }

  hydro_converters Converters(uint64_t tick) const {
    const hydro::model::Measurement measured = actuator_.Measure();
    hydro_converters converters{};
    converters.tick = tick;
    converters.analog_V[0] = static_cast<float>(0.5 + measured.p1 / 500);
    converters.analog_V[1] = static_cast<float>(0.5 + measured.p2 / 500);
    converters.analog_V[2] = static_cast<float>(-0.01 * measured.motor_speed);
    converters.analog_V[3] = static_cast<float>(2.5 + 5 * measured.arm_angle);
    const int64_t count = kFirstCount + std::llround(std::floor(measured.motor_angle * kCountsPerRad));
    converters.counter[0] = static_cast<uint32_t>(count) & kCounterMask;
    converters.read_back_V = volts_;
    converters.interlock = opened == 0 ? 1 : 0;
    return converters;
  }

  void Show() const {
    const hydro::model::Measurement measured = actuator_.Measure();
    std::printf("%llu %.6g %.6g %.6g %.6g %.6g\n", static_cast<unsigned long long>(last_.value_or(0)),
                -2.0 * volts_, measured.p1, measured.p2, measured.motor_speed, measured.arm_angle);
    std::fflush(stdout);
  }

 private:
  void Advance(uint64_t ticks) {
    elapsed_ += ticks;
    actuator_.Advance(-2.0 * volts_, static_cast<double>(elapsed_) / rate_hz_);
  }

  hydro::model::Actuator actuator_;
  double rate_hz_;
  uint64_t elapsed_ = 0;          // of the device's ticks
  std::optional<uint64_t> last_;  // tick
  float volts_ = 0;               // at the terminal
};

class Talk {
 public:
  explicit Talk(const hydro::settings::FrontEndUrl& url) : link_(hydro::plant::MakeLink(url)) {}

  void Open() {
    while (!link_->is_open() && !link_->Open()) std::this_thread::sleep_for(10ms);
  }

  void Send(const hydro_converters& converters) {
    hydro_frame frame{};
    frame.kind = HYDRO_CONVERTERS;
    frame.sequence = sequence_++;
    frame.body.converters = converters;
    uint8_t wire[HYDRO_WIRE_MAX];
    const size_t count = hydro_encode(&frame, wire);
    link_->Write({wire, count});
  }

  // The outputs that have come.
  std::vector<hydro_output> Receive() {
    std::vector<hydro_output> outputs;
    uint8_t bytes[4096];
    const size_t got = link_->Read(bytes);
    hydro_frame frame{};
    for (size_t i = 0; i < got; ++i) {
      if (hydro_receive(&receiver_, bytes[i], &frame) && frame.kind == HYDRO_OUTPUT)
        outputs.push_back(frame.body.output);
    }
    return outputs;
  }

  void Wait(std::chrono::milliseconds most) const {
    pollfd waiting{link_->descriptor(), POLLIN, 0};
    poll(&waiting, 1, static_cast<int>(most.count()));
  }

 private:
  std::unique_ptr<hydro::plant::Link> link_;
  hydro_receiver receiver_{};
  uint32_t sequence_ = 0;
};

void Run(const hydro::settings::FrontEndUrl& url, Machine& machine) {
  Talk talk(url);
  talk.Open();
  bool heard = false;
  auto next_show = std::chrono::steady_clock::now();
  auto next_greeting = next_show;
  while (getppid() != 1) {  // until the test has gone
    talk.Open();
    const auto outputs = talk.Receive();
    for (const hydro_output& output : outputs) talk.Send(machine.Answer(output));
    const auto now = std::chrono::steady_clock::now();
    if (!heard && !outputs.empty()) {
      heard = true;
      std::puts("ready");
      std::fflush(stdout);
    }
    if (!outputs.empty()) next_greeting = now + 500ms;
    if (now >= next_greeting) {  // the device does not know where the machine is, or an emulator sleeps until
                                 // a byte comes
      next_greeting = now + (heard ? 500ms : 50ms);
      talk.Send(machine.Now());
    }
    if (heard && now >= next_show) {
      next_show = now + 1s;
      machine.Show();
    }
    if (outputs.empty()) talk.Wait(10ms);
  }
}

}  // namespace

int main(int argc, char** argv) {
  hydro::settings::FrontEndUrl url;
  if (argc != 4 || !hydro::settings::WhatIsWrongWithFrontEndUrl(argv[1], &url).empty()) {
    std::fprintf(stderr, "usage: simulated_converters URL MODEL.toml RATE\n");
    return 2;
  }
  std::signal(SIGUSR1, [](int) { opened = 1; });
  try {
    Machine machine(hydro::settings::LoadModelFile(argv[2]), std::atof(argv[3]));
    Run(url, machine);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulated_converters: %s\n", error.what());
    return 1;
  }
  return 0;
}
