// One launch of a stack: the bus, the processes and the reports of a run, behind Launch() (launch.h).
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "bus/udpm/udpm_bus.h"
#include "launch/labelled_output.h"
#include "launch/launch.h"
#include "launch/launch_lock.h"
#include "launch/launch_plan.h"
#include "launch/stack_watch.h"
#include "launch/stop_announcer.h"
#include "launch/supervisor.h"
#include "launch/timing_files.h"

namespace hydro::launch {

class StackLaunch {
 public:
  using TimePoint = Supervisor::TimePoint;

  StackLaunch(const settings::StackConfig& config, const LaunchPlan& plan, int out_fd, int err_fd,
              const LaunchTiming& timing);

  // Runs until no process is left; returns the exit code.
  int Run();

 private:
  void RefuseIfOneRuns();
  void StartAll();
  int HearBus(TimePoint until);
  void HearLastReports();
  void WriteTiming();
  void OnSignals();
  void OnEnded(const Supervisor::Ended& ended);
  void OnStopHeard();
  void CheckReady();
  void CheckPlantIsHeard();
  void CheckEarlyEnd();
  void RepeatStopForOtherHosts();
  void Fail(const std::string& reason, int exit_code);
  void BeginStop(const std::string& reason, int exit_code);
  void PublishStop(const std::string& reason, int exit_code);
  void PrintSummary();
  void WriteRemainingOutput();
  void Print(const std::string& text) { output_.Line(LabelledOutput::Stream::kOut, kLabel, text); }
  void PrintError(const std::string& text) { output_.Line(LabelledOutput::Stream::kErr, kLabel, text); }

  static constexpr char kLabel[] = "launch";

  const settings::StackConfig& config_;
  const LaunchPlan& plan_;
  const LaunchTiming timing_;
  std::optional<LaunchLock> lock_;
  LabelledOutput output_;
  Supervisor supervisor_;  // before the bus, whose threads must not receive the launcher's signals
  bus::WallClock clock_;
  std::unique_ptr<bus::UdpmBus> bus_;
  StackWatch watch_;
  std::optional<TimingFiles> timing_files_;

  TimePoint started_;
  bool ready_ = false;
  bool plant_heard_ = false;
  bool bus_failed_ = false;
  bool stop_seen_ = false;  // another process's stop has been acted upon
  bool failing_ = false;    // the run has failed: consequences of that are not reported again
  bool killed_ = false;
  int interrupts_ = 0;
  int exit_code_ = 0;
  std::string early_end_;      // a program that ended with 0 although no stop was heard
  TimePoint early_end_until_;  // until when the stop may still arrive
  StopAnnouncer stop_announcer_;
};

}  // namespace hydro::launch
