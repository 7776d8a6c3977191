#include "plant/tuning_server.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>

#include "base/input_error.h"
#include "base/integers.h"
#include "process/status.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

constexpr auto kReportPeriod = 1s;
constexpr auto kAnswerTime = 500ms;        // for each controller to say whether it can act by a proposal
constexpr auto kWordsRepeatPeriod = 20ms;  // for proposals and decisions, in case a message is lost
constexpr double kOldRequest_s = 5;    // a request that names a tick older than this comes from a recording
constexpr size_t kMostSessions = 64;   // whose last answer is kept in case they ask again
constexpr size_t kMostText = 1 << 16;  // bytes of a request

}  // namespace

TuningServer::TuningServer(process::Participant& participant, const settings::StackConfig& config,
                           bool simulated_rig, Hooks hooks)
    : participant_(participant),
      configured_(std::make_shared<settings::StackConfig>(config)),
      simulated_rig_(simulated_rig),
      hooks_(std::move(hooks)),
      // Where many processes share one thread, none of them may depend on how long another thread takes,
      // either.
      preparation_(!participant.clock().simulated() && participant.bus().process() == nullptr),
      values_(tuning::ValuesOf(config)),
      in_force_{configured_, {}} {
  in_force_.message.version = in_force_.message.acts_at = in_force_.message.reference_from = 0;
  tuning::Write(values_, &in_force_.message);
  bus::Bus& bus = participant_.bus();
  const bus::Channels& channels = participant_.channels();
  bus.Subscribe<tuning_request_t>(channels.Of<tuning_request_t>(),
                                  [this](const tuning_request_t& request) { OnRequest(request); });
  bus.Subscribe<tuning_status_t>(channels.Of<tuning_status_t>(),
                                 [this](const tuning_status_t& status) { OnStatus(status); });
  bus.Subscribe<process_status_t>(channels.Of<process_status_t>(), [this](const process_status_t& status) {
    // A controller that has just started needs to know the values in force.
    const bool controller = status.role == "pressure_ctrl" || status.role == "position_ctrl";
    if (controller && !process::HasLeft(status) && participant_.tick() >= 0) next_report_ = {};
  });
}

void TuningServer::Follow(std::vector<tuned_settings_t> decided) {
  followed_ = std::move(decided);
  std::reverse(followed_.begin(), followed_.end());
}

void TuningServer::OnRequest(const tuning_request_t& request) {
  if (request.addressee != participant_.session() || participant_.Refuses(request.session)) return;
  if (participant_.state() != process_status_t::RUNNING) return;
  if (pending_ && pending_->request.session == request.session &&
      pending_->request.request == request.request)
    return;
  const auto answered = answers_.find(request.session);
  if (answered != answers_.end() && request.request <= answered->second.request) {
    if (request.request < answered->second.request) return;
    // The program asks again: the answer may have been lost.
    answered->second.utime = participant_.clock().Utime();
    participant_.bus().Publish(participant_.channels().Of<tuning_answer_t>(), answered->second);
    return;
  }
  if (pending_ || preparation_.busy()) return;  // one change at a time: the other program asks again
  // A program that asks before the loops have said that they take part asks again, too.
  if (IsYoung() && !WhoIsMissing(request).empty()) return;
  Begin(request);
}

void TuningServer::Begin(const tuning_request_t& request) {
  pending_ = Pending{};
  pending_->request = request;
  if (const std::string why = WhyNot(request); !why.empty()) return Refuse(why);
  const bool undo = request.kind == tuning_request_t::UNDO;
  const tuning::Situation situation{.held = hooks_.held(), .simulated = simulated_rig_, .undo = undo};
  if (undo) {
    preparation_.Begin(
        [configured = configured_, in_force = in_force_.config, next = before_.back().config, situation] {
          return tuning::PrepareChange(*configured, *in_force, next, situation);
        });
    return;
  }
  try {
    const std::vector<std::string> changes = tuning::ParseChanges(request.changes);
    if (const std::string missing = WhoIsMissing(request); !missing.empty()) return Refuse(missing);
    preparation_.Begin([configured = configured_, in_force = in_force_.config, changes, situation] {
      return tuning::PrepareChange(*configured, *in_force, changes, situation);
    });
  } catch (const InputError& error) {
    Refuse(error.what());
  }
}

