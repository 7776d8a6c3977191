#include "scope/wire/web_server.h"

#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <cstdio>
#include <list>
#include <optional>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/utf8.h"
#include "scope/wire/access.h"

namespace hydro::scope {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;

namespace {

constexpr size_t kMostHeader = 8192;
constexpr size_t kMostMessage = 65536;
constexpr size_t kMostInMemory = 1 << 20;  // bytes of a body

std::string_view View(beast::string_view text) { return {text.data(), text.size()}; }

// The page may have no inline scripts, load nothing from elsewhere, and be shown in no frame.
constexpr char kPolicy[] =
    "default-src 'self'; connect-src 'self'; style-src 'self'; img-src 'self' blob: data:; frame-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

}  // namespace

Response ErrorResponse(int status, const std::string& text) {
  Response response;
  response.status = status;
  response.body = "{\"error\": \"";
  for (const char c : AsUtf8(text)) {
    if (c == '"' || c == '\\') response.body += '\\';
    response.body += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  response.body += "\"}\n";
  return response;
}

class HttpSession;
class SocketSession;

class WebServer::Impl {
 public:
  explicit Impl(const WebServerOptions& given) : options(given), acceptor_(io), timer_(io), pause_(io) {
    error_code error;
    const auto address = asio::ip::make_address(options.address, error);
    if (error) {
      throw InputError("scope.bind: found \"" + options.address +
                       "\", allowed is an address such as \"127.0.0.1\"");
    }
    const tcp::endpoint endpoint(address, static_cast<unsigned short>(options.port));
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
      const bool files = error == boost::system::errc::too_many_files_open;
      throw InputError("cannot listen on " + options.address + ":" + std::to_string(options.port) + ": " +
                       error.message() +
                       (files ? "; a larger limit (ulimit -n) is needed" : "; --port 0 takes any free port"));
    }
    CheckRoom();
    port = acceptor_.local_endpoint().port();
  }

  void Run(const std::function<std::chrono::microseconds()>& turn) {
    turn_ = &turn;
    Accept();
    Turn();
    io.run();
  }

  // The sessions that are open.
  void Add(SocketSession* session) { sockets.insert(session); }
  void Remove(SocketSession* session) { sockets.erase(session); }
  int conversations() const { return static_cast<int>(sockets.size()); }

  // Connections that have shown no right to stay, the oldest first. Once the limit is reached, the oldest
  // gives way to a new one: whoever holds connections and says nothing must not keep out those who speak.
  std::list<HttpSession*> strangers;

  WebServerOptions options;
  Site* site = nullptr;
  std::optional<Access> access;
  int port = 0;
  int connections = 0;
  int64_t refused = 0;
  std::unordered_set<SocketSession*> sockets;
  asio::io_context io{1};  // last of these, because the sessions that end with it count themselves out

 private:
  void CheckRoom();
  void Accept();
  void Turn();

  tcp::acceptor acceptor_;
  asio::steady_timer timer_;  // for the turns
  asio::steady_timer pause_;  // before the next attempt to accept
  const std::function<std::chrono::microseconds()>* turn_ = nullptr;
  bool ended_ = false;
};

// Counts an open connection.
class Counted {
 public:
  explicit Counted(int* count) : count_(count) { ++*count_; }
  Counted(Counted&& other) noexcept : count_(std::exchange(other.count_, nullptr)) {}
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  Counted& operator=(Counted&&) = delete;
  ~Counted() {
    if (count_ != nullptr) --*count_;
  }

 private:
  int* count_;
};

// A web socket and its conversation.
class SocketSession : public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(WebServer::Impl& server, Counted counted, beast::tcp_stream stream,
                std::unique_ptr<Conversation> conversation)
      : server_(server),
        counted_(std::move(counted)),
        socket_(std::move(stream)),
        conversation_(std::move(conversation)) {
    server_.Add(this);
  }
  ~SocketSession() { server_.Remove(this); }
  SocketSession(const SocketSession&) = delete;
  SocketSession& operator=(const SocketSession&) = delete;

