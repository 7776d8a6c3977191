// Unix sockets with an abstract name: they need no file, and end with their process.
#pragma once

#include <string>

namespace hydro::process {

// A socket of `kind` (SOCK_DGRAM, SOCK_SEQPACKET | SOCK_NONBLOCK ...) that is bound to the name; -1 with
// errno when the name is taken or too long (ENAMETOOLONG).
int BindAbstract(int kind, const std::string& name);

// The same kind of socket, connected to the process that listens under the name.
int ConnectAbstract(int kind, const std::string& name);

}  // namespace hydro::process
