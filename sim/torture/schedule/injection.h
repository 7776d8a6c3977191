// One injected fault of a schedule.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hydro::torture {

// The kinds of fault. fault_kinds.cc says of each what its numbers mean.
enum class FaultKind : uint8_t {
  // The network.
  kLoss,
  kDelay,
  kRepeat,
  kOvertake,
  kChange,
  kPartition,
  kFlood,
  // Clocks.
  kDrift,
  kWallClockJump,
  kSuspend,
  // Processes.
  kCrash,
  kHang,
  kSlow,
  kOtherConfiguration,
  kOtherVersion,
  kLauncherHang,
  // The logger's disk.
  kDiskSlow,
  kDiskFull,
  kDiskLie,
  kDiskDelete,
  // Sensors.
  kSensorNan,
  kSensorStick,
  kSensorSpike,
  kSensorSaturate,
  kSensorLie,
  // The operator.
  kStop,
  kRearm,
  kSignal,
  kSet,  // hydro-set
  // Another stack on the same network.
  kForeignStop,
  kSecondPlant,
  // Somebody who sends what no process of the stack would.
  kSecondSender,
  kSecondReference,  // of pressure commands
  kInsider,          // he has the key
  kReplay,
  kHugeSequence,
  kHugeTick,
  kNonfiniteCommand,
  kExcessiveCommand,
  // The launcher, where one runs, and what only it ends.
  kLongHang,
  kLauncherCrash,
  kInterrupt,
  // Commands and requests that no process of the stack would send.
  kNonfiniteReference,
  kStrangeRequest,  // of other values
  kTornSet,         // hydro-set, while a controller stands still
  // The planner, where one runs.
  kWrongPlan,
  kPlannerSilent,
  // The board, where the plant is a driver.
  kBoardInput,
  kBoardError,
  kEncoderLost,
  kGuardianGone,
  kCount
};

// Those from here on are for a launcher: a run without one has none of them.
inline constexpr FaultKind kFirstOfLauncher = FaultKind::kLongHang;
// Those from here on are drawn beside the others, from a stream of their own.
inline constexpr FaultKind kFirstOfMore = FaultKind::kNonfiniteReference;

struct Injection {
  double at_s = 0;
  FaultKind kind = FaultKind::kLoss;
  int target = -1;  // a role's number, or -1: all
  double duration_s = 0;
  double amount = 0;  // what it means depends on the kind
  uint64_t seed = 0;  // of what it draws itself
};

// What a kind is and which numbers it takes.
struct FaultKindInfo {
  FaultKind kind;
  std::string_view name;     // in schedules
  std::string_view targets;  // roles that it may have, "plant pressure_ctrl"; "all" among them
  double shortest_s = 0;     // range of the duration
  double longest_s = 0;
  double least = 0;  // range of the amount
  double most = 0;
  std::string_view amount;             // what the amount is; empty: none
  std::string_view knee_targets = {};  // the same of the other joint, in runs of a limb
};

// One for each kind, in the order of FaultKind.
std::span<const FaultKindInfo> FaultKinds();
inline const FaultKindInfo& InfoOf(FaultKind kind) { return FaultKinds()[static_cast<size_t>(kind)]; }

// Of this run's stack and of the knee.
std::string TargetsOf(const FaultKindInfo& info);

// "plant", "pressure_ctrl", ..., "all".
std::string_view TargetName(int target);
std::optional<int> TargetNamed(std::string_view name);

}  // namespace hydro::torture