  template <class Header>
  void Accept(const Header& request, const std::string& subprotocol) {
    beast::get_lowest_layer(socket_).expires_never();
    websocket::stream_base::timeout times{};
    times.handshake_timeout = server_.options.header_time;
    times.idle_timeout = server_.options.idle_time;
    times.keep_alive_pings = true;
    socket_.set_option(times);
    socket_.read_message_max(kMostMessage);
    socket_.auto_fragment(false);
    socket_.set_option(websocket::stream_base::decorator([subprotocol](websocket::response_type& response) {
      if (!subprotocol.empty()) response.set(http::field::sec_websocket_protocol, subprotocol);
    }));
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return;
      self->open_ = true;
      self->Read();
      self->Pump();
    });
  }

  // Sends the conversation's messages, one after another.
  void Pump() {
    if (!open_ || writing_) return;
    if (conversation_->over()) return Close();
    if (!conversation_->Next(&message_)) return;
    writing_ = true;
    socket_.binary(message_.binary);
    socket_.async_write(asio::buffer(message_.bytes), [self = shared_from_this()](error_code error, size_t) {
      self->writing_ = false;
      if (error) return self->Drop();
      if (!self->reading_) self->Read();
      self->Pump();
    });
  }

 private:
  void Read() {
    if (!open_ || reading_ || !conversation_->listens()) return;
    reading_ = true;
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, size_t) {
      self->reading_ = false;
      if (error) return self->Drop();
      const auto bytes = self->buffer_.cdata();
      self->conversation_->Hear({static_cast<const char*>(bytes.data()), bytes.size()},
                                self->socket_.got_binary());
      self->buffer_.consume(self->buffer_.size());
      self->Pump();
      self->Read();
    });
  }

  void Close() {
    open_ = false;
    socket_.async_close(websocket::close_code::policy_error, [self = shared_from_this()](error_code) {});
  }

  // Ends everything that still waits on this socket.
  void Drop() {
    open_ = false;
    beast::get_lowest_layer(socket_).close();
  }

  WebServer::Impl& server_;
  Counted counted_;
  websocket::stream<beast::tcp_stream> socket_;
  std::unique_ptr<Conversation> conversation_;
  beast::flat_buffer buffer_;
  Conversation::Message message_;  // being written
  bool open_ = false;
  bool reading_ = false;
  bool writing_ = false;
};

