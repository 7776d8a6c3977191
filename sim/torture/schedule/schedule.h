// What happens to a stack in one run, and when. It holds everything on which a run depends, as text that
// people can read and `hydro-torture --replay` can run.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::torture {

// One injected fault of a schedule.

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

struct Schedule {
  uint64_t seed = 1;            // seed of latencies, clocks, sessions and start times
  bool lockstep = false;        // time.mode
  bool key = false;             // messages are sealed
  bool logger = false;          // a logger records; otherwise there is none, and its faults do nothing
  bool logger_required = true;  // logger.required
  bool launcher =
      false;  // a launcher starts, watches and stops the others; otherwise each is restarted by itself
  bool driver = false;   // the plant is a driver with a simulated board
  bool planner = false;  // a planner sets the arm's reference: reference.kind
  bool limb = false;     // the stack is a joint, the hip, of a limb whose knee has processes of its own
  bool explicit_rearm = false;        // limits.rearm
  double stale_input_s = 0.1;         // limits.stale_input_s
  double faults_until_s = 12;         // by which all faults have ended
  std::vector<Injection> injections;  // sorted by time
};

// Draws a schedule.
Schedule DrawSchedule(uint64_t seed);

// One line for the run and one for every injection.
std::string ScheduleText(const Schedule& schedule);

// Reads ScheduleText(); throws InputError that names `file` and the line.
Schedule ReadSchedule(const std::string& file, const std::string& text);

}  // namespace hydro::torture
