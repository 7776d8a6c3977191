// The network, and other senders on it.
#include <array>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::array kNetworkRows{
    SafetyRow{
        .id = "sequence_gaps",
        .fault = "sequence gaps",
        .detected = "every receiver counts them: `lost_messages` in `HYDRO_LOOP_STATISTICS`, in the launch's "
                    "table and "
                    "in `hydro-log info`",
        .within = {"a second"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on with the newest message; one that is missing for longer is stale",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .tests = "fault_commands.MotorCommandTest.test_gaps",
        .injected = "loss",
    },
    SafetyRow{
        .id = "two_plants",
        .fault = "two plants; another stack on the port and multicast group",
        .detected = "pressure loop, by its states; plant, with its program, host and `bus.url`",
        .codes = "second_state_sender other_stack",
        .within = {"5 ticks after its states, a second for its name", 5},
        .output = SafeOutput::kZeroVolts,
        .output_text = "0 V in both",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, 2.5 s after the other was last heard",
        .tests =
            "sharing.SharingTest.test_two_plants fault_commands.MotorCommandTest.test_other_stack "
            "plant/PlantFaultsTest.OtherStack pressure_ctrl/PressureAppTest.SecondStateSenderGivesZeroVolts",
        .injected = "second_plant",
    },
    SafetyRow{
        .id = "undecodable_message",
        .fault = "a message of another type or version on a channel, or a torn one",
        .detected = "every receiver, with the channel and the number",
        .codes = "undecodable_message",
        .within = {"at once"},
        .output = SafeOutput::kNotObeyed,
        .output_text = "it is not obeyed; control goes on; `hydro-log` leaves it out and says so",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "a second after the last",
        .tests = "fault_commands.MotorCommandTest.test_undecodable process/RefusalWatchTest.BeginsAndEnds",
        .injected = "change",
    },
    SafetyRow{
        .id = "flood",
        .fault = "a flood of messages of processes that do not exist",
        .detected = "not as such",
        .within = {"-"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on; what is remembered of them is bounded",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "-",
        .tests = "plant/RollCallTest.KeepsNoFlood process/AgreementTest.SurvivesAFlood",
        .injected = "flood",
    },
    SafetyRow{
        .id = "cable",
        .fault = "the cable between two hosts is unplugged",
        .detected = "each host's processes see the other's as dead",
        .codes = "stale_pressure_command logger_gone",
        .within = {"as above"},
        .output = SafeOutput::kReferenceRamped,
        .output_text = "as above: the reference is held, goes to zero, then 0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when the connection is back",
        .tests = "fault_network.NetworkTest.test_cable",
        .injected = "partition:position_ctrl",
    },
    SafetyRow{
        .id = "interface_down",
        .fault = "a network interface goes down",
        .detected = "each host's processes see the other's as dead; who cannot send says so",
        .codes = "stale_pressure_command logger_gone unsent_message",
        .within = {"as above"},
        .output = SafeOutput::kReferenceRamped,
        .output_text = "as above: the reference is held, goes to zero, then 0 V",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByRearm,
        .cleared_text = "by itself, when the connection is back",
        .tests = "fault_network.NetworkTest.test_interface",
        .not_injected = "the simulated network takes every message",
    },
};

}  // namespace

std::span<const SafetyRow> NetworkRows() { return kNetworkRows; }

}  // namespace hydro::process
