#include "plant/front_end/link.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

namespace hydro::plant {
namespace {

constexpr size_t kLargestDatagram = 65536;
constexpr int kMostDatagrams = 64;  // in one read: empty ones fill nothing, and may come without end

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
  if (datagrams()) datagram_.resize(kLargestDatagram);
  return is_open();
}

void Link::Close() {
  CloseDescriptor();
  CloseBeside();
}

void Link::CloseDescriptor() {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  begun_.clear();
  waiting_.clear();
  rest_ = {};
}

int Link::Trouble(std::string found, std::string allowed) {
  trouble_ = {std::move(found), std::move(allowed)};
  return -1;
}

size_t Link::Read(std::span<uint8_t> into) {
  size_t filled = TakeRest(into);
  for (int taken = 0; is_open() && filled < into.size();) {
    if (datagrams() && taken++ == kMostDatagrams) break;
    const std::span<uint8_t> room = datagrams() ? std::span<uint8_t>(datagram_) : into.subspan(filled);
    const ssize_t got = read(descriptor_, room.data(), room.size());
    if (got > 0 && datagrams()) {
      rest_ = room.first(static_cast<size_t>(got));
      filled += TakeRest(into.subspan(filled));
    } else if (got > 0) {
      filled += static_cast<size_t>(got);
    } else if (got == 0 && datagrams()) {
      continue;  // an empty one
    } else if (got == 0 || errno != EINTR) {
      if (got < 0 && (MustWait(errno) || (datagrams() && NobodyThere(errno)))) break;
      Close();
    }
  }
  return filled;
}

// Of the datagram that was read last, what there was no room for.
size_t Link::TakeRest(std::span<uint8_t> into) {
  const size_t count = std::min(rest_.size(), into.size());
  std::copy_n(rest_.begin(), count, into.begin());
  rest_ = rest_.subspan(count);
  return count;
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

void Link::AwaitGone() const noexcept {
  constexpr int kTries = 100;
  constexpr useconds_t kTurn_us = 1000;
  if (kind_ != Kind::kPort || descriptor_ < 0) return;
  for (int i = 0; i < kTries && BytesOnTheirWay(descriptor_) > 0; ++i) usleep(kTurn_us);
  usleep(kTurn_us);  // what the converter itself holds
}

}  // namespace hydro::plant