// A connection that speaks HTTP: one request after another, until it becomes a web socket.
class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(WebServer::Impl& server, tcp::socket socket)
      : server_(server), counted_(std::in_place, &server.connections), stream_(std::move(socket)) {
    place_ = server_.strangers.insert(server_.strangers.end(), this);
  }
  ~HttpSession() { BeKnown(); }
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  void Start(bool full) {
    full_ = full;
    ReadHeader();
  }

  // Ends now, and counts no more. What waits on the socket learns of it soon.
  void GiveWay() {
    BeKnown();
    counted_.reset();
    stream_.close();
  }

 private:
  // From now on, this connection gives way to no other.
  void BeKnown() {
    if (place_) server_.strangers.erase(*place_);
    place_.reset();
  }

  using HeaderParser = http::request_parser<http::empty_body>;

  void ReadHeader() {
    header_.emplace();
    header_->header_limit(kMostHeader);
    header_->body_limit(std::numeric_limits<uint64_t>::max());  // BodyLimit() decides instead
    stream_.expires_after(server_.options.header_time);
    http::async_read_header(
        stream_, buffer_, *header_, [self = shared_from_this()](error_code error, size_t) {
          if (!error) return self->TakeHeader();
          if (error == http::error::header_limit) {
            return self->Refuse(431, "the request's header exceeds 8192 bytes");
          }
          if (error == http::error::end_of_stream || error == beast::error::timeout) {
            return self->Shut();
          }
          // A request that is not HTTP gets an answer, so that its sender sees why it failed.
          if (error.category() == http::make_error_code(http::error::bad_method).category()) {
            self->Refuse(400, "found no HTTP request: " + error.message());
          }
        });
  }

  std::string_view Field(http::field name) const { return View(header_->get()[name]); }

  void TakeHeader() {
    const auto& request = header_->get();
    if (full_) return Refuse(503, "too many connections; close other pages of this program");
    if (!server_.access->HostAllowed(Field(http::field::host))) {
      return Refuse(403,
                    "the Host header names another machine; hosts besides 127.0.0.1 and localhost are "
                    "allowed by scope.hosts");
    }
    if (!server_.access->OriginAllowed(Field(http::field::origin))) {
      return Refuse(403,
                    "a page of another origin; origins besides this program's own are allowed by "
                    "scope.origins");
    }
    if (request.count(http::field::host) != 1 || request.count(http::field::origin) > 1 ||
        request.count(http::field::authorization) > 1) {
      return Refuse(400, "a header is there twice");
    }
    auto target = ParseTarget(View(request.target()));
    if (!target) return Refuse(400, "the target of the request is no path");
    now_ = Request{};
    now_.method = std::string(View(request.method_string()));
    now_.path = std::move(target->path);
    now_.query = std::move(target->query);
    const bool socket = websocket::is_upgrade(request);
    if (socket || !server_.site->IsPublic(now_.path)) {
      const auto token = now_.query.find("token");
      const std::string_view in_query = token == now_.query.end() ? "" : std::string_view(token->second);
      if (!server_.access->TokenRight(Field(http::field::authorization), in_query)) {
        return Refuse(401,
                      "the token is missing or wrong; open the address that hydro-scope printed when it "
                      "started");
      }
      BeKnown();
    }
    now_.query.erase("token");
    if (socket) return Upgrade();
    if (now_.method != "GET" && now_.method != "POST") return Refuse(405, "allowed are GET and POST");
    ReadBody();
  }

  void Upgrade() {
    const auto offered = ListOf(Field(http::field::sec_websocket_protocol));
    std::string chosen;
    auto conversation = server_.site->Converse(now_.path, offered, &chosen);
    if (conversation == nullptr) {
      return Refuse(404, "no web socket at " + now_.path +
                             " for that subprotocol; there is /live with "
                             "hydro.scope.v1, and any path with foxglove.websocket.v1 or foxglove.sdk.v1");
    }
    const auto session = std::make_shared<SocketSession>(server_, std::move(*counted_), std::move(stream_),
                                                         std::move(conversation));
    session->Accept(header_->get(), chosen);
  }

  void ReadBody() {
    const int64_t limit = now_.method == "POST" ? server_.site->BodyLimit(now_) : 0;
    const auto length = header_->content_length();
    if (length && *length > static_cast<uint64_t>(limit)) {
      return Refuse(
          413, "the body has " + std::to_string(*length) + " bytes, allowed are " + std::to_string(limit));
    }
    if (beast::iequals(header_->get()[http::field::expect], "100-continue")) return Continue(limit);
    ReadBodyUpTo(limit);
  }

  // The client waits for permission to send its body.
  void Continue(int64_t limit) {
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    stream_.expires_after(server_.options.stall_time);
    asio::async_write(stream_, asio::buffer(kContinue.data(), kContinue.size()),
                      [self = shared_from_this(), limit](error_code error, size_t) {
                        if (!error) self->ReadBodyUpTo(limit);
                      });
  }

  void ReadBodyUpTo(int64_t limit) {
    now_.body_file = now_.method == "POST" ? server_.site->BodyFile(now_) : "";
    if (now_.body_file.empty()) {
      text_.emplace(std::move(*header_));
      text_->body_limit(std::min<uint64_t>(static_cast<uint64_t>(limit), kMostInMemory));
      ReadSome(*text_);
      return;
    }
    file_.emplace(std::move(*header_));
    file_->body_limit(static_cast<uint64_t>(limit));
    error_code error;
    file_->get().body().open(now_.body_file.c_str(), beast::file_mode::write, error);
    if (error) return Refuse(500, "cannot write " + now_.body_file + ": " + error.message());
    ReadSome(*file_);
  }

  // As long as bytes arrive, the body may take its time.
  template <class Parser>
  void ReadSome(Parser& parser) {
    if (parser.is_done()) return TakeBody();
    stream_.expires_after(server_.options.stall_time);
    http::async_read_some(stream_, buffer_, parser,
                          [self = shared_from_this(), &parser](error_code error, size_t) {
                            if (error == http::error::body_limit) {
                              return self->Refuse(413, "the body is longer than this request may have");
                            }
                            if (error) return self->Forget();
                            self->ReadSome(parser);
                          });
  }

  // Removes the file of an upload that was cut off.
  void Forget() {
    file_.reset();
    if (!now_.body_file.empty()) std::remove(now_.body_file.c_str());
  }

  void TakeBody() {
    stream_.expires_never();
    bool keep = false;
    if (text_) {
      keep = text_->get().keep_alive();
      now_.body = std::move(text_->get().body());
    } else {
      keep = file_->get().keep_alive();
      file_->get().body().close();
    }
    text_.reset();
    file_.reset();
    server_.site->Answer(std::move(now_), [self = shared_from_this(), keep](Response response) {
      self->Send(std::move(response), keep);
    });
  }

  void Refuse(int status, const std::string& text) {
    ++server_.refused;
    Forget();
    Send(ErrorResponse(status, text), false);
  }

  template <class Body>
  void SetHead(http::response<Body>& response, const Response& from, bool keep) {
    response.version(11);
    response.result(static_cast<unsigned>(from.status));
    response.set(http::field::content_type, from.type);
    response.set(http::field::cache_control, "no-store");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Referrer-Policy", "no-referrer");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Content-Security-Policy", kPolicy);
    for (const auto& [name, value] : from.headers) response.set(name, value);
    response.keep_alive(keep);
  }

  void Send(Response from, bool keep) {
    if (!from.file.empty()) return SendFile(from, keep);
    auto response = std::make_shared<http::response<http::string_body>>();
    SetHead(*response, from, keep);
    response->body() = std::move(from.body);
    response->prepare_payload();
    SendSome(response, std::make_shared<http::response_serializer<http::string_body>>(*response), keep);
  }

  void SendFile(const Response& from, bool keep) {
    auto response = std::make_shared<http::response<http::file_body>>();
    error_code error;
    response->body().open(from.file.c_str(), beast::file_mode::scan, error);
    std::remove(from.file.c_str());  // the open file keeps its bytes until it is closed
    if (error) return Send(ErrorResponse(500, "cannot read " + from.file + ": " + error.message()), keep);
    SetHead(*response, from, keep);
    response->prepare_payload();
    SendSome(response, std::make_shared<http::response_serializer<http::file_body>>(*response), keep);
  }

  template <class Body>
  void SendSome(std::shared_ptr<http::response<Body>> response,
                std::shared_ptr<http::response_serializer<Body>> serializer, bool keep) {
    stream_.expires_after(server_.options.stall_time);
    http::async_write_some(stream_, *serializer,
                           [self = shared_from_this(), response, serializer, keep](error_code error, size_t) {
                             if (error) return;
                             if (!serializer->is_done()) return self->SendSome(response, serializer, keep);
                             keep ? self->ReadHeader() : self->Shut();
                           });
  }

  void Shut() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
    Drain(0);
  }

  // For a moment, reads and discards what the client is still sending: closing a connection with unread bytes
  // resets it, and the client may lose the answer.
  void Drain(size_t drained) {
    constexpr size_t kMostDrained = 1 << 20;
    if (drained > kMostDrained) return;
    stream_.expires_after(std::chrono::seconds(2));
    buffer_.consume(buffer_.size());
    stream_.async_read_some(buffer_.prepare(16384),
                            [self = shared_from_this(), drained](error_code error, size_t bytes) {
                              if (!error) self->Drain(drained + bytes);
                            });
  }

  WebServer::Impl& server_;
  std::optional<Counted> counted_;
  std::optional<std::list<HttpSession*>::iterator> place_;  // among the strangers
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kMostHeader + kMostMessage};
  std::optional<HeaderParser> header_;
  std::optional<http::request_parser<http::string_body>> text_;
  std::optional<http::request_parser<http::file_body>> file_;
  Request now_;  // being read
  bool full_ = false;
};

