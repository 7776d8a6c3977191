#include "tools/hydro_log/controller_replay.h"

#include <algorithm>
#include <functional>
#include <map>
#include <thread>

#include "base/input_error.h"
#include "bus/channels.h"
#include "runs/recorded/compare.h"
#include "settings/process_sections.h"
#include "tools/hydro_log/own_controller.h"
#include "tools/hydro_log/record_gap.h"
#include "tools/hydro_log/recorded_run.h"

namespace hydro::hydro_log {
namespace {

using namespace std::chrono_literals;

constexpr auto kStart = 20s;     // an interpreter may need that long to load its modules
constexpr int kUnanswered = 64;  // states that are sent without waiting for an answer: a receiver's buffer
constexpr auto kPause = 2ms;     // after that many states
const bus::Channels kPlain;      // without a suffix, on a network of its own

// One replay through a process. Command is the type of its answers.
template <class Command>
class ControllerReplay {
 public:
  using Commands = std::map<int64_t, Command>;
  using Before = std::function<void(bus::Bus&, int64_t tick)>;

  ControllerReplay(RecordedRun& run, Commands recorded, const ControllerReplayRequest& request)
      : run_(run), recorded_(std::move(recorded)), request_(request) {}

  // `before` sends what came before that state, and is called again when the state is sent again.
  ControllerReplayResult Run(const Before& before, std::optional<int64_t> gap) {
    ControllerReplayResult result;
    const int64_t not_compared = CutAt(gap, recorded_);
    OwnController controller(run_.config(), run_.description(), request_.command, request_.role);
    controller.bus().Subscribe<Command>(
        kPlain.Of<Command>(), [this](const Command& command) { answers_.emplace(command.tick, command); });
    result.failure = controller.AwaitReady(kStart);
    if (!result.failure) {
      controller.bus().Publish(kPlain.Of<run_description_t>(), run_.description());
      result.failure = Feed(controller, before);
    }
    if (!result.failure) result.failure = controller.End(plant_, request_.limit);
    if (result.failure) return result;
    result.replay.states = run_.states();
    result.replay.answers = static_cast<int64_t>(recorded_.size());
    result.replay.difference = Difference();
    result.replay.gap_tick = gap;
    result.replay.not_compared = not_compared;
    return result;
  }

 private:
  std::optional<std::string> Feed(OwnController& controller, const Before& before) {
    std::optional<std::string> failure;
    int unanswered = 0;
    const auto answer = [&](const state_t& state) {
      plant_ = state.session;
      if (!recorded_.contains(state.tick)) {
        if (++unanswered % kUnanswered == 0) std::this_thread::sleep_for(kPause);
        return true;
      }
      unanswered = 0;
      failure = controller.Await([&] { return answers_.contains(state.tick); },
                                 [&] {
                                   before(controller.bus(), state.tick);
                                   controller.bus().Publish(kPlain.Of<state_t>(), state);
                                 },
                                 request_.limit, "answer tick " + std::to_string(state.tick));
      return !failure;
    };
    run_.Feed(controller.bus(), kPlain, request_.speed,
              {.advance = [](double) {},
               .before = [&](int64_t tick) { before(controller.bus(), tick); },
               .deliver = [] {},
               .answer = answer});
    return failure;
  }

  std::optional<std::string> Difference() {
    std::erase_if(answers_, [this](const auto& answer) { return !recorded_.contains(answer.first); });
    runs::RunMessages record, replay;
    record.Of<Command>() = Unnumbered(recorded_);
    replay.Of<Command>() = Unnumbered(answers_);
    return runs::FirstDifference(record, "the record", replay, "the replay");
  }

  RecordedRun& run_;
  Commands recorded_, answers_;
  const ControllerReplayRequest& request_;
  int64_t plant_ = 0;  // session
};

ControllerReplayResult ReplayPosition(const runs::RunLog& log, const ControllerReplayRequest& request) {
  auto recorded = ByTick(log.messages.Of<pressure_command_t>());
  if (recorded.empty()) throw InputError(log.file + ": found no pressure commands to compare with");
  RecordedRun run(log, request.role);
  CutFirstSample(run, recorded);
  ControllerReplay<pressure_command_t> replay(run, std::move(recorded), request);
  return replay.Run([](bus::Bus&, int64_t) {}, run.FirstGap());
}

ControllerReplayResult ReplayPressure(const runs::RunLog& log, const ControllerReplayRequest& request) {
  const auto recorded = RecordedMotorCommands(log);
  const auto pressure_commands = ByTick(log.messages.Of<pressure_command_t>());
  RecordedRun run(log, request.role);
  std::optional<int64_t> gap = run.FirstGap();
  const auto lost = FirstWithoutPressureCommand(recorded, pressure_commands);
  if (lost && (!gap || *lost < *gap)) gap = lost;
  // If the loop does not say which pressure command it used, it is assumed to have used the newest of an
  // earlier tick, as in lockstep.
  const bool says = std::any_of(recorded.begin(), recorded.end(),
                                [](const auto& entry) { return entry.second.pressure_command_tick > 0; });
  auto next = pressure_commands.begin();
  int64_t last = -1;  // tick
  const auto before = [&](bus::Bus& bus, int64_t tick) {
    const auto command = recorded.find(tick);
    if (command == recorded.end()) return;
    if (tick == last && next != pressure_commands.begin()) --next;  // lost perhaps, so it is sent again
    last = tick;
    const int64_t newest = says ? command->second.pressure_command_tick : tick - 1;
    for (; next != pressure_commands.end() && next->first <= newest; ++next) {
      bus.Publish(kPlain.Of<pressure_command_t>(), next->second);
    }
  };
  ControllerReplay<motor_command_t> replay(run, recorded, request);
  return replay.Run(before, gap);
}

}  // namespace

ControllerReplayResult ReplayController(const runs::RunLog& log, const ControllerReplayRequest& request) {
  return request.role == "pressure_ctrl" ? ReplayPressure(log, request) : ReplayPosition(log, request);
}

std::string OwnProgramOf(const runs::RunLog& log, const std::string& role) {
  const settings::StackConfig config = RecordedRun(log, "").config();
  const settings::ProcessSection* own = settings::OwnProgramFor(config, role);
  return own == nullptr ? "" : settings::NameOf(*own);
}

std::string OwnRoleOf(const runs::RunLog& log) {
  const bool pressure = !OwnProgramOf(log, "pressure_ctrl").empty();
  const bool position = !OwnProgramOf(log, "position_ctrl").empty();
  if (pressure == position) return "";
  return pressure ? "pressure_ctrl" : "position_ctrl";
}

}  // namespace hydro::hydro_log
