// What the server does with clients that are slow, stuck, wrong or many, over real sockets of this machine.
#include "scope/wire/web_server.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "base/input_error.h"

namespace hydro::scope {
namespace {

using namespace std::chrono_literals;

constexpr char kToken[] = "0123456789abcdef";

// Sends its number whenever it is asked, as fast as it is taken; counts what it made.
class Chatter : public Conversation {
 public:
  Chatter(std::atomic<int64_t>* made, std::atomic<int>* open, std::atomic<int>* heard)
      : made_(*made), open_(*open), heard_(*heard) {
    ++open_;
  }
  ~Chatter() override { --open_; }
  Chatter(const Chatter&) = delete;
  Chatter& operator=(const Chatter&) = delete;
  void Hear(std::string_view message, bool) override {
    ++heard_;
    chatty_ = message == "go" || chatty_;
    over_ = message == "over";
  }
  bool Next(Message* message) override {
    if (!chatty_) return false;
    ++made_;
    message->bytes.assign(100000, 'x');
    return true;
  }
  bool over() const override { return over_; }

 private:
  std::atomic<int64_t>& made_;
  std::atomic<int>& open_;
  std::atomic<int>& heard_;
  bool chatty_ = false;
  bool over_ = false;
};

class TestSite : public Site {
 public:
  bool IsPublic(const std::string& path) const override { return path == "/"; }
  int64_t BodyLimit(const Request&) const override { return 1000; }
  std::string BodyFile(const Request&) override { return {}; }
  void Answer(Request request, std::function<void(Response)> reply) override {
    Response response;
    response.type = "text/plain";
    response.body = request.method + " " + request.path + " " + request.body;
    reply(std::move(response));
  }
  std::unique_ptr<Conversation> Converse(const std::string& path, const std::vector<std::string>&,
                                         std::string*) override {
    if (path != "/live") return nullptr;
    return std::make_unique<Chatter>(&made, &open, &heard);
  }

