#include "batch/store/study_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <sstream>
#include <thread>

#include "base/host_name.h"
#include "base/input_error.h"
#include "base/number_text.h"
#include "batch/store/small_file.h"

namespace hydro::batch {
namespace {

std::string ThisBoot() {
  static const std::string boot =
      ReadSmallFile("/proc/sys/kernel/random/boot_id").value_or("00000000").substr(0, 8);
  return boot;
}

// The 22nd field of /proc/PID/stat; 0 when there is no such process.
long long StartOf(long pid) {
  const auto text = ReadSmallFile("/proc/" + std::to_string(pid) + "/stat");
  if (!text || text->rfind(')') == std::string::npos) return 0;
  std::istringstream fields(text->substr(text->rfind(')') + 1));
  std::string field;
  for (int i = 3; i <= 22; ++i) fields >> field;
  return ParseInteger(field).value_or(0);
}

// The host together with its set of process numbers, because containers have their own. '-' separates the
// parts of an owner's text.
std::string PlainHost() {
  static const std::string plain = [] {
    std::string host = HostName();
    std::ranges::replace(host, '-', '_');
    std::ranges::replace(host, '/', '_');
    struct stat numbers = {};
    const bool known = stat("/proc/self/ns/pid", &numbers) == 0;
    return known ? host + "+" + std::to_string(numbers.st_ino) : host;
  }();
  return plain;
}

bool IsOld(const std::filesystem::path& path) {
  std::error_code failed;
  const auto changed = std::filesystem::last_write_time(path, failed);
  return !failed && std::filesystem::file_time_type::clock::now() - changed > std::chrono::hours(24);
}

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

Owner ThisProcess() { return {PlainHost(), ThisBoot(), getpid(), StartOf(getpid())}; }

std::string OwnerText(const Owner& owner) {
  return owner.host + "-" + owner.boot + "-" + std::to_string(owner.pid) + "-" +
         std::to_string(owner.started);
}

Owner ParseOwner(const std::string& name) {
  std::istringstream parts(
      name.substr(0, name.find('.', name.rfind('-') == std::string::npos ? 0 : name.rfind('-'))));
  Owner owner;
  std::string pid, started;
  std::getline(parts, owner.host, '-');
  std::getline(parts, owner.boot, '-');
  std::getline(parts, pid, '-');
  std::getline(parts, started, '-');
  owner.pid = ParseInteger(pid).value_or(0);
  owner.started = ParseInteger(started).value_or(0);
  return owner;
}

Life LifeOf(const Owner& owner) {
  if (owner.pid <= 0 || owner.host != PlainHost()) return Life::kUnknown;
  if (owner.boot != ThisBoot()) return Life::kEnded;
  return StartOf(owner.pid) == owner.started && owner.started != 0 ? Life::kRuns : Life::kEnded;
}

std::string NewOwnerName() {
  static std::atomic<int> count = 0;
  return OwnerText(ThisProcess()) + "." + std::to_string(count++);
}

std::vector<std::string> OwnedBy(const std::string& folder, const std::string& name) {
  std::vector<std::string> paths;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    if (entry.path().filename().string().starts_with(name + ".")) paths.push_back(entry.path());
  }
  return paths;
}

std::vector<std::string> LeftBehind(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    const Life life = LifeOf(ParseOwner(entry.path().filename()));
    if (life == Life::kEnded || (life == Life::kUnknown && IsOld(entry.path())))
      paths.push_back(entry.path());
  }
  return paths;
}

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
