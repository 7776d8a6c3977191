// The joints of a limb, in the limb's process: each with its rig, its plant and its two loops on a bus of
// its own, whose classes are those of the separate processes; or with machines that move one arm ([arm]).
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/clock.h"
#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "plant/rig.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "settings/limb_config.h"

namespace hydro::limb {

// Makes a machine for each joint, in the order of the configuration, which must have an arm. The machines
// advance together: the first one that is told to advance takes the others along, each under the voltage that
// it holds. Throws InputError.
std::vector<std::unique_ptr<plant::SimulatedMachine>> MakeJointedArm(const settings::LimbConfig& config);

class Joint {
 public:
  // `clock` is null for lockstep, in which the joint has a simulated clock of its own; otherwise it is the
  // clock of the process. `program` and `heartbeat` are those of PlantApp. `session` is the session on the
  // simulated clock.
  Joint(const settings::JointConfig& joint, std::unique_ptr<plant::Rig> rig, bus::Clock* clock,
        const std::string& program, std::function<bool()> heartbeat, int64_t session = 0);

  const std::string& name() const { return name_; }
  const settings::StackConfig& config() const { return config_; }
  bus::InProcessBus& bus() { return bus_; }
  const bus::Clock& clock() const { return clock_; }
  plant::Rig& rig() { return *rig_; }
  plant::PlantApp& plant() { return plant_; }
  const plant::PlantApp& plant() const { return plant_; }

  // Whether this session belongs to the joint: to its plant, or to one of its loops.
  bool IsOwn(int64_t session) const;

  // Delivers everything that waits on the joint's bus, and the answers to it. On a simulated clock, the time
  // is then `until`.
  void Dispatch(bus::Clock::TimePoint until);

  // Lockstep: the time on the joint's clock at which `tick` is due.
  bus::Clock::TimePoint DueTime(int64_t tick) const;
  void StartClock() { start_ = clock_.Now(); }

  // Runs the watchdogs, statistics and announcements of all three. Call it at least every
  // process::kPollPeriod.
  void Poll();

  // Ends the joint's run: puts out zero volts and announces the ends. Later calls do nothing and return the
  // same exit code.
  int End();
  bool ended() const { return ended_; }

 private:
  std::string name_;
  settings::StackConfig config_;
  bus::SimulatedClock simulated_;
  bus::Clock& clock_;
  bus::InProcessBus bus_;
  std::unique_ptr<plant::Rig> rig_;
  plant::PlantApp plant_;
  pressure_ctrl::PressureApp pressure_;
  position_ctrl::PositionApp position_;
  std::vector<int64_t> sessions_;
  bus::Clock::TimePoint start_;
  bool ended_ = false;
  int exit_code_ = 0;
};

}  // namespace hydro::limb
