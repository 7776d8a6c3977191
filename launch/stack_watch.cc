#include "launch/stack_watch.h"

#include "bus/session.h"
#include "launch/launch_plan.h"

namespace hydro::launch {

StackWatch::StackWatch(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels)
    : bus_(bus), clock_(clock), channels_(channels), session_(bus::RandomSession()) {
  bus.Subscribe<process_status_t>(channels_.Of<process_status_t>(), [this](const process_status_t& status) {
    statuses_[{status.role, status.pid}] = status;
  });
  bus.Subscribe<stop_t>(channels_.Of<stop_t>(), [this](const stop_t& stop) {
    if (!stop_ && stop.session != session_) stop_ = stop;
  });
  bus.Subscribe<loop_statistics_t>(channels_.Of<loop_statistics_t>(),
                                   [this](const loop_statistics_t& report) {
                                     summary_.Add(report);
                                     timing_.Add(report);
                                   });
  bus.Subscribe<loop_histogram_t>(channels_.Of<loop_histogram_t>(),
                                  [this](const loop_histogram_t& histogram) { timing_.Add(histogram); });
  bus.Subscribe<fault_t>(channels_.Of<fault_t>(), [this](const fault_t& fault) { summary_.Add(fault); });
}

void StackWatch::Expect(const std::string& program, pid_t pid) { expected_.push_back({program, pid}); }

std::vector<std::string> StackWatch::NotReady() const {
  std::vector<std::string> missing;
  for (const Expected& expected : expected_) {
    const auto status = statuses_.find({RoleOf(expected.program), expected.pid});
    if (status == statuses_.end() || status->second.state == process_status_t::FAILED) {
      missing.push_back(expected.program);
    }
  }
  return missing;
}

std::string StackWatch::FailureText(const std::string& program, pid_t pid) const {
  const auto status = statuses_.find({RoleOf(program), pid});
  const bool failed = status != statuses_.end() && status->second.state == process_status_t::FAILED;
  return failed ? status->second.text : "";
}

void StackWatch::PublishStop(const std::string& reason, int exit_code) {
  stop_t stop;
  stop.utime = clock_.Utime();
  stop.tick = -1;
  stop.session = session_;
  stop.source = "launch";
  stop.reason = reason;
  stop.exit_code = exit_code;
  bus_.Publish(channels_.Of<stop_t>(), stop);
}

}  // namespace hydro::launch
