// The trigger of an oscilloscope, which looks at every sample.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "scope/signals/run.h"

namespace hydro::scope {

struct TriggerRequest {
  enum class Edge { kRising, kFalling, kEither };
  enum class Mode { kAuto, kNormal, kSingle };
  enum class On { kLevel, kFault, kStep };

  uint32_t id = 0;
  uint32_t run = 0;
  std::string channel;  // signal that the level belongs to
  double level = 0;
  Edge edge = Edge::kRising;
  double hysteresis = 0;  // how far the signal must have been on the other side of the level
  double holdoff = 0;     // s after a trigger in which there is no other trigger
  double pre = 0.25;      // share of the span that lies before the trigger
  Mode mode = Mode::kNormal;
  On on = On::kLevel;
  double span = 1;  // s
  uint32_t pixels = 1000;
  std::vector<std::string> channels;  // channels that a capture shows
};

class Trigger {
 public:
  struct Capture {
    std::string state;  // armed, triggered, auto, stopped
    double t = 0;       // s, time of the trigger
    std::string bins;   // a binary message (bins.h); empty with "armed" and "stopped"
  };

  // Throws InputError when a channel is unknown or a number makes no sense. Earlier samples do not trigger.
  Trigger(TriggerRequest request, const Run& run);

  // Arms the trigger again after a single capture has stopped it.
  void Arm();

  // The newest complete capture since the last call, if there is one. Captures between the two are counted.
  std::optional<Capture> Next(const Run& run);

  const TriggerRequest& request() const { return request_; }
  uint64_t skipped() const { return skipped_; }

 private:
  enum class State { kToArm, kArmed, kToStop, kStopped };
  void Follow(const Run& run);
  void Scan(const Run& run);
  void ScanEvents(const Run& run);
  bool Crosses(double value);
  void Fire(double t);
  Capture Captured(const Run& run, double t, const char* state) const;

  TriggerRequest request_;
  const Run* run_ = nullptr;
  History::Row next_row_ = 0;
  uint64_t next_event_ = 0;
  State state_ = State::kToArm;
  // On which side of the level the signal has been, judged with the hysteresis.
  bool was_below_ = false;
  bool was_above_ = false;
  std::optional<double> fired_;    // a trigger whose capture is not yet complete
  std::optional<double> capture_;  // a complete one
  double quiet_until_ = 0;         // s, before which there is no trigger
  double shown_ = 0;               // s, the newest sample when the last capture was made
  uint64_t skipped_ = 0;
};

}  // namespace hydro::scope
