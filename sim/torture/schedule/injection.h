// One injected fault of a schedule.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace hydro::torture {

// The kinds of fault. fault_kinds.cc describes what the numbers of each mean.
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
  kSet,  // changes of values by hydro-set
  // Another stack on the same network.
  kForeignStop,
  kSecondPlant,
  // A sender of messages that no process of the stack would send.
  kSecondSender,
  kSecondReference,  // sends pressure commands
  kInsider,          // a sender that has the key
  kReplay,
  kHugeSequence,
  kHugeTick,
  kNonfiniteCommand,
  kExcessiveCommand,
  // The launcher, where one runs, and faults that only it ends.
  kLongHang,
  kLauncherCrash,
  kInterrupt,
  // Commands and requests that no process of the stack would send.
  kNonfiniteReference,
  kStrangeRequest,  // for other values
  kTornSet,         // hydro-set while a controller stands still
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

// The kinds from here on need a launcher, so a run without one has none of them.
inline constexpr FaultKind kFirstOfLauncher = FaultKind::kLongHang;
// The kinds from here on are drawn in addition to the others, from a stream of their own.
inline constexpr FaultKind kFirstOfMore = FaultKind::kNonfiniteReference;

struct Injection {
  double at_s = 0;
  FaultKind kind = FaultKind::kLoss;
  int target = -1;  // a role's number, or -1: all
  double duration_s = 0;
  double amount = 0;  // its meaning depends on the kind
  uint64_t seed = 0;  // of its own random numbers
};

// Describes a kind and the numbers that it takes.
struct FaultKindInfo {
  FaultKind kind;
  std::string_view name;     // its name in schedules
  std::string_view targets;  // roles that it may hit, as "plant pressure_ctrl"; "all" is one of them
  double shortest_s = 0;     // range of the duration
  double longest_s = 0;
  double least = 0;  // range of the amount
  double most = 0;
  std::string_view amount;             // meaning of the amount; empty: there is none
  std::string_view knee_targets = {};  // the same for the other joint, in runs of a limb
};

// One for each kind, in the order of FaultKind.
std::span<const FaultKindInfo> FaultKinds();
inline const FaultKindInfo& InfoOf(FaultKind kind) { return FaultKinds()[static_cast<size_t>(kind)]; }

// The targets in this run's stack and in the knee.
std::string TargetsOf(const FaultKindInfo& info);

// "plant", "pressure_ctrl", ..., "all".
std::string_view TargetName(int target);
std::optional<int> TargetNamed(std::string_view name);

}  // namespace hydro::torture
