#include "scope/signals/cut_window.h"

#include <hydro/arm_reference_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/run_description_t.hpp>
#include <hydro/state_t.hpp>

#include "runs/log/message_kinds.h"
#include "scope/signals/decoded.h"

namespace hydro::scope {
CutWindow::CutWindow(const std::string& suffix, int64_t session, double t0, double t1)
    : channels_(suffix), session_(session), t0_(t0), t1_(t1) {}

bool CutWindow::KeepsState(const uint8_t* data, int size) {
  state_t state;
  if (!Decoded(&state, data, size) || state.session != session_) return false;
  if (state.time > t1_) over_ = true;
  if (state.time < t0_ || state.time > t1_) return false;
  if (!first_tick_) first_tick_ = state.tick;
  last_tick_ = state.tick;
  ++states_;
  return true;
}

bool CutWindow::KeepsDescription(const uint8_t* data, int size) {
  run_description_t description;
  if (!Decoded(&description, data, size) || description.session != session_) return false;
  const std::string text = description.config_text + description.model_text;
  if (text == described_) return first_tick_ && !over_;
  if (over_) return false;
  described_ = text;
  return true;
}

bool CutWindow::HoldsAhead(std::string_view channel) const {
  return !first_tick_ && !over_ &&
         (channel == channels_.Of<arm_reference_t>() || channel == channels_.Of<pressure_command_t>());
}

bool CutWindow::Keeps(std::string_view channel, const uint8_t* data, int size) {
  if (channel == channels_.Of<state_t>()) return KeepsState(data, size);
  if (channel == channels_.Of<run_description_t>()) return KeepsDescription(data, size);
  bus::RawMessage message;
  message.channel = channel;
  message.data = data;
  message.size = size;
  if (const auto numbers = bus::ReadLoopNumbers(message, channels_)) {
    return first_tick_ && numbers->tick >= *first_tick_ && numbers->tick <= last_tick_;
  }
  const log::MessageKind* const kind = log::KindOfChannel(channel);
  const bool ours =
      kind != nullptr && channel == kind->channel + channels_.Of<state_t>().substr(sizeof "HYDRO_STATE" - 1);
  return ours && first_tick_ && !over_;
}

}  // namespace hydro::scope
