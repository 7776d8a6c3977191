// A loop's side of a stack on simulated time: what tests of loops send to it.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>

#include "bus/in_process_bus.h"
#include "settings/stack_config.h"

namespace hydro::process {

class LoopTest : public ::testing::Test {
 protected:
  void State(int64_t tick, int64_t sequence, int64_t session = 77) {
    state_t state{};
    state.tick = tick;
    state.session = session;
    state.sequence = sequence;
    state.arm_angle = 0.01 * static_cast<double>(tick);
    bus_.Publish("HYDRO_STATE", state);
    Deliver();
  }
  void Deliver() {
    clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(1));
    while (bus_.HandleUntil(clock_.Now()) > 0) {
    }
  }

  bus::SimulatedClock clock_;
  bus::InProcessBus bus_{&clock_};
  settings::StackConfig config_;
};

}  // namespace hydro::process
