// The three kinds of links: how each is opened, and what to do when it cannot be.
#include <fcntl.h>
#include <linux/serial.h>
#include <linux/sockios.h>
#include <netdb.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <sys/un.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/text_file.h"
#include "plant/front_end/link.h"
#include "process/spawn.h"

namespace hydro::plant {
namespace {

constexpr int kPriority = 6;  // priority of packets, above all others that leave this machine

std::string Found(const std::string& what, int error) {
  return Quoted(what) + " (" + process::ReasonOf(error) + ")";
}

// What is allowed when a link cannot be opened: `usual`, unless the reason lies in this process.
std::string AllowedAfter(int error, const std::string& usual) {
  return error == EMFILE || error == ENFILE ? "room for one more open file in this process" : usual;
}

// Sets raw bytes in both directions, no modem lines, and the speed if one is asked for.
bool MakeRaw(int port, int baud) {
  termios settings = {};
  if (tcgetattr(port, &settings) != 0) return false;
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CRTSCTS | CSTOPB);
  settings.c_cc[VMIN] = 1;  // with 0, a read that finds nothing would look like the end of the port
  settings.c_cc[VTIME] = 0;
  if (baud != 0) {
    const speed_t speed = *settings::BaudConstant(baud);
    if (cfsetispeed(&settings, speed) != 0 || cfsetospeed(&settings, speed) != 0) return false;
  }
  return tcsetattr(port, TCSANOW, &settings) == 0;
}

// tcsetattr() succeeds when any one of the requested changes was made.
bool HasSpeed(int port, int baud) {
  termios settings = {};
  return tcgetattr(port, &settings) == 0 && cfgetospeed(&settings) == *settings::BaudConstant(baud);
}

// USB converters otherwise collect incoming bytes for up to 16 ms. A port that does not know this request
// loses nothing.
void AskForLowLatency(int port) {
  serial_struct serial = {};
  if (ioctl(port, TIOCGSERIAL, &serial) != 0) return;
  serial.flags |= ASYNC_LOW_LATENCY;
  ioctl(port, TIOCSSERIAL, &serial);
  serial.closing_wait = ASYNC_CLOSING_WAIT_NONE;  // close() must not wait for a device that takes nothing
  ioctl(port, TIOCSSERIAL, &serial);              // in a call of its own: only root may set it
}

// On a pseudo terminal, TIOCEXCL would outlive this process because its other end stays open.
bool IsPseudoTerminal(int port) {
  constexpr unsigned kFirst = 136, kLast = 143;  // majors of the kernel's list of devices
  struct stat status = {};
  return fstat(port, &status) == 0 && major(status.st_rdev) >= kFirst && major(status.st_rdev) <= kLast;
}

class SerialLink : public Link {
 public:
  SerialLink(std::string path, int baud) : Link(Kind::kPort), path_(std::move(path)), baud_(baud) {}

 protected:
  int OpenDescriptor() override {
    const int port = open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (port < 0) return CannotOpen(errno);
    const int result = SetUp(port);
    if (result < 0) close(port);
    return result;
  }

  size_t BytesOnTheirWay(int port) const noexcept override {
    int bytes = 0;
    return ioctl(port, TIOCOUTQ, &bytes) == 0 && bytes > 0 ? static_cast<size_t>(bytes) : 0;
  }

 private:
  int SetUp(int port) {
    if (isatty(port) == 0) {
      return Trouble(Quoted(path_) + ", which is no serial port",
                     "the port of the front end; ls -l /dev/serial/by-id lists those of USB");
    }
    // TIOCEXCL keeps out every process but root's; the lock keeps out those that ask for it.
    if (flock(port, LOCK_EX | LOCK_NB) != 0) return CannotOpen(EBUSY);
    if (!IsPseudoTerminal(port)) ioctl(port, TIOCEXCL);
    if (!MakeRaw(port, baud_)) {
      return Trouble(Found(path_, errno),
                     "a port that carries raw bytes" + AtItsSpeed() + "; try another baud rate");
    }
    if (baud_ != 0 && !HasSpeed(port, baud_)) {
      return Trouble("baud=" + std::to_string(baud_) + " for " + Quoted(path_),
                     "a rate that this port can do: it kept the one that it had");
    }
    AskForLowLatency(port);
    tcflush(port, TCIOFLUSH);
    return port;
  }

  int CannotOpen(int error) {
    std::string allowed =
        "a serial port; ls -l /dev/serial/by-id lists those of USB: is the device plugged in?";
    if (error == EACCES || error == EPERM) {
      allowed = "a port that you may use: sudo usermod -aG dialout \"$USER\", then log in again";
    } else if (error == EBUSY) {
      allowed = "a port that no other program has open; fuser -v " + path_ +
                " names it (often ModemManager or a terminal)";
    } else if (error == EISDIR) {
      allowed = "the port of the front end, not a folder";
    }
    return Trouble(Found(path_, error), AllowedAfter(error, allowed));
  }

  std::string AtItsSpeed() const { return baud_ == 0 ? "" : " at " + std::to_string(baud_) + " baud"; }

  std::string path_;
  int baud_;
};

class UdpLink : public Link {
 public:
  UdpLink(std::string host, std::string port)
      : Link(Kind::kDatagrams), host_(std::move(host)), port_(std::move(port)) {}
  ~UdpLink() override {
    UdpLink::CloseBeside();
    if (addresses_ != nullptr) freeaddrinfo(addresses_);
  }

