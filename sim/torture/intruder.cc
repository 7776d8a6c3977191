// The injected faults that send messages: the operator's requests, another stack on the network, and an
// intruder who has listened and sends what no process of the stack would.
#include <algorithm>
#include <cmath>
#include <hydro/arm_plan_t.hpp>
#include <hydro/tuning_request_t.hpp>
#include <limits>

#include "sim/torture/active_fault.h"

namespace hydro::torture {

namespace {

// Sends a command for the newest plant's tick, from a process that does not belong to the stack.
template <class Command>
Command OfAnother(const PlantRecord* plant, uint64_t session, int64_t sequence) {
  Command command{};
  command.tick = plant != nullptr ? plant->tick : 0;
  command.session = static_cast<int64_t>(session);
  command.sequence = sequence;
  return command;
}

}  // namespace

// A second launch ends its own run, whose plant this stack has never heard.
void ActiveFault::SendForeignStop() {
  stop_t stop{};
  stop.tick = -1;
  stop.session = static_cast<int64_t>(random_.Next() >> 1) + 1;
  stop.addressee = static_cast<int64_t>(random_.Next() >> 1) + 1;
  stop.source = "launch";
  stop.reason = "hydro-plant has ended with exit code 1";
  stop.exit_code = 1;
  world_.Forge(stop);
}

void ActiveFault::SendSecondPlant() {
  const auto session = static_cast<int64_t>(injection_.seed) + 77;
  if (sent_ == 0) {
    run_description_t run{};
    run.session = session;
    run.program = "hydro-plant";
    run.host = "elsewhere";
    world_.Forge(run);
  }
  state_t state{};
  state.tick = sent_;
  state.session = session;
  state.sequence = sent_++;
  state.p1 = state.p2 = 100;
  world_.Forge(state);
}

void ActiveFault::SendSecondSender() {
  auto command = OfAnother<motor_command_t>(world_.observer().newest_plant(), injection_.seed + 99, sent_++);
  command.voltage = injection_.amount;
  world_.Forge(command);
}

void ActiveFault::SendSecondReference() {
  auto command =
      OfAnother<pressure_command_t>(world_.observer().newest_plant(), injection_.seed + 111, sent_++);
  command.pressure_ref = injection_.amount;
  world_.Forge(command);
}

void ActiveFault::SendReplay() {
  const auto before = world_.now() - static_cast<TrueTime>(injection_.amount * 1e9);
  if (const Packet* packet = world_.RecordedCommand(before)) world_.ForgeAgain(*packet);
}

void ActiveFault::SendFlood() {
  process_status_t status{};
  status.session = static_cast<int64_t>(random_.Next() >> 1);
  status.role = random_.Chance(0.5) ? "pressure_ctrl" : "logger";
  status.host = "elsewhere";
  status.state = process_status_t::READY;
  status.text = std::string(random_.Index(200), 'x');
  world_.Forge(status);
}

void ActiveFault::SendNonfiniteReference() {
  const Packet* const packet = world_.newest_reference();
  pressure_command_t command;
  if (packet == nullptr || !Decode(*packet, &command)) return;
  ++command.sequence;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  switch (static_cast<int>(injection_.amount)) {
    case 0:
      command.pressure_ref = kNan;
      break;
    case 1:
      command.pressure_ref = kInfinite;
      break;
    case 2:
      command.pressure_ref = -kInfinite;
      break;
    default:
      command.open_loop = true;
      command.voltage = kNan;
      break;
  }
  world_.Forge(command, Origin::kChanged);
}

// Sends a request as hydro-set would, with one thing wrong.
void ActiveFault::SendStrangeRequest() {
  SimulatedProcess* const plant = world_.Find(Role::kPlant);
  const PlantRecord* const record = world_.observer().newest_plant();
  if (plant == nullptr || record == nullptr) return;
  tuning_request_t request{};
  request.tick = record->tick;
  request.session = static_cast<int64_t>(random_.Next() >> 1) + 1;
  request.request = 1;
  request.addressee = plant->identity().session;
  request.kind = tuning_request_t::SET;
  request.source = "nobody";
  request.changes = "position.c2=400";
  constexpr size_t kTooLong = 70'000;
  switch (static_cast<int>(injection_.amount)) {
    case 0:
      request.changes.assign(kTooLong, 'x');
      break;
    case 1:
      request.changes = "position.c2=nan";
      break;
    case 2:
      ++request.addressee;
      break;
    case 3:
      request.kind = 7;
      break;
    case 4:
      request.kind = tuning_request_t::UNDO;
      break;
    case 5:
      request.changes += "\nposition.c2=401";
      break;
    case 6:
      request.tick = std::numeric_limits<int64_t>::min();
      break;
    default:
      request.changes = "limits.arm_angle=1e308\n\xed\xa0\x80=1";
      break;
  }
  world_.Forge(request);
}

// Sends the planner's newest plan in its own or another's name, with one thing wrong.
void ActiveFault::SendWrongPlan() {
  const Packet* const packet = world_.newest_plan();
  arm_plan_t plan;
  if (packet == nullptr || !Decode(*packet, &plan) || plan.count < 2) return;
  ++plan.sequence;
  switch (static_cast<int>(injection_.amount)) {
    case 0:
      std::fill(plan.arm_angle.begin(), plan.arm_angle.end(), 5.0);
      break;
    case 1:
      plan.torque.back() = std::numeric_limits<double>::quiet_NaN();
      break;
    case 2:
      plan.session = static_cast<int64_t>(injection_.seed) + 133;
      plan.sequence = 0;
      break;
    case 3:
      plan.count = 0;
      for (auto* numbers : {&plan.time, &plan.arm_angle, &plan.arm_speed, &plan.torque}) numbers->clear();
      break;
    case 4:
      std::reverse(plan.time.begin(), plan.time.end());
      break;
    case 5:
      plan.sequence = int64_t{1} << 62;
      break;
    default:
      std::fill(plan.arm_speed.begin(), plan.arm_speed.end(), 1e6);
      break;
  }
  world_.Forge(plan, Origin::kChanged);
}

void ActiveFault::SendChangedCommand() {
  const Packet* const packet = world_.RecordedCommand(world_.now());
  motor_command_t command;
  if (packet == nullptr || !Decode(*packet, &command)) return;
  ++command.sequence;
  switch (injection_.kind) {
    case FaultKind::kHugeSequence:
      command.sequence = int64_t{1} << std::lround(injection_.amount);
      break;
    case FaultKind::kHugeTick:
      command.tick += int64_t{1} << std::lround(injection_.amount);
      break;
    case FaultKind::kNonfiniteCommand:
      command.voltage = std::numeric_limits<double>::quiet_NaN();
      break;
    default:
      command.voltage = injection_.amount;
      break;
  }
  world_.Forge(command, Origin::kChanged);
}

}  // namespace hydro::torture
