// The operator's requests, and what happens to the machine and its clocks.
#include <array>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::array kRunRows{
    SafetyRow{
        .id = "stop",
        .fault = "`HYDRO_STOP` to this run or to everybody (`addressee` 0), from any program or from "
                 "`hydro-launch CONFIG "
                 "--stop`",
        .detected = "every process",
        .within = {"5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, then all end",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "a new run",
        .tests =
            "fault_stop.StopTest.test_any_program fault_stop.StopTest.test_stop_by_hand "
            "fault_stop.StopTest.test_stop_launched fault_stop.StopTest.test_stop_among_poisoned_packets "
            "fault_network.NetworkTest.test_stop_without_network",
        .injected = "stop",
    },
    SafetyRow{
        .id = "signal_to_plant",
        .fault = "SIGINT or SIGTERM to the plant or driver",
        .detected = "itself; it sends `HYDRO_STOP`",
        .within = {"at once"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, then all end",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "a new run",
        .tests = "driver.WaysOutTest.test_stop_signals driver.WaysOutTest.test_ending_signals",
        .injected = "signal:plant",
    },
    SafetyRow{
        .id = "signal_to_launcher",
        .fault = "SIGINT, SIGTERM or SIGHUP to `hydro-launch`; a second SIGINT kills what is left",
        .detected = "itself; it sends `HYDRO_STOP` and SIGTERM",
        .within = {"at once"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, then all end",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "a new run",
        .tests = "launch/LaunchSignalTest.EndsInOrder launch/LaunchStopTest.SecondInterruptKills",
        .injected = "interrupt",
    },
    SafetyRow{
        .id = "signal_to_loop",
        .fault = "SIGINT or SIGTERM to a loop",
        .detected = "itself",
        .within = {"at once"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "a command of 0 V, with which it leaves; the rest goes on, as for a dead loop",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when another one answers",
        .tests = "position_ctrl/PositionAppTest.LeavesWithZeroVolts "
                 "pressure_ctrl/PressureAppTest.FinishesWithZeroVolts",
        .injected = "signal:pressure_ctrl signal:position_ctrl",
    },
    SafetyRow{
        .id = "foreign_stop",
        .fault = "`HYDRO_STOP` to another run",
        .detected = "every process",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "it is no stop: control goes on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .tests = "sharing.SharingTest.test_stop_of_another_run_is_none",
        .injected = "foreign_stop",
    },
    SafetyRow{
        .id = "rearm",
        .fault = "`HYDRO_REARM` while a cause persists, to another run, from a recording, or where nothing "
                 "is latched",
        .detected = "plant",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "it is refused with the reason, and ends nothing",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .tests = "fault_limits.RearmTest.test_refused_while_the_cause_persists "
                 "fault_limits.RearmTest.test_requests_of_another_run "
                 "fault_limits.RearmTest.test_nothing_to_rearm fault_limits.RearmTest.test_no_latched_fault",
        .injected = "rearm",
    },
    SafetyRow{
        .id = "machine_suspended",
        .fault = "the machine was suspended for longer than `stale_input_s`",
        .detected = "plant: CLOCK_BOOTTIME has advanced further than CLOCK_MONOTONIC",
        .codes = "machine_suspended",
        .within = {"1 tick after it wakes", 1},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "the run ends, exit code 1",
        .tests = "plant/PlantFaultsTest.SuspendEndsTheRun plant/PlantFaultsTest.SuspendWaitsForARearm",
        .injected = "suspend:plant",
    },
    SafetyRow{
        .id = "other_joint",
        .fault =
            "in a limb, a fault holds the voltage of another joint at zero, and `limb.on_joint_fault` is "
            "\"all_to_zero\" (its default)",
        .detected = "the limb, in the tick of the fault; a plant or limb in another process by `HYDRO_FAULT`",
        .codes = "other_joint",
        .within = {"5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V of all joints",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "when the other joint's fault has ended, with `\"explicit\"` by a re-arm of that one",
        .tests = "sim/limb/LimbTest.FaultOfOneHoldsTheOthers limb.LimbTest.test_a_fault_of_one_joint",
        .injected = "hang:knee_plant crash:knee_pressure_ctrl",
    },
    SafetyRow{
        .id = "joint_gone",
        .fault =
            "in a limb, a joint of another process or host is no longer heard (it hangs, the cable is out), "
            "and `limb.on_joint_fault` is \"all_to_zero\"",
        .detected = "plant or limb: no state of that joint",
        .codes = "joint_gone",
        .within = {"5 ticks after `limits.stale_input_s` and three intervals of `limb.telemetry_hz`", 5,
                   "limits.stale_input_s"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V of all joints",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when it is heard again",
        .tests = "plant/SilentJointTest.HoldsZeroVolts plant/SilentJointTest.WaitsForARearm "
                 "sim/limb/LimbAppTest.SilenceOfAJointElsewhere limb.LimbCableTest.test_cable_out",
        .injected = "hang:knee_plant partition:knee_plant",
    },
    SafetyRow{
        .id = "wall_clock",
        .fault = "the wall clock is changed",
        .detected = "not at all: no control, limit or watchdog reads it",
        .within = {"-"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on, identical bit by bit",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .tests = "plant/PlantFaultsTest.ClockStepChangesNothing clocks.ClocksTest.test_realtime_forward "
                 "clocks.ClocksTest.test_realtime_back",
        .injected = "wall_clock_jump",
    },
    SafetyRow{
        .id = "drift",
        .fault = "a host's clock runs up to 2 % fast or slow",
        .detected = "not at all: limits in ticks do not know it, others are longer or shorter by as much",
        .within = {"-"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .injected = "drift",
    },
};

}  // namespace

std::span<const SafetyRow> RunRows() { return kRunRows; }

}  // namespace hydro::process
