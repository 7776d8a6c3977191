#include "base/input_error.h"
#include "base/integers.h"
#include "base/units.h"
#include "bus/channels.h"
#include "runs/recorded/message_order.h"
#include "runs/recorded/run_config.h"
#include "runs/recorded/run_table.h"
#include "runs/recorded/senders.h"

namespace hydro::runs {
namespace {

// Walks through the ordered messages of one channel as the rows' ticks increase.
template <class Message>
class Cursor {
 public:
  explicit Cursor(const std::vector<Message>& messages) : messages_(InOrder(messages)) {}

  // The last message with a tick of at most `tick`; null when there is none. `tick` never decreases between
  // calls.
  const Message* LastUpTo(int64_t tick) {
    while (next_ < messages_.size() && messages_[next_]->tick <= tick) ++next_;
    return next_ == 0 ? nullptr : messages_[next_ - 1];
  }
  const Message* At(int64_t tick) {
    const Message* last = LastUpTo(tick);
    return last != nullptr && last->tick == tick ? last : nullptr;
  }

 private:
  std::vector<const Message*> messages_;
  size_t next_ = 0;
};

// The states of one run in tick order, each tick once.
std::vector<const state_t*> OrderedStates(const RunLog& log) {
  if (log.messages.Of<state_t>().empty()) {
    throw InputError(log.file + ": found no message on " + bus::Channels(log.suffix).Of<state_t>() +
                     "; a table needs at least one");
  }
  RequireOneRun(log);
  return InOrder(log.messages.Of<state_t>());
}

std::vector<arm_reference_t> ArmAngleReferences(const RunLog& log) {
  std::vector<arm_reference_t> references;
  for (const arm_reference_t& reference : log.messages.Of<arm_reference_t>()) {
    if (reference.signal == arm_reference_t::ARM_ANGLE) references.push_back(reference);
  }
  return references;
}

// The commands without those that only end the run, which may share the last tick with a command that is
// meant to act.
std::vector<motor_command_t> ActingCommands(const RunLog& log) {
  std::vector<motor_command_t> commands;
  for (const motor_command_t& command : log.messages.Of<motor_command_t>()) {
    if (command.status != motor_command_t::STOPPED) commands.push_back(command);
  }
  return commands;
}

// Whether the log lacks states between the two. If it does, the voltage that acted at the end of the gap did
// not act at its beginning.
bool LacksStates(const state_t& state, const state_t& next) {
  return next.sequence > SaturatingSum(state.sequence, 1);
}

double PressureReference(const motor_command_t* motor, const pressure_command_t* pressure) {
  if (motor != nullptr) {
    const bool has_one = motor->pressure_command_tick >= 0 && motor->status != motor_command_t::OPEN_LOOP;
    return has_one ? motor->pressure_ref : tables::kMissing;
  }
  return pressure != nullptr && pressure->open_loop == 0 ? pressure->pressure_ref : tables::kMissing;
}

}  // namespace

std::string RunColumnIn(const UnitSystem& units, const std::string& column) {
  constexpr std::pair<std::string_view, std::string_view> kEndings[] = {
      {"_rad_s", "rad/s"}, {"_rad", "rad"}, {"_psi", "psi"}};
  for (const auto& [ending, paper] : kEndings) {
    if (!column.ends_with(ending)) continue;
    const std::string unit = units.UnitFor(std::string(paper), column.starts_with("arm_") ? 1 : 0);
    return column.substr(0, column.size() - ending.size()) + "_" + UnitInName(unit);
  }
  return column;
}

tables::Table ExportRun(const RunLog& log) {
  const std::vector<const state_t*> states = OrderedStates(log);
  const std::vector<run_description_t>& descriptions = log.messages.Of<run_description_t>();
  const int delay = descriptions.empty() ? 1 : CommandDelayTicks(descriptions.front(), log.file);

  tables::Table table;
  table.file = log.file;
  for (const char* name : kRunColumns) {
    table.columns.push_back({name, {}});
    table.columns.back().values.reserve(states.size());
  }
  const std::vector<motor_command_t> commands = ActingCommands(log);
  const std::vector<arm_reference_t> references = ArmAngleReferences(log);
  Cursor<motor_command_t> acting(commands);
  Cursor<motor_command_t> motor(commands);
  Cursor<pressure_command_t> pressure(log.messages.Of<pressure_command_t>());
  Cursor<arm_reference_t> reference(references);
  const bool sampled = SampleTicks(log.messages) > 1;
  for (size_t k = 0; k < states.size(); ++k) {
    const state_t& state = *states[k];
    const int64_t commanding_tick = SaturatingDifference(state.tick, delay);
    const state_t* const next = k + 1 < states.size() ? states[k + 1] : nullptr;
    double voltage = tables::kMissing;
    if (sampled) {
      voltage = state.voltage;  // no sample tells what acted from this tick on; this acted up to it
    } else if (next != nullptr && !LacksStates(state, *next)) {
      voltage = next->voltage;
    } else if (const motor_command_t* command = acting.At(commanding_tick);
               command != nullptr && next == nullptr && (k == 0 || state.command_tick >= 0)) {
      voltage = command->voltage;  // unless the plant holds zero; before a gap it may be late
    }
    const arm_reference_t* arm = reference.LastUpTo(state.tick);
    // Like any command, a pressure command of tick k is in force from tick k + delay on.
    const double values[] = {state.time,
                             static_cast<double>(state.tick),
                             voltage,
                             PressureReference(motor.At(state.tick), pressure.LastUpTo(commanding_tick)),
                             arm != nullptr ? arm->value : tables::kMissing,
                             state.motor_angle,
                             state.motor_speed,
                             state.arm_angle,
                             state.arm_speed,
                             state.p1,
                             state.p2};
    static_assert(std::size(values) == kRunColumns.size());
    for (size_t column = 0; column < std::size(values); ++column)
      table.columns[column].values.push_back(values[column]);
  }
  return table;
}

}  // namespace hydro::runs
