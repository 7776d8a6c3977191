// Who works on a study: names for files that belong to a running process, and the lock on a study's folder.
#pragma once

#include <string>
#include <thread>
#include <vector>

namespace hydro::batch {

// Names for files that belong to a running process. They tell the remains of a killed process from files in
// use, on this host and on others.

// A process on any host: "HOST-BOOT-PID-START".
struct Owner {
  std::string host;  // "node17+4026531836": the host, and the set to which its process numbers belong
  std::string boot;  // identifies the boot of the host, 8 hex digits
  long pid = 0;
  long long started = 0;  // clock ticks after that boot
};

Owner ThisProcess();
std::string OwnerText(const Owner& owner);
// The owner at the beginning of a name; pid 0 for other names.
Owner ParseOwner(const std::string& name);

enum class Life { kRuns, kEnded, kUnknown };  // kUnknown: it is on another host
Life LifeOf(const Owner& owner);

// A name that no other object has, in this or any other process.
std::string NewOwnerName();

// Paths in `folder` whose names begin with `name` and a point.
std::vector<std::string> OwnedBy(const std::string& folder, const std::string& name);

// Paths in `folder` whose owners have ended, and paths of owners on other hosts that have not been touched
// for a day.
std::vector<std::string> LeftBehind(const std::string& folder);

// Ensures that one process at a time drives a study, on whichever host shares the folder. The results do not
// depend on it (case_store.h); it only keeps two processes from doing the same work.
//
// The lock is the file lock in the study's folder, which is made in one step and holds its owner's name. Its
// owner touches it every few seconds. The lock is taken over when its owner has ended on this host, or has
// been silent for a minute on another.
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
