// What really happened to one plant process, as the simulator saw it: the commands that reached it, what its
// sensors read, the voltages that it put out. What invariants (invariants.h) are computed from.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>

#include "sim/torture/machines/machine.h"
#include "sim/torture/machines/packet.h"

namespace hydro::torture {

// A motor command that reached a plant.
struct ReceivedCommand {
  int64_t tick = -1;
  int64_t session = 0;
  int64_t sequence = -1;
  double voltage = 0;
  TrueTime handled = 0;
  TrueTime silence = 0;  // how long no process of the stack had been heard then
  Origin origin = Origin::kProcess;
};

class PlantRecord {
 public:
  static constexpr int64_t kRemembered = 2048;  // ticks
  static constexpr TrueTime kLongAgo = -1'000'000'000'000;

  struct Tick {
    int64_t tick = -1;
    bool sound = true;                       // nothing that was measured is missing or over a limit
    bool changed = false;                    // a pressure loop was given other readings for it
    std::array<ReceivedCommand, 2> answers;  // unchanged commands for it, of up to two senders
  };

  // The tick's entry, empty if it has none yet.
  Tick& At(int64_t number) {
    Tick& entry = ticks_[static_cast<uint64_t>(number) % kRemembered];
    if (entry.tick != number) entry = Tick{number, true, false, {}};
    return entry;
  }

  void Receive(const ReceivedCommand& command);

  // It has been told to end.
  void Stop() {
    if (!stop_tick) stop_tick = tick;
  }

  // The newest received command for a tick from `oldest` to `newest` with exactly that voltage.
  std::optional<ReceivedCommand> Newest(double wanted, int64_t oldest, int64_t newest);
  // A made-up or changed one among the last that were received.
  const ReceivedCommand* NewestFalse(double wanted) const;

  int64_t tick = -1;          // of the last Drive()
  int64_t read_tick = -1;     // of the last Read(); before the first the run has not begun
  double voltage = 0;         // that it holds
  int64_t zero_tick = 0;      // of the last Drive() of zero volts
  bool left_zero = false;     // it has said that its output reads back zero
  bool left_other = false;    // it has said that its output holds something else
  bool zero_refused = false;  // its board did not take the zero
  TrueTime driven = 0;        // when that was
  int64_t woke_tick = -1;  // the first tick after it did not run for longer than allowed; -1: it has answered
  std::optional<int64_t> stop_tick;                // the tick at which a stop or a signal reached it
  std::optional<bus::Clock::TimePoint> heartbeat;  // when one of its launcher reached it last
  bus::Clock::Duration unsupervised{};             // for how long none has
  // Why the voltage must be zero until a re-arm, or for ever; empty: it need not.
  std::string latched;
  int64_t latched_tick = 0;
  TrueTime latched_at = 0;                  // when the reason was last there
  TrueTime rearm_request = -1;              // when a request for this plant reached it last
  std::optional<int64_t> other_plant_tick;  // when another one's description reached it last
  TrueTime other_plant = 0;
  TrueTime genuine = kLongAgo;              // when a process of the stack was heard last
  bool over_limit = false;                  // at the last reading
  std::map<int64_t, TrueTime> senders;      // by session: when a command of it was received last
  std::optional<int64_t> two_senders_tick;  // since when commands of two have come
  std::map<std::string, bool> zero_faults;  // active faults of its own that zero the voltage: latched
  int64_t obeyed_tick = -1;                 // of the newest command that was obeyed
  int64_t obeyed_session = 0;               // the same
  int64_t suspended_ns = 0;

 private:
  void Hear(const ReceivedCommand& command);

  std::array<Tick, kRemembered> ticks_{};
  std::deque<ReceivedCommand> false_;
};

}  // namespace hydro::torture
