// HTTP and web sockets on one port, on one thread, for a few clients that may be slow, stuck or hostile.
//
// - A request must pass the checks of Access. Its header must end within 10 s and 8 KiB. A body or an answer
//   that makes no progress for 20 s ends the connection. There are 64 connections at a time: for one more,
//   the oldest that has shown no token gives way; when all have, the new one is turned away.
// - A web socket's messages have at most 64 KiB. A client that is silent for 30 s is asked whether it is
//   there, and its connection is closed when it does not answer.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "scope/wire/access.h"
#include "scope/wire/site.h"

namespace hydro::scope {

struct WebServerOptions {
  std::string address = "127.0.0.1";
  int port = 0;  // 0: any free one
  int most_connections = 64;
  std::chrono::milliseconds header_time{10000};  // within which a request's header must have arrived
  std::chrono::milliseconds stall_time{20000};   // without progress
  std::chrono::milliseconds idle_time{30000};    // of a web socket without any sign of life
};

class WebServer {
 public:
  // Listens from now on. Throws InputError for an address or a port that is not available.
  explicit WebServer(const WebServerOptions& options);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;

  // Sets who is served, and what. Call it before Run(), once the port is known.
  void Open(Access access, Site* site);

  // Serves until `turn` returns a negative time. `turn` is called at once, and then each time after the time
  // that it returned last. After each turn, every conversation is asked for what is new.
  void Run(const std::function<std::chrono::microseconds()>& turn);

  // Soon runs `work` on the thread of Run(). Any thread may call this.
  void Post(std::function<void()> work);

  int connections() const;    // HTTP and web sockets
  int conversations() const;  // web sockets
  int64_t refused() const;    // requests that failed the checks

  class Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace hydro::scope
