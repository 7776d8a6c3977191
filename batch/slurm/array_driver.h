// Runs the missing cases of a study as arrays of jobs, until all are there.
//
// The study's folder is the only memory: a driver that was killed at any time, started again, finds the arrays that still run
// (array_folder.h), and submits no case that one of them has. Cases are missing until they are stored, whatever became of the job.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "batch/slurm/array_folder.h"
#include "batch/slurm/cluster.h"
#include "batch/slurm/shared_count.h"
#include "batch/store/case_store.h"

namespace hydro::batch {

struct DriveProgress {
  int64_t cases = 0, done = 0, failed = 0;  // of the study
  int64_t running = 0, pending = 0;         // jobs
  std::string reason;                       // why pending jobs do not run yet, in Slurm's words
  bool answered = true;                     // the batch system
};

enum class StopWish { kNone, kCancel, kLeave };  // kLeave: the arrays run on

struct DriveRequest {
  std::string folder;  // of the prepared study
  std::string name;    // of the study
  int64_t cases = 0;
  std::vector<std::string> arguments;  // of sbatch
  std::string partition;               // empty: the standard one
  int64_t at_once = 0;                 // most jobs at the same time; 0: any number
  int64_t processors = 1;              // of a job
  int64_t cases_per_job = 0;           // 0: chosen (grouping.h)
  double limit_s = 0;                  // of a job; 0: none
  int barren_passes =
      3;  // so many times in a row what is missing is submitted and not one more case gets there: give up
  bool detach = false;             // submit and leave
  std::function<double()> case_s;  // how long a case takes, s, as far as is known by now
  std::function<StopWish()> stop;
  std::function<void(std::chrono::milliseconds)> wait;  // may return early
  std::function<void(const DriveProgress&)> progress;   // at each look
  std::function<void(const std::string&)> say;          // what was decided, a line each
};

enum class DriveEnd { kAllThere, kCancelled, kLeft, kGaveUp };

class ArrayDriver {
 public:
  // Both must outlive it.
  ArrayDriver(DriveRequest request, Cluster* cluster);

  // Throws ClusterError when the first array is refused, StoreError when the folder cannot be written.
  DriveEnd Run();

 private:
  void Adopt();
  bool Look();
  void ReleaseForgotten(const ArrayRecord& record, const QueuedArray& queued);
  bool PassIsOver() const { return active_.empty() && cursor_ >= request_.cases; }
  bool StartsPass();
  int64_t AtOnce() const;
  bool MayAdd() const;
  void TryToAdd();
  void Add();
  std::vector<CaseRange> NextRanges(int64_t cases_per_job, int64_t most_jobs);
  DriveEnd EndEarly(StopWish wish);
  DriveEnd End();
  bool CancelAll(void (Cluster::*cancel)(int64_t));
  void WaitForTheirEnd(std::chrono::milliseconds patience);
  void SayWaits() const;

  const DriveRequest request_;
  Cluster& cluster_;
  const CaseStore store_;
  const ArrayFolders folders_;
  SharedCount count_;
  ClusterLimits limits_;
  std::vector<ArrayRecord> active_;   // not ended, as far as is known
  std::vector<ArrayRecord> unknown_;  // nobody knows whether they were submitted
  std::vector<ArrayRecord> ended_;    // of this driver
  int64_t pass_ = 0, cursor_ = 0;     // cases from the cursor on are not submitted in this pass
  int64_t there_before_ = 0;          // cases, when the pass began
  int barren_ = 0, refusals_ = 0;
  bool submitted_ = false;
  std::map<int64_t, int64_t> pending_;  // of each array, when it was last seen released
  DriveProgress progress_;
};

}  // namespace hydro::batch
