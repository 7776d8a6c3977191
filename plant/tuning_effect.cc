// TuningServer's way from a proposal to its effect: which controllers must be able to act by it, at which
// tick it acts, and what the plant itself does then.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "plant/tuning_server.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

constexpr auto kAlive = 2500ms;  // a controller reports once a second
// After the start of a run: a loop reports once a second, and soon after it first hears the plant.
constexpr auto kYoung = 1500ms;
constexpr double kLead_s = 0.02;  // from the decision to its effect: long enough for several repeats
constexpr size_t kMostUndo = 100;
constexpr size_t kMostControllers = 16;

}  // namespace

// Names the controllers that cannot act by the proposal or have not answered yet; empty when all can.
std::string TuningServer::NotReady(bool* impossible) const {
  const int64_t version = pending_->version->message.version;
  for (const auto& [key, controller] : controllers_) {
    if (participant_.clock().Now() - controller.heard > kAlive) continue;  // it has left
    *impossible = controller.refused == version;
    if (*impossible) return fmt::format("{} cannot act by it: {}", key.first, controller.text);
    if (controller.ready_for != version && controller.in_force != version) {
      return fmt::format("{} has not answered", key.first);
    }
  }
  return "";
}

// Both loops act on multiples of the position loop's interval, or at their next tick after such a multiple.
int64_t TuningServer::TickOfEffect() const {
  const int64_t interval = configured_->position_interval_ticks;
  const auto lead =
      static_cast<int64_t>(std::ceil(kLead_s * configured_->plant.rate_hz * configured_->time.speed));
  const int64_t soonest = participant_.tick() + std::max<int64_t>({lead, 2 * interval, 4});
  return (soonest + interval - 1) / interval * interval;
}

void TuningServer::AwaitControllers() {
  bool impossible = false;
  const std::string not_ready = NotReady(&impossible);
  if (not_ready.empty()) {
    Decide();
  } else if (impossible || participant_.clock().Now() >= pending_->deadline) {
    Publish(&pending_->version->message, tuned_settings_t::WITHDRAWN);
    Refuse(not_ready + "; nothing has changed");
  }
}

void TuningServer::Decide() {
  tuned_settings_t& message = pending_->version->message;
  message.acts_at = TickOfEffect();
  if (message.reference_from < 0) message.reference_from = message.acts_at;
  Publish(&message, tuned_settings_t::DECIDED);
  Accept(message, pending_->text);
}

bool TuningServer::IsYoung() const { return !begun_ || participant_.clock().Now() - *begun_ < kYoung; }

void TuningServer::OnTickWithWork(int64_t tick) {
  if (!begun_) begun_ = participant_.clock().Now();
  if (!followed_.empty()) FollowAt(tick);
  if (!pending_ || !pending_->version) return;
  const int64_t acts_at = pending_->version->message.acts_at;
  if (acts_at < 0 || tick < acts_at) return;
  Version version = std::move(*pending_->version);
  const bool undo = pending_->request.kind == tuning_request_t::UNDO;
  pending_.reset();
  if (undo) {
    before_.pop_back();
  } else {
    if (before_.size() == kMostUndo) before_.erase(before_.begin());
    before_.push_back(in_force_);
  }
  TakeEffect(std::move(version));
}

void TuningServer::TakeEffect(Version version) {
  in_force_ = std::move(version);
  if (tuning::Read(in_force_.message, configured_->model.description.parameters.k_2, &values_).empty()) {
    hooks_.apply(values_);
  }
  next_report_ = {};
}

// The controllers hear of the change in the tick before.
void TuningServer::FollowAt(int64_t tick) {
  while (!followed_.empty() && followed_.back().acts_at - 1 <= tick) {
    tuned_settings_t& next = followed_.back();
    if (next.acts_at > tick) {
      Publish(&next, tuned_settings_t::DECIDED);
      return;
    }
    newest_version_ = next.version;
    TakeEffect({in_force_.config, next});
    followed_.pop_back();
  }
}

void TuningServer::OnStatus(const tuning_status_t& status) {
  if (status.plant != participant_.session() || participant_.Refuses(status.session)) return;
  if (status.role != "pressure_ctrl" && status.role != "position_ctrl") return;
  const auto now = participant_.clock().Now();
  std::erase_if(controllers_, [&](const auto& known) {
    return now - known.second.heard > kAlive;
  });  // those that have left
  const std::pair key{status.role, status.session};
  if (controllers_.size() >= kMostControllers && !controllers_.contains(key)) return;
  controllers_[key] = {.ready_for = status.ready_for,
                       .in_force = status.in_force,
                       .refused = status.refused,
                       .text = status.text,
                       .heard = now};
}

// A user's own controller may know nothing of live tuning; values that concern it cannot be changed then.
std::string TuningServer::WhoIsMissing(const tuning_request_t& request) const {
  if (request.kind != tuning_request_t::SET) return "";
  std::vector<std::string> changes;
  try {
    changes = tuning::ParseChanges(request.changes);
  } catch (const InputError&) {
    return "";  // refused for that
  }
  for (const auto& [section, role] :
       {std::pair{"pressure.", "pressure_ctrl"}, std::pair{"position.", "position_ctrl"},
        std::pair{"reference.", "position_ctrl"}}) {
    const bool concerned = std::any_of(
        changes.begin(), changes.end(),
        [&, section = section](const std::string& change) { return change.starts_with(section); });
    const bool there =
        std::any_of(controllers_.begin(), controllers_.end(),
                    [&, role = std::string(role)](const auto& known) { return known.first.first == role; });
    if (concerned && !there) {
      return fmt::format(
          "{} does not take part in tuning: it has said nothing of its values (a program of your own?)",
          role);
    }
  }
  return "";
}

}  // namespace hydro::plant
