// Invalid pressure commands.
#include <array>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::array kPressureCommandRows{
    SafetyRow{
        .id = "pressure_command_nonfinite",
        .fault = "pressure command not finite",
        .detected = "pressure loop",
        .codes = "nonfinite_pressure_command",
        .within = {"5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one",
        .tests = "fault_commands.PressureCommandTest.test_nonfinite",
        .injected = "nonfinite_reference",
    },
    SafetyRow{
        .id = "pressure_command_excessive",
        .fault = "pressure command above `limits.arm_torque` / k_2",
        .detected = "pressure loop",
        .codes = "excessive_pressure_command",
        .within = {"5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one",
        .tests = "fault_commands.PressureCommandTest.test_excessive "
                 "pressure_ctrl/PressureAppTest.ExcessivePressureReferenceGivesZeroVolts",
        .injected = "change:position_ctrl",
    },
    SafetyRow{
        .id = "pressure_command_future",
        .fault = "pressure command far in the future",
        .detected = "pressure loop",
        .codes = "future_pressure_command",
        .within = {"5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one",
        .tests = "fault_commands.PressureCommandTest.test_future "
                 "pressure_ctrl/PressureAppTest.FuturePressureCommandGivesZeroVolts",
        .injected = "change:position_ctrl",
    },
    SafetyRow{
        .id = "pressure_command_repeated",
        .fault = "pressure commands that arrive twice, or after newer ones",
        .detected = "pressure loop",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text =
            "they are not obeyed; when nothing newer arrives, the one in force becomes stale, as for a dead "
            "position loop",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "by itself, with the next pressure command",
        .tests = "fault_commands.PressureCommandTest.test_repeated",
        .injected = "repeat:position_ctrl overtake:position_ctrl",
    },
    SafetyRow{
        .id = "two_pressure_command_senders",
        .fault = "two senders of pressure commands",
        .detected = "pressure loop, with the role, host and process id of both",
        .codes = "second_pressure_command_sender",
        .within = {"5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V while both are heard; neither is obeyed",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, `stale_input_s` after the second was last heard; the first is followed",
        .tests = "fault_commands.PressureCommandTest.test_two_senders",
        .injected = "change:position_ctrl second_reference",
    },
};

}  // namespace

std::span<const SafetyRow> PressureCommandRows() { return kPressureCommandRows; }

}  // namespace hydro::process
