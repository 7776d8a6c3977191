// The table of the faults that a schedule can inject.
#include <array>

#include "sim/torture/machines/simulated_process.h"
#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {
namespace {

constexpr std::string_view kLoops = "plant pressure_ctrl position_ctrl logger";
constexpr std::string_view kKneeLoops = "knee_plant knee_pressure_ctrl knee_position_ctrl";
constexpr std::string_view kLoopsOrAll = "all plant pressure_ctrl position_ctrl logger";

constexpr std::array<FaultKindInfo, static_cast<size_t>(FaultKind::kCount)> kKinds{{
    {FaultKind::kLoss, "loss", kLoopsOrAll, 0.005, 1.5, 0.01, 1, "probability, per packet that it sends",
     kKneeLoops},
    {FaultKind::kDelay, "delay", kLoopsOrAll, 0.005, 1.5, 0.0002, 0.3, "s, of every packet that it sends",
     kKneeLoops},
    {FaultKind::kRepeat, "repeat", kLoopsOrAll, 0.005, 1.5, 0.0005, 0.5, "s, at most until the repetition",
     kKneeLoops},
    {FaultKind::kOvertake, "overtake", kLoopsOrAll, 0.005, 1.5, 0.0005, 0.3,
     "s, at most that a packet is late", kKneeLoops},
    {FaultKind::kChange, "change", kLoopsOrAll, 0.005, 1.5, 0.001, 0.5, "probability that a bit is wrong",
     kKneeLoops},
    {FaultKind::kPartition, "partition", kLoops, 0.005, 2, 0, 0, "", kKneeLoops},
    {FaultKind::kFlood, "flood", "all", 0.01, 0.5, 100, 20000, "messages a second"},
    {FaultKind::kDrift, "drift", kLoopsOrAll, 0.1, 3, -0.02, 0.02, "s per s"},
    {FaultKind::kWallClockJump, "wall_clock_jump", kLoopsOrAll, 0, 0, -4000, 4000, "s"},
    {FaultKind::kSuspend, "suspend", kLoopsOrAll, 0.001, 2, 0, 0, "", "knee_plant"},
    {FaultKind::kCrash, "crash", kLoops, 0.02, 2, 0, 0, "", kKneeLoops},
    {FaultKind::kHang, "hang", kLoops, 0.002, 2, 0, 0, "", kKneeLoops},
    {FaultKind::kSlow, "slow", kLoops, 0.01, 2, 0.0001, 0.02, "s, later each time", kKneeLoops},
    {FaultKind::kOtherConfiguration, "other_configuration", "pressure_ctrl position_ctrl", 0.5, 6, 0, 0, ""},
    {FaultKind::kOtherVersion, "other_version", "pressure_ctrl position_ctrl logger", 0.5, 6, 0, 0, ""},
    {FaultKind::kLauncherHang, "launcher_hang", "plant", 0.2, 4, 0, 0, ""},
    {FaultKind::kDiskSlow, "disk_slow", "logger", 0.01, 3, 0, 0, ""},
    {FaultKind::kDiskFull, "disk_full", "logger", 0.01, 1, 0, 0, ""},
    {FaultKind::kDiskLie, "disk_lie", "logger", 0, 0, 0, 0, ""},
    {FaultKind::kDiskDelete, "disk_delete", "logger", 0, 0, 0, 0, ""},
    {FaultKind::kSensorNan, "sensor_nan", "plant", 0.001, 0.5, 0, 6, "which sensor"},
    {FaultKind::kSensorStick, "sensor_stick", "plant", 0.001, 1, 0, 6, "which sensor"},
    {FaultKind::kSensorSpike, "sensor_spike", "plant", 0.001, 0.003, 0, 6, "which sensor"},
    {FaultKind::kSensorSaturate, "sensor_saturate", "plant", 0.001, 0.5, 0, 6, "which sensor"},
    {FaultKind::kSensorLie, "sensor_lie", "plant", 0.01, 1, 0, 6, "which sensor"},
    {FaultKind::kStop, "stop", "all", 0, 0, 0, 0, ""},
    {FaultKind::kRearm, "rearm", "plant", 0, 0, 0, 0, ""},
    {FaultKind::kSignal, "signal", kLoops, 0, 0, 0, 0, "", kKneeLoops},
    {FaultKind::kSet, "set", "all", 0, 0, 0, 7.999, "which values, and undo"},
    {FaultKind::kForeignStop, "foreign_stop", "all", 0, 0, 0, 0, ""},
    {FaultKind::kSecondPlant, "second_plant", "all", 0.01, 1, 0, 0, ""},
    {FaultKind::kSecondSender, "second_sender", "all", 0.002, 0.5, -5, 5, "V"},
    {FaultKind::kSecondReference, "second_reference", "all", 0.002, 0.5, -1500, 1500, "psi"},
    {FaultKind::kInsider, "insider", "all", 0.002, 0.5, -5, 5, "V"},
    {FaultKind::kReplay, "replay", "all", 0.002, 0.5, 0.01, 3, "s, how old"},
    {FaultKind::kHugeSequence, "huge_sequence", "all", 0, 0, 40, 62, "power of 2"},
    {FaultKind::kHugeTick, "huge_tick", "all", 0, 0, 4, 62, "power of 2"},
    {FaultKind::kNonfiniteCommand, "nonfinite_command", "all", 0, 0, 0, 0, ""},
    {FaultKind::kExcessiveCommand, "excessive_command", "all", 0, 0, 10.1, 1e6, "V"},
    {FaultKind::kLongHang, "long_hang", kLoops, 4, 12, 0, 0, ""},
    {FaultKind::kLauncherCrash, "launcher_crash", "launcher", 0, 0, 0, 0, ""},
    {FaultKind::kInterrupt, "interrupt", "launcher", 0.001, 2, 1, 3,
     "SIGINTs: 1, or 2, the second when it ends"},
    {FaultKind::kNonfiniteReference, "nonfinite_reference", "all", 0, 0, 0, 3.999,
     "NaN, which infinity, or a voltage"},
    {FaultKind::kStrangeRequest, "strange_request", "all", 0, 0, 0, 7.999, "which text, addressee or kind"},
    {FaultKind::kTornSet, "torn_set", "pressure_ctrl position_ctrl", 0.6, 2, 0, 7.999,
     "which values, and undo"},
    {FaultKind::kWrongPlan, "wrong_plan", "all", 0, 0, 0, 6.999, "what is wrong with it"},
    {FaultKind::kPlannerSilent, "planner_silent", "all", 0.3, 2, 0, 0, ""},
    {FaultKind::kBoardInput, "board_input", "plant", 0.001, 0.5, 0, 6, "which sensor"},
    {FaultKind::kBoardError, "board_error", "plant", 0, 0, 0, 3.999,
     "reading or output, takes the zero or not"},
    {FaultKind::kEncoderLost, "encoder_lost", "plant", 0, 0, 0, 0, ""},
    {FaultKind::kGuardianGone, "guardian_gone", "plant", 0, 0, 0, 0, ""},
}};

constexpr std::array<std::string_view, static_cast<size_t>(Role::kCount)> kRoles{
    "plant",      "pressure_ctrl",      "position_ctrl",     "logger", "operator", "launcher",
    "knee_plant", "knee_pressure_ctrl", "knee_position_ctrl"};

}  // namespace

std::span<const FaultKindInfo> FaultKinds() { return kKinds; }

std::string TargetsOf(const FaultKindInfo& info) {
  return std::string(info.targets) + (info.knee_targets.empty() ? "" : " ") + std::string(info.knee_targets);
}

std::string_view TargetName(int target) { return target < 0 ? "all" : kRoles[static_cast<size_t>(target)]; }

std::optional<int> TargetNamed(std::string_view name) {
  if (name == "all") return -1;
  for (size_t role = 0; role < kRoles.size(); ++role) {
    if (kRoles[role] == name) return static_cast<int>(role);
  }
  return std::nullopt;
}

}  // namespace hydro::torture
