// Makes a position loop of the user's own in a few lines (docs/own_controller.md):
//
//   int main() {
//     return hydro::process::RunOwnPositionLoop(
//         [](const hydro::state_t& state, hydro::pressure_command_t* command) {
//           command->pressure_ref = -6000 * (state.arm_angle - 0.3) - 1200 * state.arm_speed;
//         });
//   }
#pragma once

#include <functional>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <string>

#include "process/control_loop.h"
#include "process/process_main.h"
#include "settings/stack_config.h"

namespace hydro::process {

// Fills in what the pressure loop is asked for at that state, in psi or volts; tick, session, sequence and
// utime are already filled in. Called once for each state at a multiple of the position loop's interval.
using PositionAnswer = std::function<void(const state_t& state, pressure_command_t* command)>;

// The angle that the loop wants the arm to have at that state, rad.
using ArmReference = std::function<double(const state_t& state)>;

// Everything that the loop does on the bus: it makes the handshake, sends the answers, repeats an answer when
// its state comes again, and announces its end; it reports statistics and faults as all processes do.
class OwnPositionLoop : public ControlLoop {
 public:
  OwnPositionLoop(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                  PositionAnswer answer, ArmReference reference = {});

  // Unless the run is over, it first asks for zero volts: the last command must not stay in force.
  int Finish() override;

  using ControlLoop::participant;

 private:
  bool Answer(const state_t& state, bus::Clock::TimePoint arrival) override;
  void AnswerAgain() override { Send(); }
  void SendReference(const state_t& state);
  void Send();

  const PositionAnswer answer_;
  const ArmReference reference_;  // may be empty
  pressure_command_t command_{};  // the last answer
  int64_t sequence_ = 0;
};

// A whole program in the place of `role`: takes the configuration and its overrides from HYDRO_CONFIG and
// HYDRO_SET, as hydro-launch and hydro-log replay set them, and runs `body`. Returns the exit code; an error
// is one line on stderr.
int RunOwnLoop(const std::string& role, const ProcessBody& body);

// The same for a position loop; it runs until the run is over. With `reference` it publishes the arm's
// reference beside each answer, for tables, pictures and hydro-log summary.
int RunOwnPositionLoop(const PositionAnswer& answer, const ArmReference& reference = {});

}  // namespace hydro::process
