#include "process/abstract_socket.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

namespace hydro::process {
namespace {

// `attach` is bind or connect.
int Attached(int kind, const std::string& name, int (*attach)(int, const sockaddr*, socklen_t)) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (name.size() + 1 > sizeof address.sun_path) {
    errno = ENAMETOOLONG;
    return -1;
  }
  std::memcpy(address.sun_path + 1, name.data(), name.size());  // the leading zero makes it abstract
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int fd = socket(AF_UNIX, kind | SOCK_CLOEXEC, 0);
  if (fd < 0 || attach(fd, reinterpret_cast<const sockaddr*>(&address), size) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

}  // namespace

int BindAbstract(int kind, const std::string& name) { return Attached(kind, name, &bind); }

int ConnectAbstract(int kind, const std::string& name) { return Attached(kind, name, &connect); }

}  // namespace hydro::process
