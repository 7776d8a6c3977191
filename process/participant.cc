#include "process/participant.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <hydro/active_faults_t.hpp>
#include <hydro/loop_statistics_t.hpp>

#include "bus/session.h"
#include "process/status.h"

namespace hydro::process {
namespace {

constexpr auto kAnnouncementPeriod = std::chrono::milliseconds(100);
constexpr auto kConfigurationPeriod = std::chrono::milliseconds(500);
constexpr auto kAnswerPeriod =
    std::chrono::milliseconds(50);  // the shortest time between answers to new processes: they may be a flood
// A process that has missed the configuration, or was told wrongly, is told again.
constexpr auto kConfigurationAgain = std::chrono::seconds(2);
constexpr char kOtherConfiguration[] = "other_configuration";
constexpr auto kActiveFaultsPeriod = std::chrono::seconds(1);
constexpr int kFarewells = 3;  // number of empty lists sent after the last fault has ended
// A stack has five processes; more would come from a flood of made-up ones.
constexpr size_t kMostNames = 256;

// " (knee)" for the channels of the joint knee: one process may serve several joints.
std::string Where(const bus::Channels& channels) {
  const std::string suffix = channels.suffix();
  return suffix.empty() ? "" : " (" + suffix.substr(suffix.front() == '_' ? 1 : 0) + ")";
}

}  // namespace

Participant::Participant(bus::Bus& bus, bus::Clock& clock, const bus::Channels& channels,
                         const std::string& role, const std::string& agreed)
    : bus_(bus),
      clock_(clock),
      simulated_(clock.simulated()),
      channels_(channels),
      role_(role),
      identity_(bus::IdentityOn(bus, clock)),
      agreement_(agreed),
      undecodable_("undecodable_message"),
      unsent_("unsent_message"),
      statistics_(role, identity_.host, session(), clock.Now()) {
  if (IsPlant(role)) run_ = session();
  bus_.Subscribe<stop_t>(channels_.Of<stop_t>(), [this](const stop_t& stop) {
    const bool meant = stop.addressee == 0 || stop.addressee == session() || stop.addressee == run_;
    if (meant && !stop_) stop_ = stop;
    if (!meant && run_ == 0)
      early_stop_ = stop;  // belongs to a run that this process has just missed, or to another stack
  });
  bus_.Subscribe<process_status_t>(channels_.Of<process_status_t>(),
                                   [this](const process_status_t& status) { OnStatus(status); });
  bus_.Subscribe<configuration_t>(channels_.Of<configuration_t>(),
                                  [this](const configuration_t& announced) { OnConfiguration(announced); });
}

void Participant::OnStatus(const process_status_t& status) {
  if (names_.size() < kMostNames && !names_.contains(status.session)) {
    names_[status.session] = ProcessName(status);
  }
  if (status.session == session()) return;
  // The plant of that run announces that it has left, so it was the run for which this process had waited.
  if (run_ == 0 && !stop_ && early_stop_ && IsPlant(status.role) &&
      status.session == early_stop_->addressee) {
    stop_ = early_stop_;
  }
  if (IsThere(status)) {
    if (IsPlant(status.role) && run_ == 0) run_ = status.session;
    const bool asks =
        status.state == process_status_t::READY && (IsPlant(status.role) || status.role == kLaunchRole);
    // Each new process is told our configuration at once: a plant starts only when it knows the
    // configurations.
    if (answered_.size() >= kMostNames) answered_.clear();  // sending it once more does no harm
    const bool is_new = answered_.insert(status.session).second;
    if (is_new) configuration_asked_ = true;
    PollSoon();
    AnswerWithConfiguration();
    if (asks && state_ == process_status_t::RUNNING) Announce(state_, status_text_);
  } else if (Refuses(status.session)) {
    agreement_.Forget(status.session);
    if (!agreement_.any()) Clear(kOtherConfiguration);
  }
}

// Zero volts need no help here: the commands of a refused sender become stale, like those of a dead one.
void Participant::OnConfiguration(const configuration_t& announced) {
  if (announced.session == session() || !agreement_.Observe(announced)) return;
  const std::string who = ProcessName(announced.role, announced.host, announced.pid);
  const std::string text =
      fmt::format("{} has another configuration: {}", who, agreement_.Differences(announced.session));
  // The plant decides: it holds the rig, and its configuration is in the log.
  const bool our_plant = IsPlant(announced.role) && (run_ == 0 || announced.session == run_);
  if (our_plant && !IsPlant(role_)) {
    LeaveAlone(text);
    return;
  }
  Raise(kOtherConfiguration, text, NAN, NAN, false);
  if (on_refusal_) on_refusal_(announced.session, text);
}

// Ends this process and no other.
void Participant::LeaveAlone(const std::string& reason) {
  if (stop_) return;
  PublishConfiguration({});  // so that the plant can state the same difference
  Stop(session(), role_, reason, 1);
}

void Participant::AnswerWithConfiguration() {
  const bool there = state_ == process_status_t::READY || state_ == process_status_t::RUNNING;
  if (configuration_asked_ && there) configuration_asked_ = !PublishConfiguration(kAnswerPeriod);
}

// Publishes the configuration; returns false if it was already sent within `period`.
bool Participant::PublishConfiguration(bus::Clock::Duration period) {
  if (agreement_.own().empty()) return true;
  const auto now = clock_.Now();
  if (configuration_sent_ && now - *configuration_sent_ < period) return false;
  configuration_sent_ = now;
  if (announced_.text.empty()) {  // once: loops take no memory
    announced_.session = session();
    announced_.role = role_;
    announced_.host = identity_.host;
    announced_.pid = identity_.id;
    announced_.text = agreement_.own();
  }
  announced_.utime = clock_.Utime();
  bus_.Publish(channels_.Of<configuration_t>(), announced_);
  return true;
}

void Participant::Announce(int8_t state, const std::string& text) {
  state_ = state;
  status_text_ = text;
  PollSoon();
  // The configuration goes out before the status, so that no process counts on one whose configuration it has
  // not seen.
  if (state == process_status_t::READY || state == process_status_t::RUNNING) {
    PublishConfiguration(kConfigurationPeriod);
  }
  next_announcement_ = clock_.Now() + kAnnouncementPeriod;
  process_status_t status;
  status.utime = clock_.Utime();
  status.session = session();
  status.role = role_;
  status.host = identity_.host;
  status.version = HYDRO_VERSION;
  status.pid = identity_.id;
  status.state = state;
  status.text = text;
  bus_.Publish(channels_.Of<process_status_t>(), status);
}

void Participant::PollDue(bus::Clock::TimePoint now) {
  troubles_ = Troubles();
  if (state_ == process_status_t::READY && now >= next_announcement_) Announce(state_, status_text_);
  if (loop_statistics_t* report = statistics_.Poll(now)) {
    report->utime = clock_.Utime();
    bus_.Publish(channels_.Of<loop_statistics_t>(), *report);
  }
  if (!simulated_) Publish(statistics_.PollHistogram(now));
  unsent_.Update(
      bus_.unsent(), now,
      [](int64_t count) {
        return std::to_string(count) + " messages could not be sent: the network is down";
      },
      *this);
  undecodable_.Update(
      bus_.undecodable(), now,
      [this](int64_t count) {
        return std::to_string(count) + " messages are not of this version's types (the last on " +
               bus_.undecodable_channel() + "); they are ignored";
      },
      *this);
  if (state_ == process_status_t::RUNNING && !simulated_) PublishConfiguration(kConfigurationAgain);
  AnswerWithConfiguration();
  if (active_faults_left_ > 0 && now >= next_active_faults_) PublishActiveFaults();
  WatchRefusals(now);
  if (now >= lines_.due()) SayLeftOut(false);
  next_poll_ = NextPoll();
}

// The time at which PollDue() next has work, as things stand.
bus::Clock::TimePoint Participant::NextPoll() const {
  constexpr auto kAtOnce = bus::Clock::TimePoint::min();
  if (configuration_asked_ || unsent_.active() || undecodable_.active() || refusals_.active()) return kAtOnce;
  auto next = std::min(statistics_.report_due(), lines_.due());
  if (!simulated_) next = std::min(next, statistics_.histogram_due());
  if (state_ == process_status_t::READY) next = std::min(next, next_announcement_);
  if (state_ == process_status_t::RUNNING && !simulated_ && !agreement_.own().empty()) {
    next = std::min(next, configuration_sent_ ? *configuration_sent_ + kConfigurationAgain : kAtOnce);
  }
  return active_faults_left_ > 0 ? std::min(next, next_active_faults_) : next;
}

void Participant::WatchRefusals(bus::Clock::TimePoint now) {
  const auto news = refusals_.Observe(bus_.refused(), now);
  if (news == RefusalWatch::News::kNone) return;
  const auto count = static_cast<double>(refusals_.count());
  if (news == RefusalWatch::News::kBegins) {
    Raise(RefusalWatch::kCode, refusals_.Text(), count, 0, false);
    return;
  }
  Clear(RefusalWatch::kCode, refusals_.Text(), count);
}

bool Participant::Raise(const std::string& code, const std::string& text, double value, double limit,
                        bool latched) {
  if (active_.contains(code)) return false;
  fault_t fault;
  fault.source = role_;
  fault.code = code;
  fault.text = text;
  fault.value = value;
  fault.limit = limit;
  fault.latched = latched;
  fault.active = true;
  active_[code] = fault;
  latched_ += latched ? 1 : 0;
  PublishFault(fault);
  if (ShowLine(fault)) spdlog::error("fault {}{}: {}", code, Where(channels_), text);
  return true;
}

// A latched fault ends when a person re-arms, or not at all: each one has its lines.
bool Participant::ShowLine(const fault_t& fault) {
  if (simulated_) return false;
  return fault.latched || lines_.Show(fault.code, clock_.Now());
}

void Participant::SayLeftOut(bool at_end) {
  for (const FaultLines::LeftOut& left_out : lines_.TakeDue(clock_.Now(), at_end)) {
    const auto found = active_.find(left_out.code);
    spdlog::error("fault {}{} comes and goes; lines about it that were not shown: {}; now {}", left_out.code,
                  Where(channels_), left_out.lines,
                  found == active_.end() ? "it has gone" : "it is there: " + found->second.text);
  }
}

void Participant::Clear(const std::string& code) {
  const auto found = active_.find(code);
  if (found != active_.end() && !found->second.latched) End(code);
}

void Participant::Clear(const std::string& code, const std::string& text, double value) {
  const auto found = active_.find(code);
  if (found == active_.end()) return;
  const bool says_more = found->second.text != text;
  found->second.text = text;
  found->second.value = value;
  if (!found->second.latched) End(code, says_more);
}

void Participant::Release(const std::string& code) {
  if (active_.contains(code)) End(code);
}

void Participant::End(const std::string& code, bool says_more) {
  const auto found = active_.find(code);
  fault_t fault = found->second;
  active_.erase(found);
  latched_ -= fault.latched ? 1 : 0;
  fault.active = false;
  PublishFault(fault);
  if (!ShowLine(fault)) return;
  if (says_more) spdlog::error("{}", fault.text);
  spdlog::info("fault {}{} has gone", code, Where(channels_));
}

std::string Participant::NameOf(std::optional<int64_t> session) const {
  if (!session) return "nobody";
  const auto found = names_.find(*session);
  if (found != names_.end()) return found->second;
  return "an unannounced process (session " + std::to_string(*session) + ")";
}

void Participant::Publish(loop_histogram_t* histogram) {
  if (histogram == nullptr) return;
  histogram->utime = clock_.Utime();
  bus_.Publish(channels_.Of<loop_histogram_t>(), *histogram);
}

void Participant::PublishFault(const fault_t& fault) {
  fault_t message = fault;
  message.utime = clock_.Utime();
  message.tick = tick_;
  message.session = session();
  message.sequence = fault_sequence_++;
  bus_.Publish(channels_.Of<fault_t>(), message);
  PublishActiveFaults();
}

void Participant::PublishActiveFaults() {
  active_faults_left_ = active_.empty() ? std::min(active_faults_left_, kFarewells + 1) - 1 : kFarewells + 1;
  next_active_faults_ = clock_.Now() + kActiveFaultsPeriod;
  PollSoon();
  active_faults_t message;
  message.utime = clock_.Utime();
  message.session = session();
  message.role = role_;
  for (const auto& [code, fault] : active_) message.codes += (message.codes.empty() ? "" : " ") + code;
  bus_.Publish(channels_.Of<active_faults_t>(), message);
}

void Participant::RequestStop(const std::string& reason, int exit_code, const std::string& source) {
  if (stop_) return;
  Stop(run_ != 0 ? run_ : session(), source.empty() ? role_ : source, reason, exit_code);
  bus_.Publish(channels_.Of<stop_t>(), *stop_);
}

void Participant::Stop(int64_t addressee, const std::string& source, const std::string& reason,
                       int exit_code) {
  stop_t stop;
  stop.utime = clock_.Utime();
  stop.tick = tick_;
  stop.session = session();
  stop.addressee = addressee;
  stop.source = source;
  stop.reason = reason;
  stop.exit_code = exit_code;
  stop_ = stop;
  if (exit_code != 0 && !simulated_ && !SaidAsFault(reason)) spdlog::error("{}", reason);
}

bool Participant::SaidAsFault(const std::string& reason) const {
  return std::any_of(active_.begin(), active_.end(), [&](const auto& fault) {
    return reason.ends_with(fault.second.text) && !lines_.hides(fault.first);
  });
}

int Participant::Leave(const std::string& failure) {
  if (!simulated_) {
    SayLeftOut(true);
    loop_statistics_t total = statistics_.Total(clock_.Now());
    total.utime = clock_.Utime();
    bus_.Publish(channels_.Of<loop_statistics_t>(), total);
    for (int i = 0; i < timing::kLoopQuantities; ++i) {
      Publish(statistics_.TotalHistogram(static_cast<timing::LoopQuantity>(i), clock_.Now()));
    }
  }
  const bool run_failed = stop_ && stop_->exit_code != 0;
  const bool failed = run_failed || !failure.empty();
  const std::string text = !failure.empty() ? failure : run_failed ? stop_->reason : "";
  Announce(failed ? process_status_t::FAILED : process_status_t::DONE, text);
  return failed ? 1 : 0;
}

}  // namespace hydro::process
