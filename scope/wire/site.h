// What a web server serves, without the details of HTTP: requests that are answered, and conversations over a
// web socket.
//
// A conversation is asked for its next message when the socket has taken the one before. So no queue of
// waiting messages can grow: a client that reads slowly gets what is newest when it is ready, and one that
// does not read gets nothing.
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
  std::string body_file;  // the file to which Site::BodyFile() had the body written; the answerer removes it
};

struct Response {
  int status = 200;
  std::string type = "application/json";
  std::string body;
  std::string file;  // sent instead of the body, then removed
  std::vector<std::pair<std::string, std::string>> headers;
};

// The answer {"error": text} with that status.
Response ErrorResponse(int status, const std::string& text);

class Conversation {
 public:
  struct Message {
    std::string bytes;
    bool binary = false;
  };

  virtual ~Conversation() = default;

  // Takes a message from the client.
  virtual void Hear(std::string_view message, bool binary) = 0;

  // Gives the next message to send; returns false when there is none now. Called after each message that was
  // heard or sent, and at each turn.
  virtual bool Next(Message* message) = 0;

  // False when so much is unanswered that nothing more is read from the client until it has taken some of it.
  virtual bool listens() const { return true; }

  // True when the client broke a rule; the connection is then closed.
  virtual bool over() const { return false; }
};

class Site {
 public:
  virtual ~Site() = default;

  // Whether this path is open to every client that passes the checks of host and origin. All other paths need
  // the token.
  virtual bool IsPublic(const std::string& path) const = 0;

  // The largest body in bytes that this request may have.
  virtual int64_t BodyLimit(const Request& head) const = 0;

  // The name of a new file for a body that is too large for memory; empty: the body goes to Request::body.
  virtual std::string BodyFile(const Request& head) = 0;

  // Calls `reply` once, now or later, on the server's thread.
  virtual void Answer(Request request, std::function<void(Response)> reply) = 0;

  // Answers a client's request for a web socket. `offered` holds its subprotocols, in its order; `chosen`
  // receives the one to use, if any. Null: there is no conversation on this path.
  virtual std::unique_ptr<Conversation> Converse(const std::string& path,
                                                 const std::vector<std::string>& offered,
                                                 std::string* chosen) = 0;
};

}  // namespace hydro::scope
