// Commands without a seal, and invalid motor commands.
#include <array>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::array kMotorCommandRows{
    SafetyRow{
        .id = "forged_command",
        .fault = "a command without the seal of the stack's key (`bus.key_file`)",
        .detected = "its receiver",
        .codes = "unauthenticated_command",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "it is not obeyed; control goes on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "when no more arrive ([security.md](security.md))",
        .tests = "authentication.AuthenticationTest.test_intruder "
                 "authentication.AuthenticationTest.test_another_key "
                 "authentication.AuthenticationTest.test_recording",
        .injected = "second_sender nonfinite_command",
    },
    SafetyRow{
        .id = "motor_command_nonfinite",
        .fault = "motor command not finite",
        .detected = "plant",
        .codes = "nonfinite_motor_command",
        .within = {"where it would have acted", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one",
        .tests = "fault_commands.MotorCommandTest.test_nonfinite "
                 "plant/PlantAppTest.NonFiniteCommandGivesZeroVolts",
        .injected = "nonfinite_command",
    },
    SafetyRow{
        .id = "law_overflows",
        .fault = "eq. (16) overflows: its inputs are finite, the voltage is not",
        .detected = "pressure loop",
        .codes = "nonfinite_motor_command",
        .within = {"the command of that tick", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next finite one",
        .tests = "pressure_ctrl/PressureAppTest.OverflowOfTheLawGivesZeroVolts",
        .not_injected = "readings and references within the limits do not make it overflow",
    },
    SafetyRow{
        .id = "motor_command_excessive",
        .fault = "motor command above T_pmax/k_1",
        .detected = "plant",
        .codes = "excessive_motor_command",
        .within = {"where it would have acted", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, not the amplifier's limit",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one",
        .tests = "fault_commands.MotorCommandTest.test_excessive",
        .injected = "excessive_command",
    },
    SafetyRow{
        .id = "motor_command_future",
        .fault = "motor command for a future tick (a log is being played)",
        .detected = "plant",
        .codes = "future_motor_command",
        .within = {"1 tick", 1},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one, however far away the tick was",
        .tests =
            "fault_commands.MotorCommandTest.test_future fault_commands.MotorCommandTest.test_one_far_tick "
            "plant/PlantAppTest.FutureCommandGivesZeroVolts "
            "plant/PlantFaultsTest.OneFutureCommandDeafensNobody",
        .injected = "huge_tick",
    },
    SafetyRow{
        .id = "far_number",
        .fault = "a command or state with a number that its sender has not reached",
        .detected = "its receiver, as the sender goes on behind it; the plant names it",
        .codes = "repeated_motor_command",
        .within = {"at most `stale_input_s`"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "the last good one stays in force until it is stale",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "by itself: the sender is followed again",
        .tests = "fault_commands.MotorCommandTest.test_one_far_number "
                 "plant/PlantFaultsTest.OneFarNumberDeafensNobody "
                 "pressure_ctrl/PressureAppTest.FarCommandBeforeTheFirstState",
        .injected = "huge_sequence",
    },
    SafetyRow{
        .id = "motor_command_repeated",
        .fault = "motor commands that arrive twice, or after newer ones",
        .detected = "plant",
        .codes = "repeated_motor_command",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text =
            "they are not obeyed and are no sign of life: when nothing newer arrives, 0 V as for a dead loop",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "a second after the last",
        .tests =
            "fault_commands.MotorCommandTest.test_repeated fault_commands.MotorCommandTest.test_reordered "
            "fault_commands.MotorCommandTest.test_tick_goes_back",
        .injected = "repeat:pressure_ctrl overtake:pressure_ctrl replay",
    },
    SafetyRow{
        .id = "two_motor_command_senders",
        .fault = "two senders of motor commands",
        .detected = "plant, with the role, host and process id of both",
        .codes = "second_motor_command_sender",
        .within = {"5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V while both are heard; neither is obeyed",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, `stale_input_s` after the second was last heard; the first is followed",
        .tests = "fault_commands.MotorCommandTest.test_two_senders "
                 "plant/PlantAppTest.SecondCommandSenderGivesZeroVolts",
        .injected = "second_sender insider",
    },
};

}  // namespace

std::span<const SafetyRow> MotorCommandRows() { return kMotorCommandRows; }

}  // namespace hydro::process
