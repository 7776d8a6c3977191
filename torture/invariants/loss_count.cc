#include "torture/invariants/loss_count.h"

#include "bus/messages.h"
#include "log/log_format.h"

namespace hydro::torture {

void LossCount::Handle(const Packet& state) {
  constexpr bus::NumberPlaces kPlaces = bus::PlacesOf<state_t>();
  countable_ = countable_ && state.origin == Origin::kProcess;
  if (!countable_) return;
  const auto number = [&](int place) {
    return static_cast<int64_t>(log::LoadBigEndian64(state.bytes.data() + place));
  };
  const int64_t session = number(kPlaces.session), sequence = number(kPlaces.sequence);
  if (!session_) {
    session_ = session;
  } else if (session != *session_ || sequence < newest_) {
    countable_ = false;  // which plant it follows, and from when on, is its own decision
    return;
  } else if (sequence > newest_) {
    lost_ += sequence - newest_ - 1;
  }
  newest_ = sequence;
}

}  // namespace hydro::torture
