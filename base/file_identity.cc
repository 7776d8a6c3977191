#include "base/file_identity.h"

#include <sys/stat.h>

namespace hydro {

std::optional<FileIdentity> IdentityOf(const std::string& file) {
  struct stat status;
  if (stat(file.c_str(), &status) != 0) return std::nullopt;
  return FileIdentity{status.st_dev, status.st_ino};
}

}  // namespace hydro
