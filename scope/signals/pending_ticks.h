// The newest ticks, while answers to them may still arrive. A tick's row is complete when its commands have
// arrived, or when kPending later ticks have come.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <hydro/arm_reference_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/state_t.hpp>
#include <utility>

#include "scope/signals/channel_list.h"

namespace hydro::scope {

class PendingTicks {
 public:
  static constexpr size_t kPending = 8;
  using Row = std::array<double, kTickColumns>;

  // `emit` receives the rows in the order of their times.
  explicit PendingTicks(std::function<void(double time, const Row& row)> emit) : emit_(std::move(emit)) {
    Reset();
  }

  // `utime` is the arrival of the message in us. States must come in the order of their ticks.
  void Add(const state_t& state, int64_t utime);
  void Add(const motor_command_t& command, int64_t utime);
  void Add(const arm_reference_t& reference);

  // Emits all rows that wait.
  void Flush();

  // Resets to the initial state for another run.
  void Reset();

 private:
  struct Tick {
    int64_t tick = 0;
    int64_t utime = 0;
    double time = 0;
    bool commanded = false;
    bool referred = false;
    Row row{};
  };
  void Answer(Tick& tick, const motor_command_t& command, int64_t utime);
  void EmitFirst();

  std::function<void(double, const Row&)> emit_;
  std::deque<Tick> ticks_;
  int64_t newest_utime_ = 0;  // of the newest state
  // In force until the next one arrives.
  double dp_ref_;
  double voltage_asked_;
  double saturated_;
  double arm_ref_;
  // A command that came before its state.
  struct Early {
    motor_command_t command;
    int64_t utime = 0;
  };
  std::deque<Early> early_;
  std::deque<arm_reference_t> early_references_;
};

}  // namespace hydro::scope
