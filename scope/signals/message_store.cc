#include "scope/signals/message_store.h"

#include <algorithm>
#include <cstring>

namespace hydro::scope {
namespace {

constexpr size_t kBlock = 1 << 20;

// Stands before a message's channel and data in a block.
struct Header {
  int64_t utime;
  uint32_t channel_size;
  uint32_t data_size;
};

// Reads the message at `bytes`; returns its length in the block.
size_t ReadMessage(const uint8_t* bytes, MessageStore::Message* message) {
  Header header;
  std::memcpy(&header, bytes, sizeof header);
  const auto* const channel = reinterpret_cast<const char*>(bytes + sizeof header);
  *message = {{channel, header.channel_size},
              bytes + sizeof header + header.channel_size,
              header.data_size,
              header.utime};
  return sizeof header + header.channel_size + header.data_size;
}

}  // namespace

MessageStore::MessageStore(size_t most_bytes) : most_blocks_(std::max<size_t>(2, most_bytes / kBlock)) {}

void MessageStore::Add(const Message& message, double t) {
  const size_t needed = sizeof(Header) + message.channel.size() + message.size;
  if (needed > kBlock) return;
  if (blocks_.empty() || blocks_.back().used + needed > kBlock) {
    if (blocks_.size() >= most_blocks_) DropFirst();
    blocks_.push_back({std::make_shared<std::vector<uint8_t>>(kBlock), 0, t});
  }
  Block& block = blocks_.back();
  uint8_t* at = block.bytes->data() + block.used;
  const Header header{message.utime, static_cast<uint32_t>(message.channel.size()),
                      static_cast<uint32_t>(message.size)};
  std::memcpy(at, &header, sizeof header);
  std::memcpy(at + sizeof header, message.channel.data(), message.channel.size());
  std::memcpy(at + sizeof header + message.channel.size(), message.data, message.size);
  block.used += needed;
  ++added_;
  block.last_t = t;
}

void MessageStore::DropBefore(double t) {
  while (blocks_.size() > 1 && blocks_.front().last_t < t) DropFirst();
}

void MessageStore::DropFirst() {
  blocks_.pop_front();
  ++dropped_blocks_;
}

MessageStore::Place MessageStore::End() const {
  if (blocks_.empty()) return {dropped_blocks_, 0, added_};
  return {dropped_blocks_ + blocks_.size() - 1, blocks_.back().used, added_};
}

bool MessageStore::Read(Place* place, Message* message) const {
  while (place->block >= dropped_blocks_ && place->block - dropped_blocks_ < blocks_.size()) {
    const Block& block = blocks_[place->block - dropped_blocks_];
    if (place->at < block.used) {
      place->at += ReadMessage(block.bytes->data() + place->at, message);
      ++place->message;
      return true;
    }
    if (place->block - dropped_blocks_ + 1 == blocks_.size()) return false;
    ++place->block;
    place->at = 0;
  }
  return false;
}

uint64_t MessageStore::CatchUp(Place* place, uint64_t most) const {
  const uint64_t behind = added_ - place->message;
  if (place->block >= dropped_blocks_ && behind <= most) return 0;
  *place = End();
  return behind;
}

MessageStore::Snapshot MessageStore::Take() const {
  Snapshot snapshot;
  snapshot.parts_.reserve(blocks_.size());
  for (const Block& block : blocks_) snapshot.parts_.push_back({block.bytes, block.used});
  return snapshot;
}

size_t MessageStore::memory() const { return blocks_.size() * kBlock; }

void MessageStore::Snapshot::ForEach(const std::function<void(const Message&)>& visit) const {
  for (const Part& part : parts_) {
    for (size_t at = 0; at < part.used;) {
      Message message;
      at += ReadMessage(part.bytes->data() + at, &message);
      visit(message);
    }
  }
}

}  // namespace hydro::scope