std::string TuningServer::WhyNot(const tuning_request_t& request) const {
  const double rate = configured_->plant.rate_hz * configured_->time.speed;
  const bool realtime = configured_->time.mode == settings::TimeMode::kRealtime;
  const auto age = static_cast<double>(SaturatingDifference(participant_.tick(), request.tick));
  if (realtime && (age < 0 || age > kOldRequest_s * rate)) {
    return fmt::format("the request names tick {} at tick {}; is a recording being played?", request.tick,
                       participant_.tick());
  }
  if (request.changes.size() > kMostText) return "the request is longer than 64 KiB";
  if (request.kind == tuning_request_t::SET) return "";
  if (request.kind != tuning_request_t::UNDO) return "the request is of an unknown kind";
  return before_.empty() ? "nothing to undo: the values are those of the configuration" : "";
}

void TuningServer::Propose(tuning::PreparedChange change) {
  change.message.version = ++newest_version_;
  change.message.acts_at = -1;
  change.message.source = pending_->request.source;
  // A reference that stays, or comes back, goes on from where it began; a new one begins when it takes
  // effect.
  change.message.reference_from = pending_->request.kind == tuning_request_t::UNDO
                                      ? before_.back().message.reference_from
                                  : change.new_reference ? -1
                                                         : in_force_.message.reference_from;
  pending_->version = Version{std::move(change.config), std::move(change.message)};
  pending_->text = std::move(change.text);
  pending_->deadline = participant_.clock().Now() + kAnswerTime;
  pending_->next_repeat = participant_.clock().Now() + kWordsRepeatPeriod;
  Publish(&pending_->version->message, tuned_settings_t::PROPOSED);
}

void TuningServer::Refuse(const std::string& why) {
  Answer(false, in_force_.message.version, -1, why);
  pending_.reset();
}

void TuningServer::Accept(const tuned_settings_t& settings, const std::string& text) {
  Answer(true, settings.version, settings.acts_at, text);
}

void TuningServer::Answer(bool accepted, int64_t version, int64_t acts_at, const std::string& text) {
  const tuning_request_t& request = pending_->request;
  tuning_answer_t answer;
  answer.utime = participant_.clock().Utime();
  answer.tick = participant_.tick();
  answer.session = participant_.session();
  answer.request = request.request;
  answer.addressee = request.session;
  answer.accepted = accepted;
  answer.version = version;
  answer.acts_at = acts_at;
  answer.text = text;
  participant_.bus().Publish(participant_.channels().Of<tuning_answer_t>(), answer);
  if (!answers_.contains(request.session)) {
    if (asked_.size() == kMostSessions) {
      answers_.erase(asked_.front());
      asked_.erase(asked_.begin());
    }
    asked_.push_back(request.session);
  }
  answers_[request.session] = std::move(answer);
}

void TuningServer::PollDue(bus::Clock::TimePoint now) {
  if (preparation_.busy()) {
    if (auto change = preparation_.Take()) {
      if (change->config == nullptr) {
        Refuse(change->text);
      } else if (change->nothing_differs && pending_->request.kind == tuning_request_t::SET) {
        Accept(in_force_.message,
               change->text);  // makes no version of its own, which an undo would have to take back
        pending_.reset();
      } else {
        Propose(std::move(*change));
      }
    }
  }
  if (pending_ && pending_->version) {
    if (now >= pending_->next_repeat) {
      pending_->next_repeat = now + kWordsRepeatPeriod;
      tuned_settings_t& message = pending_->version->message;
      Publish(&message, message.acts_at < 0 ? tuned_settings_t::PROPOSED : tuned_settings_t::DECIDED);
    }
    if (pending_->version->message.acts_at < 0) AwaitControllers();
  }
  if (participant_.state() == process_status_t::RUNNING && now >= next_report_) {
    next_report_ = now + kReportPeriod;
    Publish(&in_force_.message, tuned_settings_t::IN_FORCE);
  }
}

// Makes no copy: this is published once a second, and the loop allocates no memory.
void TuningServer::Publish(tuned_settings_t* settings, int8_t stage) {
  settings->utime = participant_.clock().Utime();
  settings->tick = participant_.tick();
  settings->session = participant_.session();
  settings->stage = stage;
  participant_.bus().Publish(participant_.channels().Of<tuned_settings_t>(), *settings);
}

}  // namespace hydro::plant
