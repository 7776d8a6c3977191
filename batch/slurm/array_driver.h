// Runs the missing cases of a study as arrays of jobs until all are there.
//
// The study's folder is the only memory. A driver that was killed at any time and is started again finds the
// arrays that still run (array_folder.h), and does not submit cases that one of them has. Cases are missing
// until they are stored, whatever happened to the job.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "batch/run/case_progress.h"
#include "batch/slurm/array_folder.h"
#include "batch/slurm/cluster.h"
#include "batch/store/case_store.h"

namespace hydro::batch {

struct DriveProgress {
  int64_t cases = 0, done = 0, failed = 0;  // cases of the study
  int64_t running = 0, pending = 0;         // number of jobs
  std::string reason;                       // why pending jobs do not run yet, in Slurm's words
  bool answered = true;                     // whether the batch system answered
};

enum class StopWish { kNone, kCancel, kLeave };  // kLeave: the arrays continue to run

struct DriveRequest {
  std::string folder;  // folder of the prepared study
  std::string name;    // of the study
  int64_t cases = 0;
  std::vector<std::string> arguments;  // further arguments of sbatch
  std::string partition;               // empty: the standard one
  int64_t at_once = 0;                 // most jobs at the same time; 0: any number
  int64_t processors = 1;              // of one job
  int64_t cases_per_job = 0;           // 0: chosen automatically (grouping.h)
  double limit_s = 0;                  // of one job; 0: none
  int barren_passes = 3;               // gives up after so many passes in a row without a new case
  bool detach = false;                 // submit the array and leave
  std::function<double()> case_s;      // how long a case takes, s, as far as is known so far
  std::function<StopWish()> stop;
  std::function<void(std::chrono::milliseconds)> wait;  // may return early
  std::function<void(const DriveProgress&)> progress;   // at each look
  std::function<void(const std::string&)> say;          // receives what was decided, one line each
};

enum class DriveEnd { kAllThere, kCancelled, kLeft, kGaveUp };

class ArrayDriver {
 public:
  // Both must outlive this object.
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
  std::vector<ArrayRecord> unknown_;  // it is unknown whether they were submitted
  std::vector<ArrayRecord> ended_;    // of this driver
  int64_t pass_ = 0, cursor_ = 0;     // cases from the cursor on have not been submitted in this pass
  int64_t there_before_ = 0;          // cases that were there when the pass began
  int barren_ = 0, refusals_ = 0;
  bool submitted_ = false;
  std::map<int64_t, int64_t> pending_;  // pending jobs of each array when it was last seen released
  DriveProgress progress_;
};

}  // namespace hydro::batch
