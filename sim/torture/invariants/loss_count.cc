#include "sim/torture/invariants/loss_count.h"

#include "bus/messages.h"

namespace hydro::torture {

void LossCount::Handle(const Packet& state) {
  constexpr bus::NumberPlaces kPlaces = bus::PlacesOf<state_t>();
  countable_ = countable_ && state.origin == Origin::kProcess;
  if (!countable_) return;
  const int64_t session = NumberAt(state, kPlaces.session), sequence = NumberAt(state, kPlaces.sequence);
  if (!session_) {
    session_ = session;
  } else if (session != *session_ || sequence < newest_) {
    countable_ = false;  // the process decides which plant it follows, and from when on
    return;
  } else if (sequence > newest_) {
    lost_ += sequence - newest_ - 1;
  }
  newest_ = sequence;
}

}  // namespace hydro::torture
