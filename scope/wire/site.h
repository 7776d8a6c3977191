// What a web server serves, without HTTP's details: requests that are answered, and conversations over a web socket.
//
// A conversation is asked for its next message when the socket has taken the one before. So nothing waits in a queue that
// could grow: a client that reads slowly gets what is newest when it is ready, and one that does not read gets nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace hydro::scope {

struct Request {
  std::string method;                        // "GET" or "POST"
  std::string path;                          // decoded, without the query: "/api/status"
  std::map<std::string, std::string> query;  // decoded
  std::string body;
  std::string body_file;  // where Site::BodyFile() asked the body to be written; the answerer removes it
};

struct Response {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string file;  // instead of the body; sent, then removed
  std::vector<std::pair<std::string, std::string>> headers;
};

// {"error": text} with that status.
Response ErrorResponse(int status, const std::string& text);

class Conversation {
 public:
  struct Message {
    std::string bytes;
    bool binary = false;
  };

  virtual ~Conversation() = default;

  // A message of the client's.
  virtual void Hear(std::string_view message, bool binary) = 0;

  // The next message to send; false: none now. Called after each message that was heard or sent, and at each turn.
  virtual bool Next(Message* message) = 0;

  // False: so much is unanswered that nothing more is read from the client until it has taken some of it.
  virtual bool listens() const { return true; }

  // True: the client broke a rule; the connection is closed.
  virtual bool over() const { return false; }
};

class Site {
 public:
  virtual ~Site() = default;

  // Whether this path is for everybody who passes the checks of host and origin; others need the token.
  virtual bool IsPublic(const std::string& path) const = 0;

  // The most bytes of a body that this request may have.
  virtual int64_t BodyLimit(const Request& head) const = 0;

  // A new file's name for a body that is too large for memory; empty: it goes to Request::body.
  virtual std::string BodyFile(const Request& head) = 0;

  // Calls `reply` once, now or later, on the server's thread.
  virtual void Answer(Request request, std::function<void(Response)> reply) = 0;

  // A client asks for a web socket. `offered`: its subprotocols, in its order; `chosen` receives the one to speak, if any.
  // Null: nothing is spoken there.
  virtual std::unique_ptr<Conversation> Converse(const std::string& path,
                                                 const std::vector<std::string>& offered,
                                                 std::string* chosen) = 0;
};

}  // namespace hydro::scope
