#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "bus/channels.h"
#include "bus/in_process_bus.h"
#include "launch/logic/stack_watch.h"
#include "logger/logger_app.h"
#include "plant/run_start.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/targets.h"
#include "tests/plant/run_plant.h"
#include "tests/stack_fixture.h"
#include "tune/design/configured_laws.h"

namespace hydro::fuzz {
namespace {

constexpr size_t kMostMessages = 200;

// Takes up to `count` bytes off the front.
class Input {
 public:
  Input(const uint8_t* data, size_t size) : data_(data), left_(size) {}
  size_t left() const { return left_; }
  std::vector<uint8_t> Take(size_t count) {
    count = std::min(count, left_);
    std::vector<uint8_t> bytes(data_, data_ + count);
    data_ += count;
    left_ -= count;
    return bytes;
  }
  uint8_t Byte() {
    const std::vector<uint8_t> byte = Take(1);
    return byte.empty() ? 0 : byte[0];
  }

 private:
  const uint8_t* data_;
  size_t left_;
};

// Sends the next message: a byte for its row in the table of messages, one for the time since the previous
// message, one for the size, and its fields (the type's hash goes before them). Messages in `left_out` are
// not sent.
void SendNext(Input& input, bus::InProcessBus& bus, bus::SimulatedClock& clock,
              std::optional<size_t> left_out) {
  static const bus::Channels channels;
  static const auto hashes = std::apply(
      [](const auto&... row) { return std::array{std::remove_cvref_t<decltype(row)>::Type::getHash()...}; },
      bus::kMessages);
  const size_t row = input.Byte() % hashes.size();
  clock.AdvanceTo(clock.Now() + std::chrono::milliseconds(input.Byte()));
  std::vector<uint8_t> bytes;
  for (int shift = 56; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<uint8_t>(static_cast<uint64_t>(hashes[row]) >> shift));
  }
  const size_t length = input.Byte();
  const std::vector<uint8_t> fields = input.Take(length);
  bytes.insert(bytes.end(), fields.begin(), fields.end());
  if (row != left_out) bus.PublishRaw(channels.names()[row], bytes.data(), static_cast<int>(bytes.size()));
}

// Sends the messages of the input, and calls `poll` after each.
template <class Poll>
void Feed(Input& input, bus::InProcessBus& bus, bus::SimulatedClock& clock, std::optional<size_t> left_out,
          Poll poll) {
  for (size_t count = 0; input.left() > 0 && count < kMostMessages; ++count) {
    SendNext(input, bus, clock, left_out);
    for (int turn = 0; turn < 5 && bus.HandleUntil(clock.Now()) > 0; ++turn) {
    }
    poll();
  }
}

// A bus on which nobody has spoken yet, an hour after the epoch. The input's first byte chooses the stack's
// time.mode; the rest is messages.
struct Stage {
  Stage(const uint8_t* data, size_t size) : input(data, size), config(testing::SmallStack()) {
    spdlog::set_level(spdlog::level::off);
    clock.AdvanceTo(bus::Clock::TimePoint(std::chrono::hours(1)));
    config.time.mode = input.Byte() % 2 == 0 ? settings::TimeMode::kLockstep : settings::TimeMode::kRealtime;
  }

  Input input;
  bus::SimulatedClock clock;
  bus::InProcessBus bus{&clock};
  settings::StackConfig config;
};

}  // namespace

// The controllers answer; their commands must be fit for an amplifier.
void Processes(const uint8_t* data, size_t size) {
  Stage stage(data, size);
  Input& input = stage.input;
  bus::SimulatedClock& clock = stage.clock;
  bus::InProcessBus& bus = stage.bus;
  settings::StackConfig& config = stage.config;
  const double most_volts = design::PressureLawSettingsFor(config).voltage_limit;
  const bus::Channels channels;
  pressure_ctrl::PressureApp pressure(bus, clock, config);
  position_ctrl::PositionApp position(bus, clock, config);
  launch::StackWatch watch(bus, clock, config, true, true);
  plant::RollCall roll_call({"pressure_ctrl"});
  bus.Subscribe<process_status_t>(channels.Of<process_status_t>(),
                                  [&](const process_status_t& status) { roll_call.Observe(status); });
  bus.Subscribe<motor_command_t>(channels.Of<motor_command_t>(), [&](const motor_command_t& command) {
    Promise(std::abs(command.voltage) <= most_volts, "voltages are within what the amplifier takes");
  });
  // Nobody but the loop under test sends motor commands here.
  Feed(input, bus, clock, bus::MessageIndex<motor_command_t>(), [&] {
    pressure.Poll();
    position.Poll();
  });
  watch.summary().Lines();
  watch.NotReady();
  roll_call.Missing();
  pressure.Finish();
  position.Finish();
}

// The plant with its voltage guard hears one message of the input at each state that it sends, re-arm
// requests among them. Nobody else sends states here.
void Plant(const uint8_t* data, size_t size) {
  Stage stage(data, size);
  Input& input = stage.input;
  bus::SimulatedClock& clock = stage.clock;
  bus::InProcessBus& bus = stage.bus;
  settings::StackConfig& config = stage.config;
  config.limits.rearm = settings::Rearm::kExplicit;
  config.limits.pressure_psi = 100.5;  // of the 100 psi at the start: commands exceed it, and latch the fault
  const double most_volts = design::PressureLawSettingsFor(config).voltage_limit;
  plant::SimulatedRig rig(config);
  const bus::Channels channels;
  bus.Subscribe<state_t>(channels.Of<state_t>(), [&](const state_t& state) {
    Promise(std::abs(state.voltage) <= most_volts, "voltages are within what the amplifier takes");
    Promise(std::isfinite(state.p1) && std::isfinite(state.arm_angle), "the plant's state is finite");
    if (input.left() > 0) SendNext(input, bus, clock, bus::MessageIndex<state_t>());
  });
  plant::RunPlant(bus, clock, config, rig);
}

void Recorder(const uint8_t* data, size_t size) {
  Stage stage(data, size);
  logger::LoggerApp logger(stage.bus, stage.clock, stage.config, {"/dev/null"});
  Feed(stage.input, stage.bus, stage.clock, std::nullopt, [&] { logger.Poll(); });
}

}  // namespace hydro::fuzz
