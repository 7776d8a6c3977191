#include "plant/front_end/link.h"

#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

namespace hydro::plant {
namespace {

bool MustWait(int error) {
  return error == EAGAIN || error == EWOULDBLOCK || error == EINTR || error == ENOBUFS;
}

// A datagram that no process took is like one that was lost: the device may be about to start.
bool NobodyThere(int error) {
  return error == ECONNREFUSED || error == EHOSTUNREACH || error == ENETUNREACH || error == ENETDOWN;
}

}  // namespace

bool Link::Open() {
  Close();
  descriptor_ = OpenDescriptor();
  return is_open();
}

void Link::Close() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  begun_.clear();
  waiting_.clear();
}

int Link::Trouble(std::string found, std::string allowed) {
  trouble_ = {std::move(found), std::move(allowed)};
  return -1;
}

size_t Link::Read(std::span<uint8_t> into) {
  size_t filled = 0;
  while (is_open() && filled < into.size()) {
    // The kernel cuts off a datagram that finds too little room.
    if (datagrams() && filled > 0 && into.size() - filled < kLargestDatagram) break;
    const ssize_t got = read(descriptor_, into.data() + filled, into.size() - filled);
    if (got > 0) {
      filled += static_cast<size_t>(got);
      continue;
    }
    if (got == 0 && datagrams()) continue;  // an empty datagram
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 && (MustWait(errno) || (datagrams() && NobodyThere(errno)))) break;
    Close();
  }
  return filled;
}

void Link::Write(std::span<const uint8_t> frame, bool must_leave) {
  // Before the line is looked at: otherwise each frame would wait behind the one before it, for ever.
  ForgetOld();
  Flush();
  if (!is_open()) return;
  if (begun_.empty() && waiting_.empty() && BytesOnTheirWay(descriptor_) <= frame.size()) {
    Send(frame);
    return;
  }
  if (!waiting_.empty()) ++frames_left_out_;
  if (!waiting_.empty() && waiting_must_leave_ && !must_leave) return;
  waiting_.assign(frame.begin(), frame.end());
  waiting_must_leave_ = must_leave;
}

void Link::ForgetOld() {
  if (waiting_.empty() || waiting_must_leave_) return;
  waiting_.clear();
  ++frames_left_out_;
}

void Link::Flush() {
  if (is_open() && !begun_.empty()) {
    const std::vector<uint8_t> rest = std::exchange(begun_, {});
    Send(rest);
  }
  if (!is_open() || !begun_.empty() || waiting_.empty()) return;
  if (BytesOnTheirWay(descriptor_) > waiting_.size()) return;
  const std::vector<uint8_t> next = std::exchange(waiting_, {});
  Send(next);
}

// A socket whose other end has gone must not end this process.
ssize_t Link::Put(std::span<const uint8_t> bytes) const noexcept {
  return kind_ == Kind::kPort ? write(descriptor_, bytes.data(), bytes.size())
                              : send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
}

// No part of a datagram is left to send later: it left whole, or it was lost.
void Link::Send(std::span<const uint8_t> bytes) {
  ssize_t sent = 0;
  do {
    sent = Put(bytes);
  } while (sent < 0 && errno == EINTR);
  if (sent < 0 && !MustWait(errno) && !(datagrams() && NobodyThere(errno))) return Close();
  if (datagrams()) {
    if (sent < 0) ++frames_left_out_;
    return;
  }
  const auto gone = static_cast<size_t>(sent < 0 ? 0 : sent);
  if (gone < bytes.size()) begun_.assign(bytes.begin() + static_cast<std::ptrdiff_t>(gone), bytes.end());
}

void Link::WriteAtOnce(std::span<const uint8_t> frame) const noexcept {
  if (descriptor_ < 0) return;
  static_cast<void>(Put(frame));
}

}  // namespace hydro::plant
