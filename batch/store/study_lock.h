// Ensures that one process at a time drives a study, on whichever host shares the folder. The results do not
// depend on it (case_store.h); it only keeps two processes from doing the same work.
//
// The lock is the file lock in the study's folder, which is made in one step and holds its owner's name. Its
// owner touches it every few seconds. The lock is taken over when its owner has ended on this host, or has
// been silent for a minute on another.
#pragma once

#include <string>
#include <thread>

namespace hydro::batch {

struct LockHolder {
  std::string host;
  long pid = 0;
  double silent_s = 0;  // s since it touched the lock
  bool gone = false;    // it has ended, or was silent for too long
};

// Holds the lock on a study's folder for the life of the object.
class StudyLock {
 public:
  // Throws InputError naming the other process where another one holds the lock, and StoreError where it
  // cannot be written.
  explicit StudyLock(const std::string& folder);
  ~StudyLock();
  StudyLock(const StudyLock&) = delete;
  StudyLock& operator=(const StudyLock&) = delete;

  // Finds the holder of a folder; returns false when there is none.
  static bool Holder(const std::string& folder, LockHolder* holder);

 private:
  bool Make();

  std::string file_, owner_;
  std::jthread heartbeat_;
};

}  // namespace hydro::batch
