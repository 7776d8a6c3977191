// The newest messages of a running stack as they were received, so that they can be cut out as a log.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

namespace hydro::scope {

class MessageStore {
 public:
  struct Message {
    std::string_view channel;
    const uint8_t* data = nullptr;
    size_t size = 0;
    int64_t utime = 0;  // us, time of receipt
  };

  // Keeps at most `most_bytes`, and a block more.
  explicit MessageStore(size_t most_bytes);

  // `t` is the plant time at receipt in s. Messages of more than 1 MiB are left out.
  void Add(const Message& message, double t);

  // Drops whole blocks of messages received before `t`.
  void DropBefore(double t);

  // What is kept now. It does not change, and another thread may read it while the store continues.
  class Snapshot {
   public:
    void ForEach(const std::function<void(const Message&)>& visit) const;

   private:
    friend class MessageStore;
    struct Part {
      std::shared_ptr<const std::vector<uint8_t>> bytes;
      size_t used = 0;
    };
    std::vector<Part> parts_;
  };
  Snapshot Take() const;

  // A reader's place between two messages.
  struct Place {
    uint64_t block = 0;  // counted from the first block that ever was
    size_t at = 0;
    uint64_t message = 0;  // counted likewise
  };
  // The place after the newest message.
  Place End() const;
  // Reads the message at the place, which stays valid until the store changes, and moves on. Returns false
  // when there is none yet.
  bool Read(Place* place, Message* message) const;
  // Moves to the end when more than `most` messages follow, or when some were dropped. Returns how many are
  // left out.
  uint64_t CatchUp(Place* place, uint64_t most) const;

  size_t memory() const;

 private:
  struct Block {
    std::shared_ptr<std::vector<uint8_t>> bytes;
    size_t used = 0;
    double last_t = 0;
  };

  void DropFirst();

  size_t most_blocks_;
  uint64_t dropped_blocks_ = 0;
  uint64_t added_ = 0;  // number of messages
  std::deque<Block> blocks_;
};

}  // namespace hydro::scope
