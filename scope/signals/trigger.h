// The trigger of an oscilloscope, evaluated on every sample.
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
  std::string channel;  // of the level
  double level = 0;
  Edge edge = Edge::kRising;
  double hysteresis = 0;  // the signal must have been this far on the other side of the level
  double holdoff = 0;     // s, after a trigger, in which there is no other
  double pre = 0.25;      // share of the span that lies before the trigger
  Mode mode = Mode::kNormal;
  On on = On::kLevel;
  double span = 1;  // s
  uint32_t pixels = 1000;
  std::vector<std::string> channels;  // that a capture shows
};

class Trigger {
 public:
  struct Capture {
    std::string state;  // armed, triggered, auto, stopped
    double t = 0;       // s, of the trigger
    std::string bins;   // a binary message (bins.h); empty with "armed" and "stopped"
  };

  // Throws InputError when a channel is unknown or a number makes no sense. What came before does not trigger.
  Trigger(TriggerRequest request, const Run& run);

  // After a single one has stopped.
  void Arm();

  // What there is to tell: the newest complete capture since the last call. Those that came between are counted.
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
  // On which side of the level the signal has been, by the hysteresis.
  bool was_below_ = false;
  bool was_above_ = false;
  std::optional<double> fired_;    // its capture is not complete
  std::optional<double> capture_;  // complete
  double quiet_until_ = 0;         // s, no trigger before this
  double shown_ = 0;               // s, newest when the last capture was made
  uint64_t skipped_ = 0;
};

}  // namespace hydro::scope
