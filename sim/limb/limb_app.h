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
#include <string>
#include <vector>

#include "plant/run_start.h"
#include "plant/sibling_faults.h"
#include "plant/watches.h"
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
  void AgreeOnTheEnd();
  void Forward(Joint& joint);
  template <class Message>
  void ForwardTo(Joint& joint);
  void Poll();

  const settings::LimbConfig config_;
  const LimbAppOptions options_;
  process::Participant participant_;
  plant::LoggerWatch logger_watch_;
  plant::SiblingFaults elsewhere_;  // of the joints that run in other processes
  plant::RunStart start_;
  int64_t heartbeats_ = 0;
  Limb limb_;
  Telemetry telemetry_;
};

}  // namespace hydro::limb
