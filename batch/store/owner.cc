#include "batch/store/owner.h"

#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <filesystem>
#include <sstream>

#include "base/host_name.h"
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

}  // namespace hydro::batch
