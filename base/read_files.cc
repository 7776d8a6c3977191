#include "base/read_files.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>

#include "base/file_identity.h"
#include "base/input_error.h"

namespace hydro {
namespace {

std::mutex mutex;
std::set<FileIdentity>& Read() {
  static std::set<FileIdentity> read;
  return read;
}

}  // namespace

void RememberRead(const std::string& file) {
  const auto identity = IdentityOfRegular(file);
  if (!identity) return;
  const std::lock_guard lock(mutex);
  Read().insert(*identity);
}

bool WasRead(const std::string& file) {
  const auto identity = IdentityOfRegular(file);
  if (!identity) return false;
  const std::lock_guard lock(mutex);
  return Read().contains(*identity);
}

void CheckKeeps(const std::string& output, const std::vector<std::string>& inputs) {
  const auto identity = IdentityOfRegular(output);
  if (!identity) return;
  const bool is_input = std::any_of(inputs.begin(), inputs.end(), [&](const std::string& input) {
    return IdentityOfRegular(input) == identity;
  });
  if (!is_input && !WasRead(output)) return;
  throw InputError(output +
                   ": found the name of a file that is read, allowed: another, so that it is not replaced");
}

void CheckDistinct(const std::vector<std::string>& outputs) {
  std::map<std::string, std::string> by_place;
  for (const std::string& output : outputs) {
    if (output.empty()) continue;
    std::error_code ignored;
    const std::filesystem::path place =
        std::filesystem::weakly_canonical(std::filesystem::absolute(output), ignored);
    const bool device =
        std::filesystem::exists(place, ignored) && !std::filesystem::is_regular_file(place, ignored);
    if (device) continue;
    const auto [known, is_new] = by_place.emplace(place, output);
    if (is_new) continue;
    throw InputError(output + ": found two outputs of this name" +
                     (known->second == output ? "" : " (the other is written " + known->second + ")") +
                     ", allowed: one, so that neither replaces the other");
  }
}

void ForgetRead(const std::string& file) {
  const auto identity = IdentityOfRegular(file);
  if (!identity) return;
  const std::lock_guard lock(mutex);
  Read().erase(*identity);
}

}  // namespace hydro
