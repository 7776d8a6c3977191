#include "scope/side_work.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/input_error.h"
#include "base/interruption.h"

namespace hydro::scope {
namespace {

constexpr size_t kMostWaiting = 8;

constexpr std::string_view kName = "hydro-scope.";
constexpr time_t kSurelyLocked_s = 60;  // s; a folder is locked right after it is made

// Removes the folders of scopes that were killed: they exist, belong to this user, and nothing holds their
// lock.
void RemoveAbandoned(const std::filesystem::path& temporary) {
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(temporary, ignored)) {
    if (!entry.path().filename().string().starts_with(kName)) continue;
    const int folder = open(entry.path().c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (folder < 0) continue;
    struct stat about {};
    const bool old = fstat(folder, &about) == 0 && about.st_uid == geteuid() &&
                     time(nullptr) - about.st_mtime > kSurelyLocked_s;
    if (old && flock(folder, LOCK_EX | LOCK_NB) == 0) std::filesystem::remove_all(entry.path(), ignored);
    close(folder);
  }
}

std::string MakeFolder() {
  std::error_code error;
  const std::filesystem::path temporary = std::filesystem::temp_directory_path(error);
  if (!error) RemoveAbandoned(temporary);
  std::string name = (temporary / (std::string(kName) + "XXXXXX")).string();
  if (error || mkdtemp(name.data()) == nullptr) {
    throw InputError("cannot make a folder " + name + " for files; TMPDIR names another place");
  }
  return name;
}

// Takes the lock that shows other scopes that this one is alive. The lock ends with the process, however the
// process ends.
int LockFolder(const std::string& name) {
  const int folder = open(name.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder >= 0) flock(folder, LOCK_SH | LOCK_NB);
  return folder;
}

}  // namespace

SideWork::SideWork(std::function<void(std::function<void()>)> post)
    : post_(std::move(post)),
      folder_(MakeFolder()),
      lock_(LockFolder(folder_)),
      thread_([this] { Loop(); }) {}

SideWork::~SideWork() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;  // also interrupts the work in progress
  }
  changed_.notify_all();
  thread_.join();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
  if (lock_ >= 0) close(lock_);
}

bool SideWork::Do(std::function<std::function<void()>()> work) {
  const std::lock_guard lock(mutex_);
  if (waiting_.size() >= kMostWaiting) return false;
  waiting_.push_back(std::move(work));
  changed_.notify_all();
  return true;
}

std::string SideWork::FreshFile(const std::string& ending) {
  const std::lock_guard lock(mutex_);
  return folder_ + "/" + std::to_string(++files_) + ending;
}

void SideWork::Loop() {
  const Interruption interruption(&ended_);
  while (true) {
    std::function<std::function<void()>()> work;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return ended_ || !waiting_.empty(); });
      if (ended_) return;
      work = std::move(waiting_.front());
      waiting_.pop_front();
    }
    post_(work());
  }
}

}  // namespace hydro::scope
