// Who drives a study: one process at a time, on whichever host shares the folder. What the cases are does not depend on it (case_store.h);
// it keeps two from doing the same work.
//
// The lock is the file lock in the study's folder, made in one step, with its owner's name. Its owner touches it every few seconds: the
// lock of an owner that has ended on this host, or that has been silent for a minute on another, is taken over.
#pragma once

#include <string>
#include <thread>

namespace hydro::batch {

struct LockHolder {
  std::string host;
  long pid = 0;
  double silent_s = 0;  // since it touched the lock
  bool gone = false;    // it has ended, or been silent for too long
};

// Holds a study's folder from here to the end of the object.
class StudyLock {
 public:
  // Throws InputError where another process holds it, naming that; StoreError where it cannot be written.
  explicit StudyLock(const std::string& folder);
  ~StudyLock();
  StudyLock(const StudyLock&) = delete;
  StudyLock& operator=(const StudyLock&) = delete;

  // Whoever holds a folder; false: nobody.
  static bool Holder(const std::string& folder, LockHolder* holder);

 private:
  bool Make();

  std::string file_, owner_;
  std::jthread heartbeat_;
};

}  // namespace hydro::batch
