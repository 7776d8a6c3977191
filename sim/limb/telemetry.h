// Decides which of a joint's messages leave its process: states and commands at a chosen rate, faults and
// ends at once, the rest in between.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/messages.h"

namespace hydro::limb {

// How a joint's message goes out.
enum class Passage {
  kSampled,    // messages of the loops: one per interval, with sequence numbers of their own
  kAtOnce,     // faults, ends, answers to an operator, if the joint itself has sent them
  kInBetween,  // descriptions, statistics
  kNever,      // messages from outside
};

class Telemetry {
 public:
  // `out` is the bus on which messages go out. `interval` is the number of ticks from one sampled message to
  // the next on a channel; 1: every message goes out unchanged.
  Telemetry(bus::Bus& out, int64_t interval);

  // From now on, sends what a joint publishes on `joint`. `phase` is the number of ticks by which its samples
  // are early, so that not all joints send at one tick. `is_own` tells whether a session is the joint's. This
  // object must outlive `joint`.
  void Add(bus::Bus& joint, const std::string& suffix, int64_t phase,
           std::function<bool(int64_t session)> is_own);

  // The run is ending, so the newest message of each channel and all later messages go out.
  void PassAll();

  // Sends waiting messages while `goes_on` allows it, but at least one.
  void Send(const std::function<bool()>& goes_on);
  // Sends all waiting messages.
  void SendAll();

  size_t waiting() const { return end_ - first_; }
  int64_t left_out() const { return left_out_; }  // messages for which the queue was full

 private:
  struct Channel {
    std::string name;
    bus::LoopPart part = bus::LoopPart::kNone;
    Passage passage = Passage::kNever;
    bus::NumberPlaces places;
    int64_t slot = -1;                 // of the newest sample
    int64_t sequence = 0;              // of the next sample
    int64_t skipped = 0;               // ticks skipped by the states since the newest sample
    std::vector<uint8_t> newest = {};  // the message, if it was left out; else empty
  };
  struct Stack {
    std::vector<Channel> channels;  // those of the loops come first
    int64_t phase = 0;
    std::function<bool(int64_t)> is_own;
  };
  struct Waiting {
    const Channel* channel = nullptr;
    std::vector<uint8_t> bytes;  // reused
  };

  void OnMessage(Stack& stack, const bus::RawMessage& message);
  void OnSample(const Stack& stack, Channel& channel, const bus::RawMessage& message);
  void Sample(Channel& channel, const uint8_t* data, size_t size);
  std::vector<uint8_t>* Enqueue(const Channel& channel, const uint8_t* data, size_t size);

  bus::Bus& out_;
  int64_t interval_;
  std::vector<std::unique_ptr<Stack>> stacks_;
  std::vector<Waiting> queue_;  // a ring whose size is a power of 2
  size_t first_ = 0;
  size_t end_ = 0;
  int64_t left_out_ = 0;
};

}  // namespace hydro::limb
