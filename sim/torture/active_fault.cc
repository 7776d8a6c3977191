#include "sim/torture/active_fault.h"

#include <algorithm>
#include <csignal>
#include <limits>

namespace hydro::torture {

bool ActiveFault::BeginOnNetwork() {
  LinkFault fault;
  fault.sender = injection_.target;
  fault.random = Random(injection_.seed);
  const auto amount_ns = static_cast<int64_t>(injection_.amount * 1e9);
  switch (injection_.kind) {
    case FaultKind::kLoss:
      fault.loss = injection_.amount;
      break;
    case FaultKind::kDelay:
      fault.delay_ns = amount_ns;
      break;
    case FaultKind::kRepeat:
      fault.repeat = 0.3;
      fault.delay_ns = amount_ns;
      break;
    case FaultKind::kOvertake:
      fault.overtake = 0.3;
      fault.delay_ns = amount_ns;
      break;
    case FaultKind::kChange:
      fault.change = injection_.amount;
      break;
    case FaultKind::kPartition: {
      fault.loss = 1;
      fault.spares_itself = true;
      LinkFault back = fault;
      back.sender = kEveryone;
      back.receiver = injection_.target;
      links_.push_back(world_.network().BeginFault(back));
      break;
    }
    default:
      return false;
  }
  links_.push_back(world_.network().BeginFault(fault));
  return true;
}

bool ActiveFault::BeginOnMachine() {
  const auto for_each = [&](auto&& act) {
    if (injection_.target != kEveryone) {
      act(role());
      return;
    }
    for (int role = 0; role < static_cast<int>(Role::kOperator); ++role) act(static_cast<Role>(role));
  };
  switch (injection_.kind) {
    case FaultKind::kDrift:
      for_each([&](Role each) {
        world_.MachineOf(each).SetDrift(static_cast<int64_t>(injection_.amount * 1e9));
        world_.ClockChanged(each);
      });
      return true;
    case FaultKind::kWallClockJump:
      for_each(
          [&](Role each) { world_.MachineOf(each).JumpUtc(static_cast<int64_t>(injection_.amount * 1e9)); });
      return true;
    case FaultKind::kSuspend:
      for_each([&](Role each) { world_.Suspend(each, end()); });
      return true;
    case FaultKind::kDiskSlow:
      world_.disk().SetSlow(true);
      return true;
    case FaultKind::kDiskFull:
      world_.disk().SetFull(true, random_);
      world_.NoteLogFault(&LogRecord::was_full);
      return true;
    case FaultKind::kDiskLie:
      if (world_.Find(Role::kLogger) != nullptr && world_.disk().Lie(random_)) world_.NoteLie();
      return true;
    case FaultKind::kDiskDelete:
      if (world_.Find(Role::kLogger) != nullptr) world_.DeleteLog();
      return true;
    case FaultKind::kSensorNan:
    case FaultKind::kSensorStick:
    case FaultKind::kSensorSpike:
    case FaultKind::kSensorSaturate:
    case FaultKind::kSensorLie:
    case FaultKind::kBoardInput:
      world_.sensor_faults().push_back(
          {injection_.kind, static_cast<size_t>(std::clamp(injection_.amount, 0.0, 5.0)), false, 0});
      return true;
    default:
      return false;
  }
}

void ActiveFault::BeginOnProcess() {
  SimulatedProcess* const process = injection_.target < 0 ? nullptr : world_.Find(role());
  switch (injection_.kind) {
    case FaultKind::kCrash:
      world_.Kill(role(), end());
      break;
    case FaultKind::kOtherConfiguration:
    case FaultKind::kOtherVersion:
      world_.StartWith(role(), injection_.kind == FaultKind::kOtherVersion ? &world_.stacks().other_version
                                                                           : &world_.stacks().other);
      world_.Kill(role(), world_.now() + 20'000'000);
      break;
    case FaultKind::kHang:
    case FaultKind::kLongHang:
      if (process != nullptr) process->FreezeUntil(end());
      break;
    case FaultKind::kLauncherHang:
      world_.has_launcher() ? world_.HangLauncher(end()) : void(++world_.launcher_hangs());
      break;
    case FaultKind::kLauncherCrash:
      world_.KillLauncher();
      break;
    case FaultKind::kInterrupt:
      world_.InterruptLauncher();
      break;
    case FaultKind::kSlow:
      if (process != nullptr) process->SetSlowness(static_cast<int64_t>(injection_.amount * 1e9));
      break;
    case FaultKind::kSignal:
      if (process != nullptr) process->Signal(SIGTERM);
      break;
    case FaultKind::kTornSet:
      if (process != nullptr) process->FreezeUntil(end());
      break;
    case FaultKind::kPlannerSilent:
      world_.SilencePlanner(end());
      break;
    default:
      break;
  }
}

bool ActiveFault::BeginOnBoard() {
  BoardFaults& board = world_.board();
  switch (injection_.kind) {
    case FaultKind::kBoardError: {
      const auto which = static_cast<int>(injection_.amount);
      (which % 2 == 0 ? board.refuses_reading : board.refuses_output) = true;
      board.refuses_zero = which >= 2;
      return true;
    }
    case FaultKind::kEncoderLost:
      board.encoder_lost = true;
      return true;
    case FaultKind::kGuardianGone:
      board.guardian_gone = true;
      return true;
    default:
      return false;
  }
}

void ActiveFault::Begin() {
  if (injection_.target >= 0 && IsOfKnee(role()) && !world_.has_knee()) return;
  if (!BeginOnNetwork() && !BeginOnMachine() && !BeginOnBoard()) BeginOnProcess();
}

std::optional<int64_t> ActiveFault::Continue() {
  switch (injection_.kind) {
    case FaultKind::kStop:
      world_.SendStop();
      return std::nullopt;
    case FaultKind::kInsider:
      // In every fifth of these faults, the sequence numbers end at the largest possible number.
      world_.SendInsider(injection_.amount, injection_.duration_s,
                         injection_.seed % 5 == 4 ? std::numeric_limits<int64_t>::max() - 20 : 0);
      return std::nullopt;
    case FaultKind::kForeignStop:
      SendForeignStop();
      return std::nullopt;
    case FaultKind::kRearm:
      world_.SendRearm();
      return std::nullopt;
    case FaultKind::kSet:
    case FaultKind::kTornSet:
      world_.SendSet(static_cast<int>(injection_.amount));
      return std::nullopt;
    case FaultKind::kHugeSequence:
    case FaultKind::kHugeTick:
    case FaultKind::kNonfiniteCommand:
    case FaultKind::kExcessiveCommand:
      SendChangedCommand();
      return std::nullopt;
    case FaultKind::kNonfiniteReference:
      SendNonfiniteReference();
      return std::nullopt;
    case FaultKind::kStrangeRequest:
      SendStrangeRequest();
      return std::nullopt;
    case FaultKind::kWrongPlan:
      SendWrongPlan();
      return std::nullopt;
    case FaultKind::kFlood:
      SendFlood();
      return static_cast<int64_t>(1e9 / std::max(1.0, injection_.amount));
    case FaultKind::kSecondPlant:
      SendSecondPlant();
      return 5'000'000;
    case FaultKind::kSecondSender:
      SendSecondSender();
      return 1'000'000;
    case FaultKind::kSecondReference:
      SendSecondReference();
      return 1'000'000;
    case FaultKind::kReplay:
      SendReplay();
      return 1'000'000;
    default:
      return std::nullopt;
  }
}

void ActiveFault::End() {
  for (const int link : links_) world_.network().EndFault(link);
  links_.clear();
  if (injection_.kind == FaultKind::kDrift) {
    for (int each = 0; each < static_cast<int>(Role::kOperator); ++each) {
      if (injection_.target != kEveryone && injection_.target != each) continue;
      world_.MachineOf(static_cast<Role>(each)).SetDrift(0);
      world_.ClockChanged(static_cast<Role>(each));
    }
  }
  std::vector<SensorFault>& sensors = world_.sensor_faults();
  const auto sensor = std::find_if(sensors.begin(), sensors.end(),
                                   [&](const SensorFault& fault) { return fault.kind == injection_.kind; });
  if (sensor != sensors.end()) sensors.erase(sensor);
  if (injection_.kind == FaultKind::kSlow) {
    if (SimulatedProcess* process = world_.Find(role())) process->SetSlowness(0);
  }
  if (injection_.kind == FaultKind::kDiskSlow) world_.disk().SetSlow(false);
  if (injection_.kind == FaultKind::kDiskFull) world_.disk().SetFull(false, random_);
  if (injection_.kind == FaultKind::kLauncherHang && !world_.has_launcher()) --world_.launcher_hangs();
  if (injection_.kind == FaultKind::kInterrupt && injection_.amount >= 2) world_.InterruptLauncher();
  if (injection_.kind == FaultKind::kOtherConfiguration || injection_.kind == FaultKind::kOtherVersion) {
    world_.StartWith(role(), nullptr);
    world_.Kill(role(), world_.now() + 20'000'000);
  }
}

}  // namespace hydro::torture
