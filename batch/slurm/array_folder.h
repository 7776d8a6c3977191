// The record in a study's folder of the arrays that were submitted for it:
//
//   slurm/000/script   what each job runs
//   slurm/000/cases    the cases of each job, a line "A:B" each
//   slurm/000/array    what hydro-batch knows of the array; it is written whole, before the array is
//                      submitted and after each step
//   slurm/000/log/7    what job 7 printed, and when it began and ended
//
// A driver that was killed at any time finds its arrays there when it is started again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace hydro::batch {

// The script that a job of an array runs.
struct ScriptRequest {
  std::string program;  // absolute path of hydro-batch
  std::string study;    // absolute path of the study's folder
  std::string array;    // absolute path of the array's folder (below)
};

// A script for sh that runs the cases in the job's line of `cases`, on as many processors as Slurm gives the
// job. The paths may hold any character.
std::string ArrayScript(const ScriptRequest& request);

// A name for sbatch: letters, digits and "._-" of `text`, with a limited length.
std::string PlainName(const std::string& text);

// The cases from `first` to the one before `second`.
using CaseRange = std::pair<int64_t, int64_t>;

struct ArrayRecord {
  int64_t number = 0;     // of its folder
  std::string name;       // its name in Slurm, which no other array has
  int64_t id = 0;         // 0: not submitted, or the driver was killed while it submitted it
  bool released = false;  // its jobs may begin
  int64_t pass = 0;       // the arrays of one pass have different cases
  int64_t end = 0;        // the case after its last
  int64_t jobs = 0;
};

class ArrayFolders {
 public:
  // `folder` is the study's folder.
  explicit ArrayFolders(std::string folder);

  // All arrays in order. A folder that was not finished is left out.
  std::vector<ArrayRecord> Read() const;

  // Makes the folder of a new array with a unique name, its cases and its script (above). `study`
  // becomes part of the name. Throws StoreError.
  ArrayRecord Make(const std::string& study, const std::vector<CaseRange>& cases, int64_t pass) const;
  void Write(const ArrayRecord& record) const;

  std::string ArrayFolder(int64_t number) const;
  // The last line about an error that a job of the array printed; empty when no job printed one.
  std::string LastComplaint(const ArrayRecord& record) const;

 private:
  std::string folder_;
};

// The mean time in s that processors waited between two jobs of these logs (texts of slurm/*/log/*); none
// when no job followed another.
struct JobSpan {
  double began = 0, ended = 0;  // s
};
std::optional<JobSpan> ParseJobSpan(const std::string& log);
std::optional<double> MeanWait_s(std::vector<JobSpan> jobs);

// The times of an array's jobs, or of its first 500.
std::vector<JobSpan> ReadJobSpans(const std::string& array_folder, int64_t jobs);

}  // namespace hydro::batch
