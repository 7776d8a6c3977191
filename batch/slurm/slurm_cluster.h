// Slurm, used through its commands: sbatch, squeue, scontrol, scancel. They find the cluster as in a shell
// (SLURM_CONF, PATH).
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "batch/slurm/cluster.h"

namespace hydro::batch {

// What a command printed.
struct Answer {
  bool ended_itself = false;  // false: it was late, `stop` was true, or a signal ended it
  int exit_code = -1;
  std::string out, err;
};

// Runs a command. `argv[0]` is the path of the program. The command is ended after `limit`, or when `stop` is
// true. Throws process::StartError, std::runtime_error.
Answer AskCommand(const std::vector<std::string>& argv, std::chrono::seconds limit,
                  const std::function<bool()>& stop);

class SlurmCluster : public Cluster {
 public:
  // `stop` is asked while sbatch runs, which may take minutes; when it returns true, sbatch is ended. Throws
  // InputError when this machine has no sbatch.
  explicit SlurmCluster(std::function<bool()> stop);

  ClusterLimits Limits(const std::string& partition) override;
  int64_t SubmitHeld(const ArrayRequest& request) override;
  void Release(int64_t id) override;
  std::optional<std::vector<QueuedArray>> Queue() override;
  void Cancel(int64_t id) override;
  void CancelPending(int64_t id) override;

 private:
  const std::function<bool()> stop_;
};

// The arguments of sbatch, beginning with the program's name.
std::vector<std::string> SbatchArguments(const ArrayRequest& request);

}  // namespace hydro::batch
