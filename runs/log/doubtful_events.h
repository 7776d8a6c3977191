// Messages that no run can use: those that are not what their channel holds, and those for which no checksum
// vouches and which damage has changed by all appearances.
#pragma once

#include <cstdint>
#include <vector>

#include "base/mapped_file.h"
#include "runs/log/sound_events.h"

namespace hydro::log {

// Moves such messages from `kept` to `lost`. Each recording is judged by itself, because another may come
// from another version or another stack; `joins` are the bytes at which another recording begins.
// - A message of this stack that is incomplete, where others on its channel are complete.
// - A message without a checksum whose sender nearly is one that has messages with a checksum on that
//   channel: a flipped bit in a session looks like one more sender.
// - A description of a run without a checksum that differs from what its sender says in any message with a
//   checksum or, where it has none, in most. Every reader needs the configuration and the model.
void DropDoubtful(const MappedFile& file, const std::vector<int64_t>& joins, std::vector<KeptEvent>& kept,
                  std::vector<LostBytes>& lost);

}  // namespace hydro::log
