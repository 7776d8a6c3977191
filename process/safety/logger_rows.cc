// The logger, its disk and its files.
#include <array>

#include "process/safety/safety_table.h"

namespace hydro::process {
namespace {

constexpr std::array kLoggerRows{
    SafetyRow{
        .id = "logger_dies",
        .fault = "logger dies or hangs",
        .detected = "plant",
        .codes = "logger_gone",
        .within = {"`limits.stale_logger_s` (1 s)", {}, "stale_logger_s"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "by itself, when a new logger is heard",
        .tests = "fault_loops.FaultLoopsTest.test_logger_dies plant/PlantFaultsTest.LoggerGone",
        .injected = "crash:logger hang:logger partition:logger",
    },
    SafetyRow{
        .id = "disk_full",
        .fault = "disk full",
        .detected = "logger: exit code 1, the log ends with a whole event; plant, with the logger's reason",
        .codes = "logger_gone",
        .within = {"at once"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "by itself, when a new logger is heard",
        .tests = "fault_loops.FaultLoopsTest.test_disk_full plant/PlantFaultsTest.LoggerFailed",
        .injected = "disk_full",
    },
    SafetyRow{
        .id = "slow_disk",
        .fault = "the disk is slower than the bus for longer than `logger.memory_mb` lasts",
        .detected = "logger, with the number of messages that are not in the log",
        .codes = "log_overflow",
        .within = {"20 ms"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "a second after the last",
        .tests = "logger/LoggerAppTest.SlowDisk",
        .injected = "disk_slow",
    },
    SafetyRow{
        .id = "log_deleted",
        .fault = "the log is deleted, renamed or replaced, or its folder is",
        .detected = "logger: an error that names the file",
        .within = {"1 s"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on, and so does recording into the open file",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "exit code 1 at the stop",
        .tests = "logger.DeletedLogTest.test_deleted_or_moved logger/LoggerAppTest.DeletedLog",
        .injected = "disk_delete",
    },
    SafetyRow{
        .id = "log_damaged",
        .fault = "the logger is killed, or the disk loses or changes what was written",
        .detected = "every reader of the log: `incomplete` or `damaged`, and where ([logs.md](logs.md))",
        .within = {"when it is read"},
        .output = SafeOutput::kControlGoesOn,
        .output_text = "control goes on; no result is computed from what is damaged",
        .restart = Cleared::kByItself,
        .explicit_rearm = Cleared::kByItself,
        .cleared_text = "`hydro-log repair` keeps what the checksums cover",
        .tests = "tools/hydro_log/DamageTest.Repaired sim/torture/LogRecordTest.Damage",
        .injected = "disk_lie crash:logger",
    },
};

}  // namespace

std::span<const SafetyRow> LoggerRows() { return kLoggerRows; }

}  // namespace hydro::process
