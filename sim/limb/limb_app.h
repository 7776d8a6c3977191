// A limb as an application: its joints inside this process, and the part of them that others see on the bus.
//
// On the bus it takes part as one process with the role "limb", on the channels without a joint's suffix. On
// the channels with a joint's suffix it sends the joint's states and commands at limb.telemetry_hz (in
// lockstep every one), its faults at once, and its descriptions and statistics. Stops, re-arms, changes of
// values and plans that arrive on a joint's channels reach that joint.
//
// Real time: it wakes at each tick, takes every joint a step further (limb.h), and sends in the rest of the
// tick. Lockstep: it runs as fast as it can, and waits for loggers that fall behind.
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/log_progress_t.hpp>
#include <hydro/run_description_t.hpp>
#include <map>
#include <string>
#include <vector>

#include "plant/logger_watch.h"
#include "plant/roll_call.h"
#include "plant/sibling_faults.h"
#include "process/participant.h"
#include "settings/limb_config.h"
#include "sim/limb/limb.h"
#include "sim/limb/telemetry.h"

namespace hydro::limb {

struct LimbAppOptions {
  std::vector<std::string> joints;  // joints of the configuration that run here; empty: all
  std::vector<std::string>
      expected;  // processes to wait for before the run begins: "logger", "joint:knee" of another process
  std::function<bool()> heartbeat;  // as in PlantApp
};

class LimbApp {
 public:
  // Throws InputError.
  LimbApp(bus::Bus& bus, bus::Clock& clock, const settings::LimbConfig& config, LimbAppOptions options);

  // Performs the whole run, as PlantApp::Run() does, for all joints.
  int Run();

  Limb& limb() { return limb_; }
  timing::LoopStatistics& statistics() { return participant_.statistics(); }

 private:
  bool Begin();
  void RunLockstep();
  void RunRealtime();
  int End();
  bool Ended() const;
  bool LoggersKeepUp() const;
  bool AwaitLoggers();
  std::vector<std::string> Missing() const;
  void AgreeOnTheEnd();
  void Forward(Joint& joint);
  template <class Message>
  void ForwardTo(Joint& joint);
  void PublishDescription();
  void Poll();

  const settings::LimbConfig config_;
  const LimbAppOptions options_;
  process::Participant participant_;
  plant::RollCall roll_call_;
  plant::LoggerWatch logger_watch_;
  plant::SiblingFaults elsewhere_;  // of the joints that run in other processes
  int64_t heartbeats_ = 0;
  Limb limb_;
  Telemetry telemetry_;
  std::map<int64_t, int64_t> log_progress_;  // tick by session, of the loggers present when the run began
  run_description_t description_;
  bus::Clock::TimePoint next_description_;
};

}  // namespace hydro::limb
