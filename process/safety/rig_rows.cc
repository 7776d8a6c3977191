// Sensors, the board, and readings beyond the limits.
#include <array>
#include <string_view>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::string_view kNoDevice = "a simulated board is driven, no device of one's own and no front end";

constexpr std::array kRigRows{
    SafetyRow{
        .id = "reading_not_finite",
        .fault = "a sensor's reading is not finite",
        .detected = "pressure loop, of pressures and motor speed",
        .codes = "nonfinite_state",
        .within = {"the command of that tick", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one",
        .tests = "fault_commands.StateTest.test_pressures_and_speed "
                 "pressure_ctrl/PressureAppTest.NonFiniteStateGivesZeroVolts",
        .injected = "sensor_nan:plant",
    },
    SafetyRow{
        .id = "angle_not_finite",
        .fault = "the arm angle's reading is not finite",
        .detected = "position loop",
        .codes = "nonfinite_arm_angle",
        .within = {"the command of that sample"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V: an open-loop command of 0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, with the next good one",
        .tests = "fault_commands.StateTest.test_arm_angle "
                 "position_ctrl/PositionAppTest.NonFiniteAngleGivesZeroVolts",
        .injected = "sensor_nan:plant",
    },
    SafetyRow{
        .id = "reading_wrong",
        .fault = "a sensor's reading is wrong but possible: it sticks, jumps or lies within the limits",
        .detected = "not at all",
        .within = {"-"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on with the wrong reading, until a limit is exceeded",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .injected = "sensor_stick:plant sensor_spike:plant sensor_lie:plant",
    },
    SafetyRow{
        .id = "sensor_input",
        .fault = "a sensor's input at an end of its range, outside its allowed readings or what such a "
                 "machine gives, "
                 "or no number",
        .detected = "driver",
        .codes =
            "sensor_p1 sensor_p2 sensor_motor_angle sensor_motor_speed sensor_arm_angle sensor_arm_speed",
        .within = {"the tick in which it is read", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "NaN in the state, 0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, after ten good readings in a row",
        .tests = "driver.DriverFaultTest.test_sensor_faults plant/PlantRigTest.RigFaults "
                 "plant/driver/ComediRigTest.SaturatedInput "
                 "plant/driver/ComediRigTest.PlausibleVolts plant/driver/DeviceRigTest.NoNumber "
                 "plant/driver/DeviceRigTest.OneSilentInput own_driver.OwnDriverTest.test_promises "
                 "plant/front_end/FrontEndRigTest.NoNumberAndNoFault "
                 "plant/front_end/FrontEndLiesTest.ReadingsThatNoMachineGives "
                 "plant/driver/DeviceRigTest.ReadingsThatNoMachineGives",
        .injected = "board_input",
    },
    SafetyRow{
        .id = "device_silent",
        .fault = "a device on a network or bus answers no more, reports a fault of its own, or says what "
                 "cannot be: a state that does not exist, a clock that stands still",
        .detected = "driver",
        .codes = "device_silent device_fault",
        .within = {"`stale_input_s` after its last answer; the tick in which it reports the fault", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "NaN in the state, 0 V, as far as the device still hears it",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when it answers again or is well",
        .tests =
            "own_driver.OwnDriverTest.test_promises plant/driver/DeviceRigTest.SilentDevice "
            "plant/driver/DeviceRigTest.FaultOfTheDevice front_end.LastLineTest.test_unplugged "
            "front_end.LastLineTest.test_reset plant/front_end/FrontEndRigTest.SilentDevice "
            "plant/front_end/FrontEndRigTest.PulledCable plant/front_end/FrontEndRigTest.FaultsOfTheDevice "
            "plant/front_end/FrontEndLiesTest.FieldsThatCannotBe "
            "plant/front_end/FrontEndLiesTest.ClockThatDoesNotGoOn",
        .not_injected = kNoDevice,
    },
    SafetyRow{
        .id = "front_end_hears_nothing",
        .fault = "a front end hears no command: the computer is frozen or loses its power, the cable is cut, "
                 "driver and "
                 "guardian are killed at once",
        .detected = "the front end itself, by its own ticks",
        .within = {"`driver.watchdog_s`, in whole ticks of the device"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by the driver, which arms it again with the next command that is obeyed",
        .tests = "front_end.LastLineTest.test_killed_with_its_guardian front_end.LastLineTest.test_frozen "
                 "front_end.LastLineTest.test_unplugged front_end.LastLineTest.test_explicit_rearm "
                 "plant/front_end/FrontEndRigTest.PulledCable",
        .not_injected = kNoDevice,
    },
    SafetyRow{
        .id = "output_differs",
        .fault = "the output that a device reads back is not what was put out",
        .detected = "driver, where the device says what its output holds",
        .codes = "output_differs",
        .within = {"`stale_input_s` + 5 ticks", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, if the device does as it is told",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when both agree",
        .tests = "own_driver.OwnDriverTest.test_promises plant/driver/DeviceRigTest.OutputDiffers "
                 "plant/front_end/FrontEndRigTest.ReadBack plant/front_end/FrontEndRigTest.OutputDiffers",
        .not_injected = kNoDevice,
    },
    SafetyRow{
        .id = "board_refuses",
        .fault = "the board refuses a reading or an output, a counter jumps",
        .detected = "driver",
        .codes = "board_error encoder_lost",
        .within = {"at once", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, if the board accepts it",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "the run ends, exit code 1, whatever `limits.rearm` is",
        .tests = "driver.WaysOutTest.test_board_errors driver.DriverFaultTest.test_board_that_takes_no_zero "
                 "plant/driver/ComediRigTest.EncoderLost plant/driver/ComediRigTest.BoardErrors",
        .injected = "board_error encoder_lost",
    },
    SafetyRow{
        .id = "zero_not_taken",
        .fault =
            "at the end of a run the output does not take the zero, or nobody says that it has: the board "
            "refuses it, the front end or its output does not answer",
        .detected = "driver",
        .within = {"at the end; after half a second of a front end's silence"},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V, if the device's own watchdog is there",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "the run ends with exit code 1, also where it was complete; the line says what the "
                        "output reads back",
        .tests =
            "front_end.LastLineTest.test_end_without_the_device plant/PlantRigTest.ARefusedZeroIsAFailure "
            "plant/front_end/FrontEndRigTest.Zero driver.DriverFaultTest.test_board_that_takes_no_zero",
        .injected = "board_error",
    },
    SafetyRow{
        .id = "guardian_gone",
        .fault = "the guardian `hydro-zero`, which writes the zero should the driver be killed, ends or "
                 "stands still",
        .detected = "driver",
        .codes = "guardian_gone",
        .within = {"the next tick", 1},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "the run ends, exit code 1, whatever `limits.rearm` is",
        .tests = "driver.WaysOutTest.test_guardian_gone plant/driver/ComediRigTest.WithoutAGuardianNoVoltage "
                 "front_end.LastLineTest.test_guardian_gone",
        .injected = "guardian_gone",
    },
    SafetyRow{
        .id = "limit_exceeded",
        .fault = "a pressure above `limits.pressure`, a motor above `limits.motor_speed`, an arm beyond "
                 "`limits.arm_angle`",
        .detected = "plant and pressure loop",
        .codes = "pressure_limit motor_speed_limit arm_angle_limit",
        .within = {"the tick in which it is measured", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "the run ends, exit code 1",
        .tests =
            "fault_limits.LimitTest.test_pressure fault_limits.LimitTest.test_motor_speed "
            "fault_limits.LimitTest.test_arm_angle fault_limits.LimitTest.test_arm_angle_default "
            "plant/PlantFaultsTest.LimitsEndTheRun plant/PlantAppTest.SleepingThroughALimitNamesTheLimit",
        .injected = "sensor_saturate:plant",
    },
    SafetyRow{
        .id = "model_error",
        .fault = "the arm leaves the cylinder, a step of the model fails",
        .detected = "simulated plant",
        .codes = "model_error",
        .within = {"at once", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kRunEnds,
        .explicit_rearm = Cleared::kRunEnds,
        .cleared_text = "the run ends, exit code 1, whatever `limits.rearm` is",
        .tests = "plant/PlantAppTest.ModelErrorEndsTheRun",
        .injected = "sensor_stick:plant sensor_lie:plant",
    },
    SafetyRow{
        .id = "loop_is_safe",
        .fault = "with `limits.rearm = \"explicit\"`: a loop goes to a safe output, or raises a fault that "
                 "zeroes the voltage",
        .detected = "plant",
        .codes = "controller_fault",
        .within = {"1 tick after it is heard", 1},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by a re-arm only, when the loop is well again",
        .tests = "fault_limits.RearmTest.test_controller_fault plant/PlantFaultsTest.SafeCommand "
                 "plant/PlantFaultsTest.FaultOfThePositionLoop",
        .injected = "sensor_nan:plant hang:position_ctrl",
    },
    SafetyRow{
        .id = "rig_fault",
        .fault = "with `limits.rearm = \"explicit\"`: a sensor fault of the driver",
        .detected = "the driver's plant",
        .codes = "rig_fault",
        .within = {"the tick in which it is read", 0},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by a re-arm only, when the readings are good again",
        .tests = "plant/PlantRigTest.RigFaultWaitsForARearm",
        .injected = "board_input",
    },
};

}  // namespace

std::span<const SafetyRow> RigRows() { return kRigRows; }

}  // namespace hydro::process
