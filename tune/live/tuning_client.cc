#include "tune/live/tuning_client.h"

#include <hydro/process_status_t.hpp>
#include <hydro/state_t.hpp>
#include <hydro/stop_t.hpp>
#include <utility>

#include "bus/output_left.h"
#include "bus/session.h"
#include "process/status.h"

namespace hydro::tuning {
namespace {

using namespace std::chrono_literals;

constexpr auto kRepeat = 100ms;
constexpr auto kLongestWait = 3s;
constexpr size_t kMostPlants = 16;

}  // namespace

TuningClient::TuningClient(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels,
                           std::string source)
    : bus_(bus),
      clock_(clock),
      channels_(channels),
      session_(bus::IdentityOn(bus, clock).session),
      source_(std::move(source)) {
  bus.Subscribe<state_t>(channels.Of<state_t>(), [this](const state_t& state) {
    if (plants_.size() < kMostPlants) plants_.insert(state.session);  // limits a flood of made-up plants
    tick_ = state.tick;
    plant_ = state.session;
    if (ending_.empty()) return;
    if (ended_plant_ == 0) ended_plant_ = plant_;
    if (ended_plant_ != plant_) ending_.clear();  // the stack has been started again
  });
  bus.Subscribe<run_description_t>(channels.Of<run_description_t>(),
                                   [this](const run_description_t& run) { run_ = run; });
  bus.Subscribe<tuned_settings_t>(channels.Of<tuned_settings_t>(), [this](const tuned_settings_t& settings) {
    if (settings.stage == tuned_settings_t::IN_FORCE) in_force_ = settings;
  });
  bus.Subscribe<tuning_status_t>(channels.Of<tuning_status_t>(), [this](const tuning_status_t& status) {
    controllers_[status.role] = status;
  });
  bus.Subscribe<tuning_answer_t>(channels.Of<tuning_answer_t>(), [this](const tuning_answer_t& answer) {
    if (answer.addressee != session_ || !asked_ || answer.request != asked_->request) return;
    answer_ = answer;
    asked_.reset();
  });
  ListenForTheEnd();
}

void TuningClient::ListenForTheEnd() {
  bus_.Subscribe<stop_t>(channels_.Of<stop_t>(),
                         [this](const stop_t& stop) { OnEnd(stop.addressee, stop.source, stop.reason); });
  bus_.Subscribe<process_status_t>(channels_.Of<process_status_t>(), [this](const process_status_t& status) {
    if (process::IsPlant(status.role) && process::HasLeft(status))
      OnEnd(status.session, status.role, status.text);
  });
}

// A stop for a plant, or for all, ends the run; one for another process does not.
void TuningClient::OnEnd(int64_t plant, const std::string& who, const std::string& reason) {
  if (plant != 0 && !plants_.contains(plant) && !plants_.empty()) return;
  if (!ending_.empty()) return;
  ended_plant_ = plant != 0 ? plant : plant_;
  ending_ = bus::ReasonText(who, "an unnamed process") + ": " + bus::ReasonText(reason);
}

void TuningClient::Ask(int8_t kind, const std::string& changes) {
  tuning_request_t request;
  request.session = session_;
  request.request = ++requests_;
  request.addressee = in_force_->session;
  request.kind = kind;
  request.source = source_;
  request.changes = changes;
  asked_ = std::move(request);
  answer_.reset();
  first_sent_ = clock_.Now();
  Send();
}

void TuningClient::Send() {
  asked_->utime = clock_.Utime();
  asked_->tick = tick_;
  next_repeat_ = clock_.Now() + kRepeat;
  bus_.Publish(channels_.Of<tuning_request_t>(), *asked_);
}

void TuningClient::Poll() {
  if (!asked_) return;
  const auto now = clock_.Now();
  if (now - first_sent_ > kLongestWait || !ending_.empty()) {
    answer_.emplace();
    answer_->request = asked_->request;
    answer_->accepted = false;
    answer_->acts_at = -1;
    answer_->text = !ending_.empty() ? "the stack stops (" + ending_ + ") before it has answered"
                                     : "the plant or driver does not answer: it may not take part in tuning, "
                                       "another request keeps it busy, "
                                       "or it refuses what comes without its key (bus.key_file)";
    asked_.reset();
  } else if (now >= next_repeat_) {
    Send();
  }
}

std::optional<tuning_answer_t> TuningClient::TakeAnswer() { return std::exchange(answer_, std::nullopt); }

bool TuningClient::ActBy(int64_t version) const {
  for (const auto& [role, status] : controllers_) {
    if (in_force_ && status.plant == in_force_->session && status.in_force != version) return false;
  }
  return in_force_ && in_force_->version == version;
}

}  // namespace hydro::tuning
