// Decides which messages of a run belong to a window of its time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "bus/channels.h"

namespace hydro::scope {

// A cut is a log of its own: it has the run's description, the states of the window, and the commands that
// belong to their ticks.
class CutWindow {
 public:
  // The window is [t0, t1] in s of plant time. `session` is the plant's; messages of other plants are left
  // out.
  CutWindow(const std::string& suffix, int64_t session, double t0, double t1);

  // Whether this message belongs to the window. Call it for each message of the run, in order.
  bool Keeps(std::string_view channel, const uint8_t* data, int size);

  // Whether this message, from before the window, states something that holds in the window until the next
  // message of its kind. The last such message belongs to the cut.
  bool HoldsAhead(std::string_view channel) const;

  int64_t states() const { return states_; }

 private:
  bool KeepsState(const uint8_t* data, int size);
  bool KeepsDescription(const uint8_t* data, int size);

  const bus::Channels channels_;
  int64_t session_;
  double t0_;
  double t1_;
  std::optional<int64_t> first_tick_;  // of the window
  int64_t last_tick_ = 0;
  bool over_ = false;
  std::string described_;  // the configuration that is in the cut
  int64_t states_ = 0;
};

}  // namespace hydro::scope
