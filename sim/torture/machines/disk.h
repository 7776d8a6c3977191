// The disk on which a simulated logger records: a folder of real files, so that the logger's own code writes them, with
// faults. It is removed at the end.
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

  // The path for a new log. Throws std::runtime_error where no folder can be made.
  std::string NewLog();

  // Nothing is written while it is slow.
  bool ready() const { return slow_ == 0; }
  void SetSlow(bool slow) { slow_ += slow ? 1 : -1; }

  // While it is full, a write takes what still fits, and then fails: the kernel refuses it (RLIMIT_FSIZE).
  void SetFull(bool full, Random& random);
  bool full() const { return full_ > 0; }
  // Throws std::runtime_error when there is no room in the real folder: what a logger then does is no finding.
  void CheckRoom() const;

  // Flips a bit of the newest log; false where it has none.
  bool Lie(Random& random) const;
  // Takes the newest log away from its name, which newest() then no longer is; false where there is none.
  // What is open stays open.
  bool Delete();
  // Cuts the newest log off between two sizes: of what its writer had handed over last, any part may be missing after a
  // loss of power.
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
