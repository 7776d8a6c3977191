#include "scope/side_work.h"

#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/input_error.h"

namespace hydro::scope {
namespace {

constexpr size_t kMostWaiting = 8;

std::string MakeFolder() {
  std::error_code error;
  std::string name = (std::filesystem::temp_directory_path(error) / "hydro-scope.XXXXXX").string();
  if (error || mkdtemp(name.data()) == nullptr) {
    throw InputError("cannot make a folder " + name + " for files; TMPDIR names another place");
  }
  return name;
}

}  // namespace

SideWork::SideWork(std::function<void(std::function<void()>)> post)
    : post_(std::move(post)), folder_(MakeFolder()), thread_([this] { Loop(); }) {}

SideWork::~SideWork() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  changed_.notify_all();
  thread_.join();
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
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
