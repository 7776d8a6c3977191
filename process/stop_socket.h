// A way to stop a process without a network: the process listens on a local socket.
//
// The socket is in Linux's abstract namespace, as others of a stack are: it leaves no file behind and ends
// with its process. Only requests from the same user and from root are heard. hydro-launch --stop uses the
// socket before it uses the bus.
#pragma once

#include <string>
#include <thread>
#include <vector>

namespace hydro::process {

// A socket of `kind` (SOCK_DGRAM, SOCK_SEQPACKET | SOCK_NONBLOCK ...) that is bound to the name; -1 with
// errno when the name is taken or too long (ENAMETOOLONG).
int BindAbstract(int kind, const std::string& name);

// The same kind of socket, connected to the process that listens under the name.
int ConnectAbstract(int kind, const std::string& name);

// The beginning of the names of a stack's stop sockets; port and channel suffix distinguish it from other
// stacks: "hydro-stop/7667//". The rest of a name is the role, a slash and the process id.
std::string StopSocketPrefix(int port, const std::string& channel_suffix);

// The text that is sent to such a socket: who asks, and why, in one line.
std::string StopRequestText(const std::string& role, const std::string& reason);

class StopSocket {
 public:
  // Listens on a thread of its own, for as long as the object lives. A request sets the flag of stop_signal.h
  // with the requester's role and reason. When the system provides no socket, the process runs without one: a
  // run does not depend on it. The thread inherits the process's priority and processor, which does no harm
  // because it sleeps until a request comes.
  StopSocket(const std::string& prefix, const std::string& role);
  ~StopSocket();
  StopSocket(const StopSocket&) = delete;
  StopSocket& operator=(const StopSocket&) = delete;

 private:
  void Listen();
  void Accept();
  bool Answer(int connection);  // false: the connection is no longer of use

  int listener_ = -1;
  int wake_ = -1;      // an eventfd: ends Listen()
  int spare_ = -1;     // closed to accept a requester when the process has no descriptor left
  bool deaf_ = false;  // the last requester could not be accepted
  // Kept open: when they close, the requester knows that this process has ended.
  std::vector<int> connections_;
  std::thread thread_;
};

}  // namespace hydro::process