  std::string HeardElsewhere() override {
    constexpr int kMost = 64;
    sockaddr_storage from = {};
    socklen_t size = 0;
    bool heard = false;
    for (int i = 0; i < kMost && strangers_ >= 0; ++i) {
      sockaddr_storage sender = {};
      socklen_t length = sizeof sender;
      char none = 0;
      if (recvfrom(strangers_, &none, 1, 0, reinterpret_cast<sockaddr*>(&sender), &length) < 0) break;
      from = sender;
      size = length;
      heard = true;
    }
    return heard ? NameOf(from, size) : "";
  }

 protected:
  // The name is looked up once: a name server takes too long for a run.
  int OpenDescriptor() override {
    if (addresses_ == nullptr && !LookUp()) return -1;
    const int opened = socket(addresses_->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    // The socket is connected so that the kernel drops packets that do not come from the device.
    if (opened < 0 || connect(opened, addresses_->ai_addr, addresses_->ai_addrlen) != 0) {
      const int error = errno;
      if (opened >= 0) close(opened);
      return Trouble(
          Found(host_ + ":" + port_, error),
          AllowedAfter(error, "an address that this machine has a route to; ip route get " + host_));
    }
    setsockopt(opened, SOL_SOCKET, SO_PRIORITY, &kPriority, sizeof kPriority);
    ListenForStrangers(opened);
    return opened;
  }

  void CloseBeside() override {
    if (strangers_ >= 0) close(strangers_);
    strangers_ = -1;
  }

 private:
  // What the kernel would drop comes to a second socket on the same port, to tell from where a device answers
  // that has another address than it was asked at. Without it nothing is missing but these words.
  void ListenForStrangers(int opened) {
    CloseBeside();
    sockaddr_storage here = {};
    socklen_t size = sizeof here;
    if (getsockname(opened, reinterpret_cast<sockaddr*>(&here), &size) != 0) return;
    strangers_ = socket(here.ss_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const int yes = 1, no = 0;
    setsockopt(opened, SOL_SOCKET, SO_REUSEPORT, &yes, sizeof yes);
    setsockopt(strangers_, SOL_SOCKET, SO_REUSEPORT, &yes, sizeof yes);
    const bool bound = bind(strangers_, reinterpret_cast<const sockaddr*>(&here), size) == 0;
    // Nobody else shall share the port.
    setsockopt(opened, SOL_SOCKET, SO_REUSEPORT, &no, sizeof no);
    setsockopt(strangers_, SOL_SOCKET, SO_REUSEPORT, &no, sizeof no);
    if (!bound) CloseBeside();
  }

  static std::string NameOf(const sockaddr_storage& address, socklen_t size) {
    char host[NI_MAXHOST], port[NI_MAXSERV];
    const int error = getnameinfo(reinterpret_cast<const sockaddr*>(&address), size, host, sizeof host, port,
                                  sizeof port, NI_NUMERICHOST | NI_NUMERICSERV);
    if (error != 0) return "an address without a name";
    const bool v6 = address.ss_family == AF_INET6;
    return (v6 ? "[" : "") + std::string(host) + (v6 ? "]:" : ":") + port;
  }

  bool LookUp() {
    addrinfo hints = {};
    hints.ai_socktype = SOCK_DGRAM;
    const int error = getaddrinfo(host_.c_str(), port_.c_str(), &hints, &addresses_);
    if (error == 0) return true;
    addresses_ = nullptr;
    Trouble(Quoted(host_) + " (" + gai_strerror(error) + ")",
            "the name or the address of the front end; ping " + host_);
    return false;
  }

  std::string host_;
  std::string port_;
  addrinfo* addresses_ = nullptr;
  int strangers_ = -1;  // on the port of the link
};

class UnixLink : public Link {
 public:
  explicit UnixLink(std::string path) : Link(Kind::kStream), path_(std::move(path)) {}

 protected:
  int OpenDescriptor() override {
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path_.c_str(), path_.size() + 1);
    const int opened = socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (opened >= 0 && connect(opened, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0)
      return opened;
    const int error = errno;
    if (opened >= 0) close(opened);
    std::string allowed = "the socket on which the front end listens: has it been started?";
    if (error == EACCES || error == EPERM) allowed = "a socket that you may write to: ls -l " + path_;
    if (error == EAGAIN) allowed = "a front end that takes a connection: another program has it";
    if (error == EPROTOTYPE) allowed = "a stream socket";
    return Trouble(Found(path_, error), AllowedAfter(error, allowed));
  }

  // What the device has not read yet, with what the kernel adds to it: nothing, or more than a frame.
  size_t BytesOnTheirWay(int opened) const noexcept override {
    int bytes = 0;
    return ioctl(opened, SIOCOUTQ, &bytes) == 0 && bytes > 0 ? static_cast<size_t>(bytes) : 0;
  }

 private:
  std::string path_;
};

}  // namespace

std::unique_ptr<Link> MakeLink(const settings::FrontEndUrl& url) {
  switch (url.kind) {
    case settings::FrontEndUrl::Kind::kSerial:
      return std::make_unique<SerialLink>(url.path, url.baud);
    case settings::FrontEndUrl::Kind::kUdp:
      return std::make_unique<UdpLink>(url.host, url.port);
    case settings::FrontEndUrl::Kind::kUnix:
      break;
  }
  return std::make_unique<UnixLink>(url.path);
}

}  // namespace hydro::plant
