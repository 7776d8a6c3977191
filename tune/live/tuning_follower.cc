#include "tune/live/tuning_follower.h"

#include <limits>
#include <utility>

namespace hydro::tuning {
namespace {

using namespace std::chrono_literals;

constexpr auto kStatusPeriod = 1s;
constexpr auto kLongestWait = 1500ms;  // the plant reports the values in force once a second

}  // namespace

TuningFollower::TuningFollower(process::Participant& participant, const settings::StackConfig& config,
                               Prepare prepare)
    : participant_(participant),
      joining_(config.time.mode == settings::TimeMode::kLockstep
                   ? std::numeric_limits<int64_t>::max()
                   : kJoiningSamples * config.position_interval_ticks),
      prepare_(std::move(prepare)) {
  status_ = {};
  status_.role = participant.role();
  status_.since = status_.refused = -1;
  participant.bus().Subscribe<tuned_settings_t>(
      participant.channels().Of<tuned_settings_t>(),
      [this](const tuned_settings_t& settings) { OnSettings(settings); });
}

void TuningFollower::OnSettings(const tuned_settings_t& settings) {
  const int64_t run = participant_.run();  // 0: no plant yet
  if ((run != 0 && settings.session != run) || participant_.Refuses(settings.session)) return;
  if (settings.session != plant_) {  // another run: it begins as configured, or as its plant says
    plant_ = settings.session;
    next_status_ = {};  // the plant asks only those that have reported
    waiting_.reset();
    status_.refused = -1;
    if (in_force_ != 0) in_force_ = -1;  // that plant's numbers are not this one's
  }
  const bool known = waiting_ && waiting_->version == settings.version;
  switch (settings.stage) {
    case tuned_settings_t::PROPOSED:
      if (settings.version != in_force_ && !known) Keep(settings);
      Say();
      return;
    case tuned_settings_t::DECIDED:
      if (settings.version == in_force_ || settings.acts_at < 0) return;
      if (known) {
        Date(settings);
      } else {
        Keep(settings);
      }
      Say();
      return;
    case tuned_settings_t::WITHDRAWN:
      if (known) waiting_.reset();
      return;
    case tuned_settings_t::IN_FORCE:
      heard_ = true;
      // The version was not received when it was decided. One that is decided and waits for its tick stays.
      if (settings.version != in_force_ && !known) Keep(settings);
      if (waiting_ && waiting_->version == settings.version && waiting_->acts_at < 0) Date(settings);
      return;
    default:
      return;
  }
}

// Sets the tick from which the prepared settings hold. Nothing else is taken from the message, because its
// values have not been checked.
void TuningFollower::Date(const tuned_settings_t& settings) {
  waiting_->stage = settings.stage;
  waiting_->acts_at = settings.acts_at;
  waiting_->reference_from = settings.reference_from;
}

void TuningFollower::Keep(const tuned_settings_t& settings) {
  status_.text = prepare_(settings);
  if (status_.text.empty()) {
    waiting_ = settings;
  } else {
    status_.refused = settings.version;
  }
}

const tuned_settings_t* TuningFollower::TakeWaitingAt(int64_t tick) {
  if (waiting_->acts_at < 0 || tick < waiting_->acts_at) return nullptr;
  taken_ = std::move(*waiting_);
  waiting_.reset();
  in_force_ = taken_.version;
  status_.since = tick;
  next_status_ = {};  // reported soon, not in the middle of a cycle
  return &taken_;
}

bool TuningFollower::AwaitsUnsettled(int64_t tick) {
  const bool first = participant_.tick() < 0 && !joined_;
  if (first && !participant_.clock().simulated() && tick > joining_) joined_ = participant_.clock().Now();
  return joined_ && !heard_ && participant_.clock().Now() - *joined_ < kLongestWait;
}

void TuningFollower::Say() {
  next_status_ = participant_.clock().Now() + kStatusPeriod;
  status_.utime = participant_.clock().Utime();
  status_.tick = participant_.tick();
  status_.session = participant_.session();
  status_.plant = plant_;
  status_.in_force = in_force_;
  status_.ready_for = waiting_ ? waiting_->version : in_force_;
  participant_.bus().Publish(participant_.channels().Of<tuning_status_t>(), status_);
}

}  // namespace hydro::tuning
