// What really happened to one process, as the simulator saw it. The invariants are computed from this.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
  TrueTime silence = 0;  // how long no process of the stack had been heard by then
  Origin origin = Origin::kProcess;
};

// Of a plant: the commands that reached it, what its sensors read, the voltages that it put out.
class PlantRecord {
 public:
  static constexpr int64_t kRemembered = 2048;  // ticks
  static constexpr TrueTime kLongAgo = -1'000'000'000'000;

  struct Tick {
    int64_t tick = -1;
    bool sound = true;                       // no reading is missing or over a limit
    bool changed = false;                    // a pressure loop received other readings for it
    std::array<ReceivedCommand, 2> answers;  // unchanged commands for it, from up to two senders
  };

  // The tick's entry, empty if it has none yet.
  Tick& At(int64_t number) {
    Tick& entry = ticks_[static_cast<uint64_t>(number) % kRemembered];
    if (entry.tick != number) entry = Tick{number, true, false, {}};
    return entry;
  }

  void Receive(const ReceivedCommand& command);

  // The plant has been told to end.
  void Stop() {
    if (!stop_tick) stop_tick = tick;
  }

  // The newest received command for a tick from `oldest` to `newest` with exactly that voltage.
  std::optional<ReceivedCommand> Newest(double wanted, int64_t oldest, int64_t newest);
  // A forged or changed command with that voltage among the last that were received.
  const ReceivedCommand* NewestFalse(double wanted) const;

  int64_t tick = -1;          // of the last Drive()
  int64_t read_tick = -1;     // of the last Read(); the run begins with the first one
  double voltage = 0;         // that it holds now
  int64_t zero_tick = 0;      // of the last Drive() of zero volts
  bool left_zero = false;     // it has reported that its output reads back zero
  bool left_other = false;    // it has reported that its output holds something else
  bool zero_refused = false;  // its board refused the zero
  TrueTime driven = 0;        // time of the last Drive()
  int64_t woke_tick = -1;  // the first tick after it stood still for longer than allowed; -1: it has answered
  std::optional<int64_t> stop_tick;                // the tick at which a stop or a signal reached it
  std::optional<bus::Clock::TimePoint> heartbeat;  // when its launcher's last one came
  bus::Clock::Duration unsupervised{};             // how long none has come
  // Why the voltage must be zero until a re-arm, or for ever; empty: it need not be zero.
  std::string latched;
  int64_t latched_tick = 0;
  TrueTime latched_at = 0;                  // the last time at which the reason was present
  TrueTime rearm_request = -1;              // the last time at which a request for this plant reached it
  std::optional<int64_t> other_plant_tick;  // the tick at which another plant's description last reached it
  TrueTime other_plant = 0;
  TrueTime genuine = kLongAgo;          // the last time at which a process of the stack was heard
  bool over_limit = false;              // at the last reading
  std::map<int64_t, TrueTime> senders;  // by session: the last time at which a command from it was received
  std::optional<int64_t> two_senders_tick;  // the tick since which commands of two senders have come
  std::map<std::string, bool> zero_faults;  // its own active faults that zero the voltage: whether latched
  int64_t obeyed_tick = -1;                 // of the newest command that was obeyed
  int64_t obeyed_session = 0;               // session of that command
  int64_t suspended_ns = 0;
  // The limits of the readings that hold now, and those that it has announced and the tick from which they
  // hold.
  std::map<std::string, double> limits, next_limits;
  int64_t next_limits_at = -1;  // -1: none

 private:
  void Hear(const ReceivedCommand& command);

  std::array<Tick, kRemembered> ticks_{};
  std::deque<ReceivedCommand> false_;
};

// The number of states that one process has really missed, counted from what reached it. The process's own
// count must be the same.
class LossCount {
 public:
  // A state was passed to the process.
  void Handle(const Packet& state);

  // States missing before or between those that were handled. None where a state was changed, forged or from
  // a second plant, because the count then depends on more than the network.
  std::optional<int64_t> lost() const { return countable_ ? std::optional(lost_) : std::nullopt; }

 private:
  std::optional<int64_t> session_;
  int64_t newest_ = 0;
  int64_t lost_ = 0;
  bool countable_ = true;
};

// Compares what really reached one logger process with the log that it left. A log must say what happened, or
// say that something is missing.
struct LogRecord {
  std::string file;
  std::vector<uint64_t> handled;  // hashes of the messages, in order
  bool killed = false;            // the logger could not end its log
  bool was_full = false;          // the disk refused a write
  bool lied = false;              // the disk changed what was written
  bool deleted = false;           // the file was deleted while it was being written

  void Handle(std::string_view channel, const uint8_t* data, size_t size);
};

// Returns what is wrong with the log; empty when nothing is. Reads the whole log.
std::string WrongWith(const LogRecord& record);

}  // namespace hydro::torture
