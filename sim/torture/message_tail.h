// What happened in the last moments of a run, with a line for each message that was sent or handled. It helps
// to find out why a schedule fails (hydro-torture --replay FILE --tail S).
#pragma once

#include <deque>
#include <string>

#include "sim/torture/machines/packet.h"

namespace hydro::torture {

class MessageTail {
 public:
  // Keeps the lines that are at most that many seconds (true time) older than the newest one.
  explicit MessageTail(double seconds) : kept_(static_cast<TrueTime>(seconds * 1e9)) {}

  // From now on keeps one line for each fault that a process publishes, and nothing else.
  void KeepFaultsOnly() { faults_only_ = true; }

  // `who` is a text like "plant 1000", `what` is "sends" or "handles". The message's numbers and its subject
  // are decoded.
  void AddMessage(TrueTime at, const std::string& who, const std::string& what, const std::string& channel,
                  const Packet& packet);
  void Add(TrueTime at, const std::string& who, const std::string& text);

  // All lines, oldest first.
  std::string Text() const;

 private:
  struct Line {
    TrueTime at;
    std::string text;
  };
  void Keep(TrueTime at, const std::string& who, const std::string& text);

  const TrueTime kept_;
  bool faults_only_ = false;
  std::deque<Line> lines_;
};

}  // namespace hydro::torture
