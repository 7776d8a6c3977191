// What Slurm's commands print, read.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/slurm/cluster.h"

namespace hydro::batch {

// `scontrol show config`. What it does not say keeps Slurm's own defaults.
ClusterLimits ParseLimits(const std::string& text);

// `sinfo --noheader` with this format: a line for each partition, "NAME|ALLOCATED/IDLE/OTHER/TOTAL", the standard one with a star.
inline constexpr const char* kPartitionFormat = "%P|%C";
int64_t ParseProcessors(const std::string& text, const std::string& partition);

// `sbatch --parsable`: "ID" or "ID;CLUSTER".
std::optional<int64_t> ParseSubmitted(const std::string& text);

// `squeue --noheader --array` with this format: a line for each job.
inline constexpr const char* kQueueFormat = "%F|%T|%r|%j";
std::vector<QueuedArray> ParseQueue(const std::string& text);

// What helps where sbatch refuses with these words: the option to change, and the command that lists what is allowed; empty where
// nothing is known to help.
std::string WayOut(const std::string& refusal);

// s; "30", "30:00", "1:30:00", "2-12", "2-12:30" (sbatch --time). None for other texts.
std::optional<double> ParseTimeLimit(const std::string& text);

}  // namespace hydro::batch
