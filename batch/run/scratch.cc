#include "batch/run/scratch.h"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>

#include "batch/store/owner.h"
#include "batch/store/store_error.h"

namespace hydro::batch {

namespace fs = std::filesystem;

Scratch::Scratch() {
  const char* place = std::getenv("TMPDIR");
  const std::string all = fs::absolute(place == nullptr || *place == '\0' ? "/tmp" : place).string() +
                          "/hydro-batch-" + std::to_string(getuid());
  if (mkdir(all.c_str(), 0700) != 0 && errno != EEXIST) ThrowCannotWrite(all);
  // Another user may have made it first, to see or change what runs there.
  struct stat status = {};
  if (lstat(all.c_str(), &status) != 0 || !S_ISDIR(status.st_mode) || status.st_uid != getuid())
    throw StoreError(all + ": found somebody else's, allowed a folder of yours; set TMPDIR");
  std::error_code ignored;
  for (const std::string& path : LeftBehind(all)) fs::remove_all(path, ignored);
  path_ = all + "/" + NewOwnerName();
  if (mkdir(path_.c_str(), 0700) != 0) ThrowCannotWrite(path_);
}

Scratch::~Scratch() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace hydro::batch