// A program that can open no file serves nobody, and says nothing of it.
void WebServer::Impl::CheckRoom() {
  constexpr size_t kNeeded = 8;  // a page opens six connections at once
  std::vector<int> opened;
  while (opened.size() < kNeeded) {
    const int next = dup(acceptor_.native_handle());
    if (next < 0) break;
    opened.push_back(next);
  }
  for (const int each : opened) close(each);
  if (opened.size() == kNeeded) return;
  throw InputError("found room for " + std::to_string(opened.size()) +
                   " open files more in this process, allowed " + std::to_string(kNeeded) +
                   " or more for the connections of pages; a larger limit (ulimit -n) is needed");
}

void WebServer::Impl::Accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (ended_ || error == asio::error::operation_aborted) return;
    if (error) {  // out of file descriptors: waiting is better than a busy loop
      if (!strangers.empty()) strangers.front()->GiveWay();
      pause_.expires_after(std::chrono::milliseconds(100));
      pause_.async_wait([this](error_code) {
        if (!ended_) Accept();
      });
      return;
    }
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    if (connections >= options.most_connections && !strangers.empty()) strangers.front()->GiveWay();
    const bool full = connections >= options.most_connections;
    // Beyond twice the limit, the client does not even get an answer.
    if (connections < 2 * options.most_connections) {
      std::make_shared<HttpSession>(*this, std::move(socket))->Start(full);
    }
    Accept();
  });
}

void WebServer::Impl::Turn() {
  const std::chrono::microseconds next = (*turn_)();
  if (next.count() < 0) {
    ended_ = true;
    io.stop();
    return;
  }
  // A conversation that ends while it is asked leaves the set, so this loops over a copy.
  const std::vector<SocketSession*> now(sockets.begin(), sockets.end());
  for (SocketSession* const session : now) {
    if (sockets.contains(session)) session->Pump();
  }
  timer_.expires_after(next);
  timer_.async_wait([this](error_code error) {
    if (!error) Turn();
  });
}

WebServer::WebServer(const WebServerOptions& options) try : impl_(std::make_unique<Impl>(options)) {
} catch (const boost::system::system_error& error) {  // no room for what the library opens for itself
  throw InputError(std::string("cannot serve pages: ") + error.what() +
                   "; a larger limit (ulimit -n) is needed");
}
WebServer::~WebServer() = default;
int WebServer::port() const { return impl_->port; }
void WebServer::Open(Access access, Site* site) {
  impl_->access.emplace(std::move(access));
  impl_->site = site;
}
void WebServer::Run(const std::function<std::chrono::microseconds()>& turn) { impl_->Run(turn); }
void WebServer::Post(std::function<void()> work) { asio::post(impl_->io, std::move(work)); }
int WebServer::connections() const { return impl_->connections; }
int WebServer::conversations() const { return impl_->conversations(); }
int64_t WebServer::refused() const { return impl_->refused; }

}  // namespace hydro::scope
