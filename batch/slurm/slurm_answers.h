// Reads what Slurm's commands print.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/slurm/cluster.h"

namespace hydro::batch {

// Reads `scontrol show config`. Where it is silent, Slurm's own defaults apply.
ClusterLimits ParseLimits(const std::string& text);

// Reads `sinfo --noheader` with this format: a line for each partition, "NAME|ALLOCATED/IDLE/OTHER/TOTAL",
// with a star for the standard one.
inline constexpr const char* kPartitionFormat = "%P|%C";
int64_t ParseProcessors(const std::string& text, const std::string& partition);

// Reads `sbatch --parsable`: "ID" or "ID;CLUSTER".
std::optional<int64_t> ParseSubmitted(const std::string& text);

// Reads `squeue --noheader --array` with this format: a line for each job.
inline constexpr const char* kQueueFormat = "%F|%T|%r|%j";
std::vector<QueuedArray> ParseQueue(const std::string& text);

// What helps when sbatch refuses with these words: the option to change, and the command that lists what is
// allowed. Empty where nothing is known to help.
std::string WayOut(const std::string& refusal);

// A time in s, from "30", "30:00", "1:30:00", "2-12" or "2-12:30" (sbatch --time). None for other texts.
std::optional<double> ParseTimeLimit(const std::string& text);

}  // namespace hydro::batch
