// A way to stop a process that needs no network: a local socket on which it listens.
//
// The socket is in Linux's abstract namespace, so it leaves no file behind, and ends with its process. Only the same user and root
// are heard. hydro-launch --stop uses it before it uses the bus.
#pragma once

#include <string>
#include <thread>
#include <vector>

namespace hydro::process {

// The beginning of the names of all stop sockets of a stack, which its port and channel suffix tell from others:
// "hydro-stop/7667//". A name goes on with role, slash and process id.
std::string StopSocketPrefix(int port, const std::string& channel_suffix);

// What such a socket is sent: who asks, and why, one line.
std::string StopRequestText(const std::string& role, const std::string& reason);

class StopSocket {
 public:
  // Listens, on a thread of its own, for as long as it lives. A request sets the flag of stop_signal.h with
  // the requester's role and reason. Where no socket can be had there is none: a run does not depend on it.
  // The thread inherits the process's priority and processor: it sleeps until it is asked.
  StopSocket(const std::string& prefix, const std::string& role);
  ~StopSocket();
  StopSocket(const StopSocket&) = delete;
  StopSocket& operator=(const StopSocket&) = delete;

 private:
  void Listen();
  void Accept();
  bool Answer(int connection);  // false: the connection is of no more use

  int listener_ = -1;
  int wake_ = -1;                 // an eventfd: ends Listen()
  int spare_ = -1;                // given up for a requester when the process has no descriptor left
  bool deaf_ = false;             // the last one could not be accepted
  std::vector<int> connections_;  // kept open: their end tells the requester that this process has ended
  std::thread thread_;
};

}  // namespace hydro::process
