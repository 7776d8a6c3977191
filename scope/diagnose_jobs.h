// Runs hydro-diagnose on windows of runs, as child processes with a time limit, one at a time.
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
  // `folder` receives their files and belongs to this process alone. `post` runs work on the server's thread,
  // which also makes every call to this class.
  DiagnoseJobs(std::string folder, std::function<void(std::function<void()>)> post);
  // Ends a child that is still running.
  ~DiagnoseJobs();
  DiagnoseJobs(const DiagnoseJobs&) = delete;
  DiagnoseJobs& operator=(const DiagnoseJobs&) = delete;

  // Cuts the window out and starts the job. Returns the job's number. Throws InputError when a job is already
  // running, or when the run has not described its model.
  int Start(const CutSource& source, const std::string& model_text, double t0, double t1);

  // {"state": "running" | "done" | "failed", "text": ..., and, when it is done, "sentence", "verdict",
  // "report"}; empty: there is no such job.
  std::string Status(int job) const;

  // The page of a finished job, under a path that cannot be guessed: the report has scripts and is shown
  // without the token.
  Response Report(const std::string& path) const;
  static bool IsReport(const std::string& path);

 private:
  struct Job {
    std::string state = "running";
    std::string text = "cutting the window out";
    std::string verdict;
    std::string sentence;
    std::string folder;
    std::string report;  // path of the report
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
