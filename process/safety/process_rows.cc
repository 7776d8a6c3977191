// Processes that die, hang, come too late or do not match the others.
#include <array>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::array kProcessRows{
    SafetyRow{
        .id = "pressure_loop_dies",
        .fault = "pressure loop dies",
        .detected = "plant: its states go unanswered",
        .codes = "stale_motor_command",
        .within = {"`stale_input_s` + 5 ticks", 5, "stale_input_s"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, in the tick in which it is detected",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when a pressure loop answers",
        .tests =
            "fault_loops.FaultLoopsTest.test_pressure_loop_dies fault_loops.FaultLoopsTest.test_five_ticks "
            "plant/PlantFaultsTest.FiveTicks",
        .injected = "crash:pressure_ctrl",
    },
    SafetyRow{
        .id = "pressure_loop_hangs",
        .fault = "pressure loop hangs, then goes on",
        .detected = "plant: its states go unanswered; late answers to old ones do not count",
        .codes = "stale_motor_command",
        .within = {"`stale_input_s` + 5 ticks", 5, "stale_input_s"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the first timely answer",
        .tests = "fault_loops.FaultLoopsTest.test_pressure_loop_hangs",
        .injected = "hang:pressure_ctrl suspend:pressure_ctrl",
    },
    SafetyRow{
        .id = "pressure_loop_late",
        .fault = "pressure loop answers too late",
        .detected = "plant: the age of what is answered, in ticks",
        .codes = "stale_motor_command",
        .within = {"`stale_input_s` + 5 ticks", 5, "stale_input_s"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the first timely answer",
        .tests = "fault_commands.MotorCommandTest.test_late "
                 "plant/PlantAppTest.RealtimeAnswersToOldStatesGiveZeroVolts",
        .injected = "delay:pressure_ctrl",
    },
    SafetyRow{
        .id = "position_loop_gone",
        .fault = "position loop dies, hangs, or is late",
        .detected = "pressure loop, by ticks",
        .codes = "stale_pressure_command",
        .within = {"exactly `stale_input_s` + a sample + the command's delay"},
        .output = SafeOutput::kReferenceRamped,
        .output_text =
            "the last pressure reference is held until then, falls linearly to zero over "
            "`limits.pressure_ramp_s` (0.2 s), then 0 V. A reference of signal `voltage` is not ramped: 0 V "
            "at once",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next pressure command",
        .tests = "fault_loops.FaultLoopsTest.test_position_loop_dies "
                 "fault_loops.FaultLoopsTest.test_position_loop_hangs "
                 "fault_commands.PressureCommandTest.test_late "
                 "pressure_ctrl/PressureAppTest.StaleVoltageGivesZeroVolts",
        .injected = "crash:position_ctrl hang:position_ctrl suspend:position_ctrl "
                    "delay:position_ctrl",
    },
    SafetyRow{
        .id = "plant_dies",
        .fault = "plant or driver dies",
        .detected = "pressure loop",
        .codes = "stale_state",
        .within = {"`stale_input_s` + one turn of its loop (20 ms)", {}, "stale_input_s"},
        .output = SafeOutput::kZeroVolts,
        .output_text =
            "one command of 0 V. The driver's output: 0 V by its guardian, else by the hardware watchdog "
            "([hardware.md](hardware.md)), or that of the front end",
        .restart = Cleared::kByItself,
        // A process that is started anew has nothing latched.
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "by itself, when a plant is back; with `\"explicit\"` too: somebody has started it",
        .tests =
            "fault_loops.FaultLoopsTest.test_plant_dies driver.WaysOutTest.test_guardian "
            "driver.LaunchedDriverTest.test_killed front_end.LastLineTest.test_killed "
            "front_end.LastLineTest.test_killed_on_a_terminal front_end.LastLineTest.test_killed_on_a_socket",
        .injected = "crash:plant",
    },
    SafetyRow{
        .id = "plant_hangs",
        .fault = "plant or driver hangs, then goes on",
        .detected = "pressure loop, by the silence; the plant itself, when it goes on",
        .codes = "stale_state late_plant",
        .within = {"the tick in which it goes on", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V until a command that was computed from a state after the hang",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with that command",
        .tests = "fault_loops.FaultLoopsTest.test_plant_hangs "
                 "plant/PlantFaultsTest.LatePlantWaitsForAFreshCommand "
                 "driver.DriverFaultTest.test_hang_is_for_the_watchdog",
        .injected = "hang:plant long_hang:plant",
    },
    SafetyRow{
        .id = "late",
        .fault = "a process wakes late, by less than `stale_input_s`",
        .detected = "itself: `skipped_ticks` in `HYDRO_STATE`, missed deadlines in `HYDRO_LOOP_STATISTICS`",
        .within = {"-"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on; a late plant integrates over the ticks that it has missed",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .tests = "plant/PlantAppTest.LateWakeUpIntegratesWhatItMissed "
                 "timing_stall.StallTest.test_plant timing_stall.StallTest.test_pressure_ctrl "
                 "timing_stall.StallTest.test_position_ctrl",
        .injected = "slow",
    },
    SafetyRow{
        .id = "launcher_hangs",
        .fault =
            "`hydro-launch`, which started the plant or driver, hangs or is stopped (Ctrl-Z at its terminal)",
        .detected = "plant",
        .codes = "supervisor_gone",
        .within = {"`limits.stale_supervisor_s` (1 s)", {}, "stale_supervisor_s"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when it is heard again",
        .tests = "fault_stop.StopTest.test_launcher_is_suspended plant/PlantFaultsTest.SupervisorGone",
        .injected = "launcher_hang:plant",
    },
    SafetyRow{
        .id = "launcher_dies",
        .fault = "`hydro-launch` dies, however that happens",
        .detected = "the kernel, which sends SIGTERM to all that it has started",
        .within = {"at once"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, then all end",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "a new run",
        .tests = "launch/LaunchStopTest.KilledLaunchLeavesNoOrphan",
        .injected = "launcher_crash",
    },
    SafetyRow{
        .id = "other_configuration",
        .fault = "a process that runs with another configuration, model or version",
        .detected = "every process; the plant does not begin a run with it, exit code 1",
        .codes = "other_configuration",
        .within = {"its announcement, before its first command"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "it is not obeyed, and leaves with exit code 1; the rest goes on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "when it has left",
        .tests = "agreement.AgreementTest.test_other_gain agreement.AgreementTest.test_other_limit "
                 "agreement.AgreementTest.test_other_time agreement.AgreementTest.test_other_model "
                 "agreement.AgreementTest.test_late_joiner "
                 "plant/PlantRigTest.CommandsOfAMisconfiguredLoopDoNotAct",
        .injected = "other_configuration:pressure_ctrl other_configuration:position_ctrl other_version",
    },
};

}  // namespace

std::span<const SafetyRow> ProcessRows() { return kProcessRows; }

}  // namespace hydro::process
