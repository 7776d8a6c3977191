// The way to a front end: it carries bytes to and from a serial port or a socket. Nothing here waits.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "settings/urls.h"

namespace hydro::plant {

// The reason why a link cannot be opened, in the words of an error message.
struct LinkTrouble {
  std::string found;    // "\"/dev/ttyACM0\" (Permission denied)"
  std::string allowed;  // what is allowed, and what to do
};

class Link {
 public:
  enum class Kind { kPort, kStream, kDatagrams };

  explicit Link(Kind kind) : kind_(kind) {}
  virtual ~Link() { CloseDescriptor(); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  // Opens the link, or opens it again. Returns whether that succeeded; if not, trouble() gives the reason.
  // Takes no longer than the system call, even when nothing is connected at the other end.
  bool Open();
  void Close();
  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }  // to wait on; -1: closed
  const LinkTrouble& trouble() const { return trouble_; }

  // All bytes that have come, but no more than `into` holds; 0: none. Datagrams come one after the other,
  // whole: what `into` has no room for comes with the next call. A call takes a bounded number of them, so
  // that no flood of empty ones holds it. A link whose other end has gone is closed.
  size_t Read(std::span<uint8_t> into);

  // Hands over one frame, and sends any frame that waits. At most one frame is on its way: while the previous
  // one has not left this machine, the new frame replaces the one that waits, and the replaced frame is
  // counted. A frame that is not one tick's command `must_leave`: commands do not replace it.
  void Write(std::span<const uint8_t> frame, bool must_leave = false);
  void Flush();
  // The tick of the waiting frame is over: the frame is left out unless it must leave.
  void ForgetOld();

  // For signal handlers: writes the frame with one system call, even if another one waits.
  void WriteAtOnce(std::span<const uint8_t> frame) const noexcept;

  // Until what this machine has to send on a port has left, a tenth of a second at most: its last close drops
  // the rest. For signal handlers, too.
  void AwaitGone() const noexcept;

  // Of datagrams that have come from an address other than the one that was asked, which are not used: where
  // the newest is from, "127.0.0.1:7701"; empty: none has come since the last call. Takes a bounded number.
  virtual std::string HeardElsewhere() { return ""; }

  // Frames that Write() had to leave out because the link was too slow for them.
  int64_t frames_left_out() const { return frames_left_out_; }

 protected:
  // The open, non-blocking descriptor; -1 after Trouble().
  virtual int OpenDescriptor() = 0;
  // Closes what OpenDescriptor() has opened beside it.
  virtual void CloseBeside() {}
  // Bytes that the kernel still has to send; 0 where it does not tell.
  virtual size_t BytesOnTheirWay(int) const noexcept { return 0; }
  int Trouble(std::string found, std::string allowed);

 private:
  void CloseDescriptor();
  size_t TakeRest(std::span<uint8_t> into);
  void Send(std::span<const uint8_t> bytes);
  ssize_t Put(std::span<const uint8_t> bytes) const noexcept;
  bool datagrams() const { return kind_ == Kind::kDatagrams; }

  const Kind kind_;
  int descriptor_ = -1;
  LinkTrouble trouble_;
  std::vector<uint8_t> datagram_;  // the last one; empty for other kinds
  std::span<const uint8_t> rest_;  // of it, what was not handed over yet
  std::vector<uint8_t> begun_;     // the rest of a frame that has partly left
  std::vector<uint8_t> waiting_;   // the newest frame that has not begun to leave
  bool waiting_must_leave_ = false;
  int64_t frames_left_out_ = 0;
};

// Makes a link that is not yet open.
std::unique_ptr<Link> MakeLink(const settings::FrontEndUrl& url);

}  // namespace hydro::plant
