#include "batch/store/study_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

#include "base/input_error.h"
#include "base/number_text.h"
#include "batch/store/owner.h"
#include "batch/store/small_file.h"
#include "batch/store/store_error.h"

namespace hydro::batch {
namespace {

constexpr auto kBeat = std::chrono::seconds(5);
constexpr double kSilent = 60;   // s
constexpr int kMostUnread = 50;  // by then, a lock that is being released is free or has a new owner
constexpr auto kUnread = std::chrono::milliseconds(20);

double Seconds(const timespec& time) {
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

// The current time according to the folder's file system, which may use another host's clock. 0 when it
// cannot be found.
double TimeThere(const std::string& folder) {
  const std::string path = folder + "/lock.time." + NewOwnerName();
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return 0;
  struct stat status = {};
  const bool known = fstat(descriptor, &status) == 0;
  close(descriptor);
  unlink(path.c_str());
  return known ? Seconds(status.st_mtim) : 0;
}

void Touch(const std::string& file) { utimensat(AT_FDCWD, file.c_str(), nullptr, 0); }

}  // namespace

bool StudyLock::Holder(const std::string& folder, LockHolder* holder) {
  const std::string file = folder + "/lock";
  struct stat status = {};
  const auto text = ReadSmallFile(file);
  if (!text || stat(file.c_str(), &status) != 0) return false;
  const Owner owner = ParseOwner(*text);
  holder->host = owner.host.substr(0, owner.host.find('+'));
  holder->pid = owner.pid;
  const double now = TimeThere(folder);
  holder->silent_s = now == 0 ? 0 : std::max(0.0, now - Seconds(status.st_mtim));
  const Life life = LifeOf(owner);
  holder->gone = life == Life::kEnded || (life == Life::kUnknown && holder->silent_s > kSilent);
  return true;
}

bool StudyLock::Make() {
  const int descriptor = open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    if (errno == EEXIST) return false;
    ThrowCannotWrite(file_);
  }
  const bool wrote = write(descriptor, owner_.data(), owner_.size()) == static_cast<ssize_t>(owner_.size());
  const int error = errno;
  if (close(descriptor) == 0 && wrote) return true;
  unlink(file_.c_str());
  errno = error;
  ThrowCannotWrite(file_);
}

StudyLock::StudyLock(const std::string& folder) : file_(folder + "/lock"), owner_(NewOwnerName()) {
  for (int attempt = 0, unread = 0; !Make(); ++attempt) {
    LockHolder holder;
    if (!Holder(folder, &holder)) {  // just released, or unreadable
      if (++unread > kMostUnread) {
        throw InputError(file_ +
                         ": found something that cannot be read, allowed is the lock that hydro-batch makes; "
                         "remove it if no hydro-batch runs there");
      }
      std::this_thread::sleep_for(kUnread);
      --attempt;
      continue;
    }
    if (!holder.gone || attempt > 3) {
      throw InputError(folder + ": found it in use by hydro-batch, process " + std::to_string(holder.pid) +
                       " on " + holder.host + " (seen " + ShortNumber(holder.silent_s, 2) +
                       " s ago); wait for that one, stop it, or ask it with --status " + folder);
    }
    // One of those that see the lock left behind moves it away. A lock that another process has made since
    // then is put back.
    const std::string left = ReadSmallFile(file_).value_or("");
    const std::string away = file_ + "." + owner_;
    if (rename(file_.c_str(), away.c_str()) == 0) {
      if (ReadSmallFile(away).value_or("") != left && link(away.c_str(), file_.c_str()) != 0) attempt = 3;
      unlink(away.c_str());
    }
  }
  heartbeat_ = std::jthread([file = file_](const std::stop_token& stop) {
    std::mutex own;
    std::condition_variable_any wait;
    std::unique_lock lock(own);
    while (!wait.wait_for(lock, stop, kBeat, [] { return false; }) && !stop.stop_requested()) Touch(file);
  });
}

StudyLock::~StudyLock() {
  heartbeat_.request_stop();
  heartbeat_.join();
  if (ReadSmallFile(file_).value_or("") == owner_) unlink(file_.c_str());
}

}  // namespace hydro::batch
