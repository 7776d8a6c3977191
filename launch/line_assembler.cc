#include "launch/line_assembler.h"

namespace hydro::launch {

void LineAssembler::Feed(std::string_view bytes, const LineHandler& handler) {
  while (!bytes.empty()) {
    const std::size_t end = bytes.find('\n');
    const std::size_t room = kLongestLine - unfinished_.size();
    if (end == std::string_view::npos && bytes.size() < room) {
      unfinished_.append(bytes);
      return;
    }
    const bool whole = end != std::string_view::npos && end <= room;
    const std::string_view piece = bytes.substr(0, whole ? end : room);
    bytes.remove_prefix(piece.size() + (whole ? 1 : 0));
    if (unfinished_.empty()) {
      handler(piece);
    } else {
      unfinished_.append(piece);
      handler(unfinished_);
      unfinished_.clear();
    }
  }
}

void LineAssembler::Finish(const LineHandler& handler) {
  if (unfinished_.empty()) return;
  handler(unfinished_);
  unfinished_.clear();
}

}  // namespace hydro::launch
