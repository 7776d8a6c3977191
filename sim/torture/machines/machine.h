// A simulated machine: its name, its clocks, which drift, jump and stop, and its disk.
#pragma once

#include <cstdint>
#include <string>

#include "base/random.h"
#include "bus/clock.h"

namespace hydro::torture {

// True time in ns since the start of the run. The simulator counts in it, and no process ever sees it.
using TrueTime = int64_t;
inline constexpr TrueTime kSecond = 1'000'000'000;

// The clocks that all processes of one machine read.
class Machine : public bus::Clock {
 public:
  // `now` belongs to the simulator and must outlive this object. `monotonic_s` and `utc_s` are the readings
  // of the clocks at true time 0.
  Machine(std::string name, const TrueTime* now, double monotonic_s, double utc_s);

  const std::string& name() const { return name_; }

  int64_t Utime() const override { return (NowNs() + suspended_ns_ + utc_offset_ns_) / 1000; }
  Duration Suspended() const override { return std::chrono::nanoseconds(suspended_ns_); }

  // The first true time at which Now() is at least `local`.
  TrueTime TrueTimeOf(TimePoint local) const;

  // From now on the clocks run fast by that many parts in 1e9.
  void SetDrift(int64_t parts_per_billion);
  // Sets the wall clock forwards or backwards.
  void JumpUtc(int64_t ns) { utc_offset_ns_ += ns; }
  // The machine has slept for the last `ns`, and Now() does not count that time.
  void Slept(int64_t ns);

 private:
  static constexpr int64_t kBillion = 1'000'000'000;

  TimePoint Read() const override { return TimePoint(std::chrono::nanoseconds(NowNs())); }
  int64_t NowNs() const { return local_base_ + Scaled(*now_ - true_base_); }
  int64_t Scaled(int64_t true_ns) const {
    if (drift_ == 0) return true_ns;
    return true_ns + true_ns / kBillion * drift_ + true_ns % kBillion * drift_ / kBillion;
  }

  std::string name_;
  const TrueTime* now_;
  TrueTime true_base_ = 0;  // the time since which the clock has run at this rate
  int64_t local_base_;      // its reading at that time
  int64_t drift_ = 0;       // parts in 1e9
  int64_t utc_offset_ns_;
  int64_t suspended_ns_ = 0;
};

// The disk on which a simulated logger records: a folder of real files with injected faults, so that the
// logger's own code writes them. It is removed at the end.
class Disk {
 public:
  Disk() = default;
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  // Returns the path for a new log. Throws std::runtime_error where no folder can be made.
  std::string NewLog();

  // Nothing is written while the disk is slow.
  bool ready() const { return slow_ == 0; }
  void SetSlow(bool slow) { slow_ += slow ? 1 : -1; }

  // While the disk is full, a write takes what still fits and then fails, because the kernel refuses it
  // (RLIMIT_FSIZE).
  void SetFull(bool full, Random& random);
  bool full() const { return full_ > 0; }
  // Throws std::runtime_error when the real folder has no room, because the logger's behaviour is then not a
  // finding.
  void CheckRoom() const;

  // Flips a bit of the newest log; returns false where there is none.
  bool Lie(Random& random) const;
  // Removes the newest log's name, after which it is no longer newest(); returns false where there is none.
  // An open file stays open.
  bool Delete();
  // Cuts the newest log off between two sizes. After a loss of power, any part of what its writer handed over
  // last may be missing.
  void Tear(int64_t least, int64_t most, Random& random) const;
  int64_t size() const;  // bytes, of the newest log
  const std::string& newest() const { return newest_; }

 private:
  void MakeFolder();

  std::string folder_, newest_;
  int descriptor_ = -1;  // of the folder
  int logs_ = 0;
  int slow_ = 0;
  int full_ = 0;
};

}  // namespace hydro::torture
