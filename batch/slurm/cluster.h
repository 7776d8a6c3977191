// What hydro-batch needs from a batch system: arrays of jobs that share a folder with this machine. An
// array's jobs are numbered from 0 and are independent of each other.
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace hydro::batch {

// what() is one line.
class ClusterError : public std::runtime_error {
 public:
  // `refused` means that the batch system refused the request. Otherwise it is unknown what it did.
  ClusterError(const std::string& text, bool refused) : std::runtime_error(text), refused_(refused) {}
  bool refused() const { return refused_; }

 private:
  bool refused_;
};

struct ClusterLimits {
  int64_t array_jobs = 1001;  // most jobs of one array (MaxArraySize)
  int64_t all_jobs = 10000;   // most jobs of all users that the controller keeps (MaxJobCount)
  // s, the longest time that a processor waits for its next job while there is one (batch_sched_delay),
  // including the start of that job.
  double start_s = 3.1;
  int64_t processors = 0;  // working processors of the partition; 0: unknown
};

struct ArrayRequest {
  std::string name;    // letters, digits and "._-"
  std::string script;  // path
  std::string folder;  // folder in which it runs
  int64_t jobs = 0;
  int64_t at_once = 0;                 // most of its jobs at the same time; 0: any number
  std::vector<std::string> arguments;  // further arguments of sbatch
};

// The jobs of an array that have not ended.
struct QueuedArray {
  int64_t id = 0;
  std::string name;
  int64_t running = 0, pending = 0;
  std::string reason;  // why one of the pending jobs does not run yet
  bool held = false;   // since it was submitted, or since its user held it
};

class Cluster {
 public:
  virtual ~Cluster() = default;

  // `partition` is empty for the standard one. Throws ClusterError.
  virtual ClusterLimits Limits(const std::string& partition) = 0;
  // None of its jobs begins before Release(), so an array that could not be recorded never runs. Returns its
  // id. Throws ClusterError.
  virtual int64_t SubmitHeld(const ArrayRequest& request) = 0;
  virtual void Release(int64_t id) = 0;
  // This user's arrays and jobs that have not ended; nothing while the controller does not answer.
  virtual std::optional<std::vector<QueuedArray>> Queue() = 0;
  virtual void Cancel(int64_t id) = 0;
  // Jobs that are running continue.
  virtual void CancelPending(int64_t id) = 0;
};

}  // namespace hydro::batch
