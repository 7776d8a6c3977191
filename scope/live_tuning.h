// Tuning from the page: shows the values in force and requests other values, over the scope's own bus.
// Without a request it only listens.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bus/bus.h"
#include "bus/channels.h"
#include "bus/clock.h"
#include "scope/operator_actions.h"
#include "tune/live/tuning_client.h"

namespace hydro::scope {

class LiveTuning : public Tuning {
 public:
  // `run` is the live run to which the values belong, and `control` says whether the page may make requests.
  // Both go into the message.
  LiveTuning(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels, uint32_t run,
             bool control);

  void Set(const std::vector<std::string>& entries, Done done) override;
  void Undo(Done done) override;
  const std::string& message() const override { return message_; }

  // Processes what has been heard. Call it after each turn of the bus.
  void Poll();

 private:
  // Whether a request can be sent now; otherwise calls `done` with the reason.
  bool Ready(const Done& done);
  void Describe();

  tuning::TuningClient client_;
  uint32_t run_;
  bool control_;
  Done waiting_;  // receives the answer; null: no request is pending
  std::string message_;
  // Session of the values in the message.
  std::optional<int64_t> session_;
  int64_t version_ = -1;
};

}  // namespace hydro::scope
