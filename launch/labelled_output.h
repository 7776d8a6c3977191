// Writes the lines of several programs to one stdout and one stderr, each labelled with its source.
#pragma once

#include <cstddef>
#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::launch {

// Lines are written whole and in the order in which they were added: a line of one stream is complete before
// one of the other begins, also when both streams are the same file. Nothing is dropped; full() tells the
// caller when to stop reading from the children until the reader of this output has caught up. Nothing here
// blocks except Flush().
class LabelledOutput {
 public:
  enum class Stream { kOut, kErr };

  // Writes to the two descriptors, which the caller keeps. With `colour`, labels are coloured.
  LabelledOutput(int out_fd, int err_fd, bool colour) : out_fd_(out_fd), err_fd_(err_fd), colour_(colour) {}

  // Whether labels should be coloured: both are terminals and NO_COLOR is not set.
  static bool WantsColour(int out_fd, int err_fd);

  // Labels are padded to the longest announced one.
  void AnnounceLabel(std::string_view label);

  // Adds the line "[label]   text". `text` has no line end.
  void Line(Stream stream, std::string_view label, std::string_view text);

  // Sets lines that stay below all others and are drawn anew with each; only for terminals. An empty list
  // removes them.
  void SetStatus(const std::vector<std::string>& lines);

  // From now on, set_quiet() leaves out lines of kOut (--quiet), and set_json() makes every line a JSON
  // object with source, stream and text (--json).
  void set_quiet() { quiet_ = true; }
  void set_json() { json_ = true; }
  // Adds a line of JSON unchanged.
  void Json(const std::string& object) { Add(Stream::kOut, object + "\n"); }

  // Whether a status can be drawn: both descriptors are one terminal that understands cursor movements.
  static bool CanDrawStatus(int out_fd, int err_fd);

  // The descriptor that must be writable for the next byte; -1: nothing waits.
  int waiting_fd() const { return queue_.empty() ? -1 : FdOf(queue_.front().stream); }
  bool full() const { return queued_bytes_ > kMostQueued; }
  std::size_t unread() const { return queued_bytes_; }

  // Writes at most PIPE_BUF bytes. When waiting_fd() polls as writable, the call does not block, even on a
  // blocking descriptor: a pipe that polls as writable has that much room.
  void WriteSome();

  // errno of the first line for stdout that could not be written; 0: none. A reader that has gone does not
  // count.
  int lost() const { return lost_; }

  // Writes everything that waits, and blocks until that is done.
  void Flush();

 private:
  static constexpr std::size_t kMostQueued = 1 << 20;
  struct Chunk {
    Stream stream;
    std::string bytes;
    std::size_t written = 0;
  };

  void Add(Stream stream, std::string bytes);
  std::string Formatted(Stream stream, std::string_view label, std::string_view text) const;
  std::string WithoutStatus() const;  // the text that erases it

  int FdOf(Stream stream) const { return stream == Stream::kOut ? out_fd_ : err_fd_; }

  int out_fd_;
  int err_fd_;
  bool colour_;
  bool quiet_ = false;
  bool json_ = false;
  std::vector<std::string> status_;  // the status as drawn
  std::size_t label_width_ = 0;
  std::deque<Chunk> queue_;
  std::size_t queued_bytes_ = 0;
  int lost_ = 0;
};

}  // namespace hydro::launch
