// hydro-diagnose on windows of runs, as child processes with a limit of time, one at a time.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <string>
#include <thread>

#include "scope/cut_out.h"
#include "scope/wire/site.h"

namespace hydro::scope {

class DiagnoseJobs {
 public:
  // `folder`: for their files, of this process's own. `post` runs work on the server's thread, on which everything here is
  // called.
  DiagnoseJobs(std::string folder, std::function<void(std::function<void()>)> post);
  // Ends a child that still runs.
  ~DiagnoseJobs();
  DiagnoseJobs(const DiagnoseJobs&) = delete;
  DiagnoseJobs& operator=(const DiagnoseJobs&) = delete;

  // Cuts the window out and begins. Returns the job's number. Throws InputError when one runs already, or the run has not
  // described its model.
  int Start(const CutSource& source, const std::string& model_text, double t0, double t1);

  // {"state": "running" | "done" | "failed", "text": ..., and when it is done "sentence", "verdict", "report"}; empty: no
  // such job.
  std::string Status(int job) const;

  // The page of a job that is done, under a path that nobody can guess: the report has scripts, and is shown without the
  // token.
  Response Report(const std::string& path) const;
  static bool IsReport(const std::string& path);

 private:
  struct Job {
    std::string state = "running";
    std::string text = "cutting the window out";
    std::string verdict;
    std::string sentence;
    std::string folder;
    std::string report;  // its path
  };
  void Work(int job, const CutSource& source, const std::string& model_text, double t0, double t1,
            const std::string& folder);
  // Runs the program and follows its output; returns its exit code.
  int Follow(int job, const std::string& folder, std::string* last_line);
  void Finish(int job, int exit_code, const std::string& last_line);

  std::string folder_;
  std::function<void(std::function<void()>)> post_;
  std::map<int, Job> jobs_;
  int last_ = 0;
  bool busy_ = false;
  std::atomic<bool> end_ = false;
  std::thread thread_;
};

}  // namespace hydro::scope
