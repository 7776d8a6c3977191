#include "launch/labelled_output.h"

#include <limits.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/json_text.h"
#include "base/text_file.h"

namespace hydro::launch {
namespace {

// One of six terminal colours, the same for a label in every run.
std::string ColourOf(std::string_view label) {
  unsigned sum = 0;
  for (const char c : label) sum = sum * 31 + static_cast<unsigned char>(c);
  return "\033[3" + std::to_string(1 + sum % 6) + "m";
}

}  // namespace

bool LabelledOutput::WantsColour(int out_fd, int err_fd) {
  return isatty(out_fd) && isatty(err_fd) && std::getenv("NO_COLOR") == nullptr;
}

void LabelledOutput::AnnounceLabel(std::string_view label) {
  label_width_ = std::max(label_width_, label.size());
}

bool LabelledOutput::CanDrawStatus(int out_fd, int err_fd) {
  const char* terminal = std::getenv("TERM");
  return isatty(out_fd) && isatty(err_fd) && terminal != nullptr && std::string_view(terminal) != "dumb";
}

std::string LabelledOutput::Formatted(Stream stream, std::string_view label, std::string_view text) const {
  if (json_) {
    const nlohmann::ordered_json line{
        {"source", label}, {"stream", stream == Stream::kOut ? "out" : "err"}, {"text", Printable(text)}};
    return JsonText(line) + "\n";
  }
  std::string line;
  line.reserve(label_width_ + text.size() + 16);
  if (colour_) line += ColourOf(label);
  line.append("[").append(label).append("]");
  if (colour_) line += "\033[0m";
  line.append(label_width_ > label.size() ? label_width_ - label.size() : 0, ' ');
  line.append(" ").append(Printable(text)).append("\n");
  return line;
}

void LabelledOutput::Add(Stream stream, std::string bytes) {
  queued_bytes_ += bytes.size();
  constexpr std::size_t kChunk = 64 * 1024;
  if (!queue_.empty() && queue_.back().stream == stream && queue_.back().bytes.size() < kChunk) {
    queue_.back().bytes += bytes;
  } else {
    queue_.push_back({stream, std::move(bytes)});
  }
}

void LabelledOutput::Line(Stream stream, std::string_view label, std::string_view text) {
  if (quiet_ && stream == Stream::kOut) return;
  std::string drawn;
  for (const std::string& line : status_) drawn += line + "\n";
  Add(stream, WithoutStatus() + Formatted(stream, label, text) + drawn);
}

std::string LabelledOutput::WithoutStatus() const {
  return status_.empty() ? "" : "\033[" + std::to_string(status_.size()) + "A\033[J";
}

void LabelledOutput::SetStatus(const std::vector<std::string>& lines) {
  if (lines == status_ || quiet_ || json_) return;
  std::string bytes = WithoutStatus();
  status_ = lines;
  for (const std::string& line : status_) bytes += Printable(line) + "\n";
  Add(Stream::kOut, std::move(bytes));
}

void LabelledOutput::WriteSome() {
  if (queue_.empty()) return;
  Chunk& chunk = queue_.front();
  const std::size_t left = chunk.bytes.size() - chunk.written;
  const ssize_t n =
      write(FdOf(chunk.stream), chunk.bytes.data() + chunk.written, std::min<std::size_t>(left, PIPE_BUF));
  if (n < 0 && (errno == EINTR || errno == EAGAIN)) return;
  // The reader has gone (EPIPE) or the disk is full: the stack matters more than its output, so the line is
  // discarded. Output to a reader that has gone, or to a closed descriptor, is of no use; what a full disk
  // loses is missed.
  if (n < 0 && errno != EPIPE && errno != EBADF && chunk.stream == Stream::kOut && lost_ == 0) lost_ = errno;
  const std::size_t done = n < 0 ? left : static_cast<std::size_t>(n);
  chunk.written += done;
  queued_bytes_ -= done;
  if (chunk.written == chunk.bytes.size()) queue_.pop_front();
}

void LabelledOutput::Flush() {
  while (!queue_.empty()) WriteSome();
}

}  // namespace hydro::launch
