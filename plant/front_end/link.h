// The way to a front end: it carries bytes to and from a serial port or a socket. Nothing here waits.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "settings/front_end_url.h"

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
  virtual ~Link() { Close(); }
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  // Opens the link, or opens it again. Returns whether that succeeded; if not, trouble() gives the reason.
  // Takes no longer than the system call, even when nothing is connected at the other end.
  bool Open();
  void Close();
  bool is_open() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }  // to wait on; -1: closed
  const LinkTrouble& trouble() const { return trouble_; }

  // Reads the bytes that have come, up to the size of `into`; returns their number, 0: none. Datagrams are
  // read one after the other, each whole: when less than kLargestDatagram is left of `into`, there may be
  // more. A link whose other end has gone is closed.
  size_t Read(std::span<uint8_t> into);
  static constexpr size_t kLargestDatagram = 1500;  // bytes that Ethernet carries whole

  // Hands over one frame, and sends any frame that waits. At most one frame is on its way: while the previous
  // one has not left this machine, the new frame replaces the one that waits, and the replaced frame is
  // counted. A frame that is not one tick's command `must_leave`: commands do not replace it.
  void Write(std::span<const uint8_t> frame, bool must_leave = false);
  void Flush();
  // The tick of the waiting frame is over: the frame is left out unless it must leave.
  void ForgetOld();

  // For signal handlers: writes the frame with one system call, even if another one waits.
  void WriteAtOnce(std::span<const uint8_t> frame) const noexcept;

  // The number of frames that Write() had to leave out because the link was too slow for them.
  int64_t frames_left_out() const { return frames_left_out_; }

 protected:
  // The open, non-blocking descriptor; -1 after Trouble().
  virtual int OpenDescriptor() = 0;
  // The number of bytes that the kernel still has to send; 0 if it does not tell.
  virtual size_t BytesOnTheirWay(int) const { return 0; }
  int Trouble(std::string found, std::string allowed);

 private:
  void Send(std::span<const uint8_t> bytes);
  ssize_t Put(std::span<const uint8_t> bytes) const noexcept;
  bool datagrams() const { return kind_ == Kind::kDatagrams; }

  const Kind kind_;
  int descriptor_ = -1;
  LinkTrouble trouble_;
  std::vector<uint8_t> begun_;    // the rest of a frame that has left in part
  std::vector<uint8_t> waiting_;  // the newest frame that has not begun to leave
  bool waiting_must_leave_ = false;
  int64_t frames_left_out_ = 0;
};

// Makes a link that is not yet open.
std::unique_ptr<Link> MakeLink(const settings::FrontEndUrl& url);

}  // namespace hydro::plant