  std::atomic<int64_t> made = 0;
  std::atomic<int> open = 0;
  std::atomic<int> heard = 0;
};

// A connection with its bytes.
class Client {
 public:
  explicit Client(int port) : fd_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  }
  ~Client() { close(fd_); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  // The server may have closed already.
  void Send(const std::string& bytes) const { send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  // Everything until the text appears, or the server closes.
  std::string ReadUntil(const std::string& text) const {
    std::string all;
    char buffer[4096];
    while (all.find(text) == std::string::npos) {
      const ssize_t bytes = recv(fd_, buffer, sizeof buffer, 0);
      if (bytes <= 0) break;
      all.append(buffer, static_cast<size_t>(bytes));
    }
    return all;
  }
  std::string ReadAll() const { return ReadUntil(std::string("\0never", 6)); }

 private:
  int fd_;
};

std::string Frame(const std::string& text) {
  std::string frame = "\x81";
  frame += static_cast<char>(0x80 | text.size());
  return frame + std::string(4, '\0') + text;  // a mask of zeros
}

class WebServerTest : public ::testing::Test {
 protected:
  static WebServerOptions Options() {
    WebServerOptions options;
    options.most_connections = 12;
    options.header_time = 300ms;
    options.stall_time = 300ms;
    options.idle_time = 2000ms;
    return options;
  }
  explicit WebServerTest(const WebServerOptions& options = Options()) : server_(options) {
    server_.Open(Access(kToken, server_.port(), {}, {}), &site_);
    thread_ = std::thread([this] {
      server_.Run([this] {
        connections_ = server_.connections();
        ++turns_;
        return std::chrono::microseconds(end_ ? -1 : 1000);
      });
    });
  }
  ~WebServerTest() override {
    end_ = true;
    thread_.join();
  }
  std::string Head(const std::string& first, const std::string& more = "") const {
    return first + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(server_.port()) + "\r\n" + more + "\r\n";
  }
  std::string Ask(const std::string& bytes) const {
    const Client client(server_.port());
    client.Send(bytes);
    return client.ReadAll().substr(0, 12);
  }
  std::string Upgrade(const std::string& path, const std::string& more = "") const {
    return Head("GET " + path,
                "Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n" +
                    more);
  }
  template <class Condition>
  static bool Eventually(Condition condition) {
    for (const auto end = std::chrono::steady_clock::now() + 20s; std::chrono::steady_clock::now() < end;) {
      if (condition()) return true;
      std::this_thread::yield();
      poll(nullptr, 0, 2);
    }
    return false;
  }

  TestSite site_;
  WebServer server_;
  std::atomic<bool> end_ = false;
  std::atomic<int> connections_ = 0;
  std::atomic<int64_t> turns_ = 0;
  std::thread thread_;
};

// Tests who gets what: public files without a token, the rest with it, and no one by another host or from
// another origin.
TEST_F(WebServerTest, ChecksEveryRequest) {
  const std::string bearer = std::string("Authorization: Bearer ") + kToken + "\r\n";
  const std::string close = "Connection: close\r\n";
  EXPECT_EQ(Ask(Head("GET /", close)), "HTTP/1.1 200");
  EXPECT_EQ(Ask(Head("GET /api", close)), "HTTP/1.1 401");
  EXPECT_EQ(Ask(Head("GET /api", close + "Authorization: Bearer 0123456789abcdee\r\n")), "HTTP/1.1 401");
  EXPECT_EQ(Ask(Head("GET /api", close + bearer)), "HTTP/1.1 200");
  EXPECT_EQ(Ask(Head(std::string("GET /api?token=") + kToken, close)), "HTTP/1.1 200");
  EXPECT_EQ(Ask(Head("GET /", close + "Origin: http://evil.example\r\n")), "HTTP/1.1 403");
  EXPECT_EQ(Ask(Head("GET /api", close + bearer + "Origin: null\r\n")), "HTTP/1.1 403");
  EXPECT_EQ(Ask("GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"), "HTTP/1.1 403");
  EXPECT_EQ(Ask("GET / HTTP/1.0\r\n\r\n"), "HTTP/1.1 403");
  EXPECT_EQ(Ask(Head("DELETE /", close)), "HTTP/1.1 405");
  EXPECT_EQ(Ask(Head("GET /%zz", close)), "HTTP/1.1 400");
}

// Tests that web sockets need the token, the host and the origin too.
TEST_F(WebServerTest, ChecksWebSockets) {
  const std::string token = std::string("?token=") + kToken;
  EXPECT_EQ(Ask(Upgrade("/live")), "HTTP/1.1 401");
  EXPECT_EQ(Ask(Upgrade("/live?token=0123456789abcdee")), "HTTP/1.1 401");
  EXPECT_EQ(Ask(Upgrade("/live" + token, "Origin: http://evil.example\r\n")), "HTTP/1.1 403");
  EXPECT_EQ(Ask(Upgrade("/other" + token)), "HTTP/1.1 404");
  const Client client(server_.port());
  client.Send(Upgrade("/live" + token));
  EXPECT_EQ(client.ReadUntil("\r\n\r\n").substr(0, 12), "HTTP/1.1 101");
}

// Tests that what is too large or no HTTP is refused.
TEST_F(WebServerTest, LimitsRequests) {
  const std::string bearer = std::string("Authorization: Bearer ") + kToken + "\r\n";
  EXPECT_EQ(Ask(Head("GET /", "X: " + std::string(10000, 'x') + "\r\n")), "HTTP/1.1 431");
  EXPECT_EQ(Ask("\x16\x03\x01\x02 no HTTP at all\r\n\r\n"), "HTTP/1.1 400");
  EXPECT_EQ(Ask(Head("POST /api", bearer + "Content-Length: 1001\r\n")), "HTTP/1.1 413");
  EXPECT_EQ(Ask(Head("POST /api", bearer + "Content-Length: 99999999999999\r\n")), "HTTP/1.1 413");
  EXPECT_EQ(Ask(Head("POST /api", bearer + "Transfer-Encoding: chunked\r\n") + "7d0\r\n" +
                std::string(2000, 'x') + "\r\n0\r\n\r\n"),
            "HTTP/1.1 413");
  EXPECT_EQ(Ask(Head("GET /api", bearer + "Content-Length: 5\r\n") + "hello"), "HTTP/1.1 413");
  EXPECT_EQ(Ask(Head("POST /api", bearer + "Connection: close\r\nContent-Length: 5\r\n") + "hello"),
            "HTTP/1.1 200");
}

// Tests that a connection serves several requests.
TEST_F(WebServerTest, KeepsConnections) {
  const Client client(server_.port());
  for (int i = 0; i < 3; ++i) {
    client.Send(Head("GET /"));
    EXPECT_NE(client.ReadUntil("GET / ").find("GET / "), std::string::npos);
  }
}

// Tests that half a header, half a body and no request at all do not stay, and do not keep others waiting.
TEST_F(WebServerTest, EndsSlowClients) {
  const std::string bearer = std::string("Authorization: Bearer ") + kToken + "\r\n";
  const Client half_header(server_.port());
  half_header.Send("GET / HTTP/1.1\r\nHo");
  const Client half_body(server_.port());
  half_body.Send(Head("POST /api", bearer + "Content-Length: 100\r\n") + "half");
  const Client silent(server_.port());
  EXPECT_EQ(Ask(Head("GET /", "Connection: close\r\n")), "HTTP/1.1 200");
  EXPECT_EQ(half_header.ReadAll(), "");
  EXPECT_EQ(half_body.ReadAll(), "");
  EXPECT_EQ(silent.ReadAll(), "");
  EXPECT_TRUE(Eventually([&] { return connections_ == 0; }));
}

// Tests that connections beyond the limit are told so.
TEST_F(WebServerTest, LimitsConnections) {
  std::vector<std::unique_ptr<Client>> clients;
  for (int i = 0; i < 12; ++i) {
    clients.push_back(std::make_unique<Client>(server_.port()));
    clients.back()->Send(Upgrade(std::string("/live?token=") + kToken));
    EXPECT_EQ(clients.back()->ReadUntil("\r\n\r\n").substr(0, 12), "HTTP/1.1 101");
  }
  EXPECT_EQ(Ask(Head("GET /")), "HTTP/1.1 503");
  clients.pop_back();
  EXPECT_TRUE(Eventually([&] { return Ask(Head("GET /", "Connection: close\r\n")) == "HTTP/1.1 200"; }));
}

// Has all the time for a header.
class PatientWebServerTest : public WebServerTest {
 protected:
  static WebServerOptions Patient() {
    WebServerOptions options = Options();
    options.header_time = options.stall_time = std::chrono::minutes(10);
    return options;
  }
  PatientWebServerTest() : WebServerTest(Patient()) {}
};

// Tests that connections which say nothing, half a header, or one request without the token and then nothing,
// give way to those who speak, the oldest first, and that a connection with the token gives way to nobody.
TEST_F(PatientWebServerTest, SilentConnectionsGiveWay) {
  const std::string bearer = std::string("Authorization: Bearer ") + kToken + "\r\n";
  const Client known(server_.port());
  known.Send(Head("GET /api", bearer));
  EXPECT_EQ(known.ReadUntil("GET /api ").substr(0, 12), "HTTP/1.1 200");
  const Client live(server_.port());
  live.Send(Upgrade(std::string("/live?token=") + kToken));
  EXPECT_EQ(live.ReadUntil("\r\n\r\n").substr(0, 12), "HTTP/1.1 101");
  std::vector<std::unique_ptr<Client>> silent;
  for (int i = 0; i < 40; ++i) {
    silent.push_back(std::make_unique<Client>(server_.port()));
    if (i % 3 == 1) silent.back()->Send("GET / HTTP/1.1\r\nHo");
    if (i % 3 == 2) silent.back()->Send(Head("GET /"));
  }
  EXPECT_EQ(Ask(Head("GET /api", bearer + "Connection: close\r\n")), "HTTP/1.1 200");
  EXPECT_EQ(silent.front()->ReadAll(), "");
  EXPECT_TRUE(Eventually([&] { return connections_ <= 12; }));
  known.Send(Head("GET /api", bearer));
  EXPECT_EQ(known.ReadUntil("GET /api ").substr(0, 12), "HTTP/1.1 200");
  live.Send(Frame("go"));
  EXPECT_TRUE(Eventually([&] { return site_.made > 0; }));
}

// Tests that for a client that does not read, nothing more is made than the kernel's buffers take, and that
// it is closed in the end, while another goes on.
TEST_F(WebServerTest, AStuckClientGrowsNothing) {
  const Client stuck(server_.port());
  stuck.Send(Upgrade(std::string("/live?token=") + kToken));
  stuck.ReadUntil("\r\n\r\n");
  stuck.Send(Frame("go"));
  int64_t before = -1;
  EXPECT_TRUE(Eventually([&] {  // the buffers are full when nothing is made for some turns
    const int64_t now = site_.made;
    const bool still = now > 0 && now == before;
    before = now;
    poll(nullptr, 0, 50);
    return still;
  }));
  EXPECT_LT(site_.made, 200);  // of 100 kB: two socket buffers, not a queue
  EXPECT_EQ(Ask(Head("GET /", "Connection: close\r\n")), "HTTP/1.1 200");
  EXPECT_TRUE(Eventually([&] { return site_.open == 0; }));
}

// Tests that conversations end with their clients, however those leave, and when one breaks the rules.
TEST_F(WebServerTest, ClientsLeave) {
  const std::string upgrade = Upgrade(std::string("/live?token=") + kToken);
  {
    const Client vanishes(server_.port());
    vanishes.Send(upgrade);
    vanishes.ReadUntil("\r\n\r\n");
    vanishes.Send(Frame("go"));
    EXPECT_TRUE(Eventually([&] { return site_.made > 0; }));
    EXPECT_EQ(site_.open, 1);
  }
  EXPECT_TRUE(Eventually([&] { return site_.open == 0; }));
  const Client wrong(server_.port());
  wrong.Send(upgrade);
  wrong.ReadUntil("\r\n\r\n");
  wrong.Send(Frame("over"));
  EXPECT_NE(wrong.ReadAll().size(), 0u);  // a close frame, then the end
  EXPECT_TRUE(Eventually([&] { return site_.open == 0; }));
  const Client huge(server_.port());
  huge.Send(upgrade);
  huge.ReadUntil("\r\n\r\n");
  const int heard = site_.heard;
  huge.Send(std::string("\x81\xff", 2) + std::string("\0\0\0\0\0\1\0\1", 8) + std::string(4, '\0') +
            std::string(65537, 'x'));
  huge.ReadAll();
  EXPECT_TRUE(Eventually([&] { return site_.open == 0; }));
  EXPECT_EQ(site_.heard, heard);
}

// Tests that a server without file descriptors goes on with its turns and its clients, does not spin, and
// takes new clients when there are descriptors again.
TEST_F(WebServerTest, WithoutFileDescriptors) {
#ifdef HYDRO_SANITIZED
  GTEST_SKIP() << "the sanitizers open pipes to look at memory; web_server_release_test runs it";
#endif
  const Client early(server_.port());
  early.Send(Upgrade("/live", std::string("Authorization: Bearer ") + kToken + "\r\n"));
  early.ReadUntil("\r\n\r\n");
  const int waiting = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(server_.port()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const int highest = dup(waiting);
  close(highest);
  rlimit none = before;
  none.rlim_cur = static_cast<rlim_t>(highest);  // the next descriptor cannot be had
  setrlimit(RLIMIT_NOFILE, &none);
  EXPECT_EQ(connect(waiting, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  const auto processor_time = [] {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  };
  const int64_t turns = turns_;
  const auto used = processor_time();
  EXPECT_TRUE(Eventually([&] { return turns_ > turns + 1000; })) << "the turns end";
  EXPECT_LT(processor_time() - used, 400ms) << "it spins";
  const int heard = site_.heard;
  early.Send(Frame("word"));
  EXPECT_TRUE(Eventually([&] { return site_.heard > heard; })) << "it serves the client that it has";
  setrlimit(RLIMIT_NOFILE, &before);
  const timeval patience{20, 0};
  setsockopt(waiting, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  const std::string request = Head("GET /");
  send(waiting, request.data(), request.size(), MSG_NOSIGNAL);
  std::string answer(4096, '\0');
  const ssize_t size = recv(waiting, answer.data(), answer.size(), 0);
  EXPECT_GT(size, 0);
  close(waiting);
}

// Tests that a port in use, or an address that is none, is said.
TEST_F(WebServerTest, SaysWhyItCannotListen) {
  WebServerOptions options;
  options.port = server_.port();
  EXPECT_THROW(WebServer{options}, InputError);
  options.port = 0;
  options.address = "somewhere";
  EXPECT_THROW(WebServer{options}, InputError);
}

}  // namespace
}  // namespace hydro::scope
