#include "tools/hydro_log/replay.h"

#include <chrono>
#include <functional>
#include <map>

#include "base/input_error.h"
#include "bus/channels.h"
#include "bus/in_process_bus.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "runs/recorded/compare.h"
#include "tools/hydro_log/device_answers.h"
#include "tools/hydro_log/record_gap.h"
#include "tools/hydro_log/recorded_run.h"

namespace hydro::hydro_log {
namespace {

// Feeds a recorded run to one of our applications in this process.
class Replayer {
 public:
  Replayer(const runs::RunLog& log, double speed, const std::string& role)
      : run_(log, role), speed_(speed), channels_(run_.config().bus.channel_suffix) {}

  const RecordedRun& run() const { return run_; }
  const settings::StackConfig& config() const { return run_.config(); }
  const bus::Channels& channels() const { return channels_; }
  bus::SimulatedClock& clock() { return clock_; }
  bus::InProcessBus& bus() { return bus_; }

  // Sends the states one by one; `before` may send something else first.
  void Feed(const std::function<void(int64_t tick)>& before) {
    run_.Feed(bus_, channels_, speed_,
              {.advance =
                   [this](double elapsed_s) {
                     clock_.AdvanceTo(bus::Clock::TimePoint(std::chrono::duration_cast<bus::Clock::Duration>(
                         std::chrono::duration<double>(elapsed_s))));
                   },
               .before = before,
               .deliver = [this] { Deliver(); },
               .answer = [](const state_t&) { return true; }});
  }

  void Deliver() {
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

 private:
  RecordedRun run_;
  double speed_;
  bus::Channels channels_;
  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
};

ReplayResult Compare(const Replayer& replayer, const runs::RunMessages& recorded,
                     const runs::RunMessages& replayed, size_t answers) {
  ReplayResult result;
  result.states = replayer.run().states();
  result.answers = static_cast<int64_t>(answers);
  result.difference = runs::FirstDifference(recorded, "the record", replayed, "the replay");
  return result;
}

ReplayResult WithGap(ReplayResult result, std::optional<int64_t> gap, int64_t not_compared) {
  result.gap_tick = gap;
  result.not_compared = not_compared;
  return result;
}

ReplayResult ReplayPressure(const runs::RunLog& log, double speed) {
  auto recorded = RecordedMotorCommands(log);
  const auto pressure_commands = ByTick(log.messages.Of<pressure_command_t>());

  Replayer replayer(log, speed, "pressure_ctrl");
  std::optional<int64_t> gap = replayer.run().FirstGap();
  if (const auto lost = FirstWithoutPressureCommand(recorded, pressure_commands);
      lost && (!gap || *lost < *gap)) {
    gap = lost;
  }
  const int64_t not_compared = CutAt(gap, recorded);
  const auto& driver = replayer.config().driver;
  const bool on_device = driver && driver->kind == settings::DriverKind::kFrontEnd &&
                         driver->front_end.mode == settings::FrontEndMode::kLoopOnDevice;
  DeviceAnswers device(replayer.config(), recorded);
  std::optional<pressure_ctrl::PressureApp> app;
  if (on_device) {
    app.emplace(replayer.bus(), replayer.clock(), replayer.config(), device);
  } else {
    app.emplace(replayer.bus(), replayer.clock(), replayer.config());
  }
  std::map<int64_t, motor_command_t> answers;
  replayer.bus().Subscribe<motor_command_t>(replayer.channels().Of<motor_command_t>(),
                                            [&](const motor_command_t& command) {
                                              if (recorded.contains(command.tick))
                                                answers.emplace(command.tick, command);
                                            });
  auto next = pressure_commands.begin();
  replayer.Feed([&](int64_t tick) {
    const auto command = recorded.find(tick);
    if (command == recorded.end()) return;
    for (; next != pressure_commands.end() && next->first <= command->second.pressure_command_tick; ++next) {
      replayer.bus().Publish(replayer.channels().Of<pressure_command_t>(), next->second);
      replayer.Deliver();
    }
  });
  runs::RunMessages record, replay;
  record.Of<motor_command_t>() = Unnumbered(recorded);
  replay.Of<motor_command_t>() = Unnumbered(answers);
  ReplayResult result = WithGap(Compare(replayer, record, replay, recorded.size()), gap, not_compared);
  result.on_device = on_device;
  result.not_judged = device.not_judged();
  return result;
}

ReplayResult ReplayPosition(const runs::RunLog& log, double speed) {
  auto recorded = ByTick(log.messages.Of<pressure_command_t>());
  auto references = ByTick(log.messages.Of<arm_reference_t>());
  if (recorded.empty()) throw InputError(log.file + ": found no pressure commands to compare with");

  Replayer replayer(log, speed, "position_ctrl");
  CutFirstSample(replayer.run(), recorded);
  CutFirstSample(replayer.run(), references);
  const std::optional<int64_t> gap = replayer.run().FirstGap();
  const int64_t not_compared = CutAt(gap, recorded);
  CutAt(gap, references);
  position_ctrl::PositionApp app(replayer.bus(), replayer.clock(), replayer.config());
  std::map<int64_t, pressure_command_t> answers;
  std::map<int64_t, arm_reference_t> answered_references;
  replayer.bus().Subscribe<pressure_command_t>(replayer.channels().Of<pressure_command_t>(),
                                               [&](const auto& command) {
                                                 if (recorded.contains(command.tick))
                                                   answers.emplace(command.tick, command);
                                               });
  replayer.bus().Subscribe<arm_reference_t>(replayer.channels().Of<arm_reference_t>(),
                                            [&](const auto& reference) {
                                              if (references.contains(reference.tick))
                                                answered_references.emplace(reference.tick, reference);
                                            });
  replayer.Feed([](int64_t) {});
  runs::RunMessages record, replay;
  record.Of<pressure_command_t>() = Unnumbered(recorded);
  record.Of<arm_reference_t>() = Unnumbered(references);
  replay.Of<pressure_command_t>() = Unnumbered(answers);
  replay.Of<arm_reference_t>() = Unnumbered(answered_references);
  return WithGap(Compare(replayer, record, replay, recorded.size()), gap, not_compared);
}

}  // namespace

ReplayResult Replay(const runs::RunLog& log, ReplayedController controller, double speed) {
  return controller == ReplayedController::kPressure ? ReplayPressure(log, speed)
                                                     : ReplayPosition(log, speed);
}

}  // namespace hydro::hydro_log
