// One launch of a stack: starts its processes, watches them until the run has ended, and ends them in order.
// This class only decides; the objects that start, hear and print are passed in.
#pragma once

#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/clock.h"
#include "launch/logic/children.h"
#include "launch/logic/run_summary.h"
#include "launch/logic/stack_watch.h"
#include "launch/logic/stop_sequence.h"
#include "runs/timing/timing_record.h"
#include "settings/stack_config.h"

namespace hydro::launch {

// What a launch reports to people: lines on a terminal, and files on how well the loops kept time.
class LaunchReport {
 public:
  virtual ~LaunchReport() = default;

  virtual void Print(const std::string& text) = 0;
  virtual void PrintError(const std::string& text) = 0;

  // Shows how the processes are doing, about once a second while the run goes on; an empty list means that it
  // is over.
  virtual void ShowStatus(const std::vector<ProcessStatus>& /*processes*/) {}

  // Called when the launch is over; nothing is printed after it.
  virtual void End(int /*exit_code*/) {}

  // Writes how well the loops kept time and returns a line that says where; empty when that is not kept.
  // Throws std::exception.
  virtual std::string WriteTiming(const timing::TimingRecord& record) = 0;
};

class StackLaunch {
 public:
  using TimePoint = bus::Clock::TimePoint;

  // All arguments must outlive this object. `children` stop with GraceFor(timing, plan).
  StackLaunch(bus::Bus& bus, bus::Clock& clock, Children& children, LaunchReport& report,
              const settings::StackConfig& config, const LaunchPlan& plan, const LaunchTiming& timing);

  // Runs until no process is left; returns the exit code. Throws InputError when a process with one of its
  // roles is present already.
  int Run();

 private:
  void RefuseIfOneRuns();
  std::vector<std::string> PresentInOurPlace() const;
  void StartAll();
  int HearBus(TimePoint until);
  void ShowStatus();
  void HearLastReports();
  void WriteTiming();
  void OnSignals();
  void OnEnded(const Ended& ended);
  void OnStopHeard();
  void CheckReady();
  bool AwaitsDriver(const std::vector<std::string>& missing) const;
  void AskWhoIsThere();
  void CheckPlantIsHeard();
  void CheckEarlyEnd();
  void CheckJointsLeft();
  void RepeatStopForOtherHosts();
  void Fail(const std::string& reason, int exit_code);
  void BeginStop(const std::string& reason, int exit_code);
  void PublishStop(const std::string& reason, int exit_code);
  void PrintSummary();
  void WriteRemainingOutput();
  void Print(const std::string& text) { report_.Print(text); }
  void PrintError(const std::string& text) { report_.PrintError(text); }

  bus::Bus& bus_;
  bus::Clock& clock_;
  Children& children_;
  LaunchReport& report_;
  const settings::StackConfig& config_;
  const LaunchPlan& plan_;
  const LaunchTiming timing_;
  StackWatch watch_;

  TimePoint started_;
  TimePoint asked_;  // when it last asked who is present, while not all are ready
  TimePoint next_status_;
  bool ready_ = false;
  bool plant_heard_ = false;
  bool bus_failed_ = false;
  bool stop_seen_ = false;     // another process's stop has been acted upon
  bool failing_ = false;       // the run has failed; consequences are not reported again
  bool joints_ended_ = false;  // the joints of a process here have ended, while others go on
  bool killed_ = false;
  bool plant_killed_ = false;  // a plant or driver was ended by a signal and could report no more
  bool told_ = false;          // told to end by a signal: somebody waits for this launcher's end
  int interrupts_ = 0;
  int exit_code_ = 0;
  std::string early_end_;      // a program that ended with 0 although no stop was heard
  TimePoint early_end_until_;  // the time until which the stop may still arrive
  StopAnnouncer stop_announcer_;
};

}  // namespace hydro::launch
