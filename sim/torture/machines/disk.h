// The disk on which a simulated logger records: a folder of real files with injected faults, so that the
// logger's own code writes them. It is removed at the end.
#pragma once

#include <cstdint>
#include <string>

#include "base/random.h"

namespace hydro::torture {

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
