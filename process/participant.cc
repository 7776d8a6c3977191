#include "process/participant.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <hydro/loop_statistics_t.hpp>

#include "base/host_name.h"
#include "bus/session.h"

namespace hydro::process {
namespace {

constexpr auto kAnnouncementPeriod = std::chrono::milliseconds(100);
constexpr size_t kMostNames = 256;  // a stack has five processes; a flood of made-up ones is not kept

}  // namespace

Participant::Participant(bus::Bus& bus, bus::Clock& clock, const bus::Channels& channels,
                         const std::string& role)
    : bus_(bus),
      clock_(clock),
      channels_(channels),
      role_(role),
      host_(HostName()),
      session_(bus::SessionOn(clock)),
      undecodable_("undecodable_message"),
      unsent_("unsent_message"),
      statistics_(role, host_, session_, clock.Now()) {
  if (role == "plant" || role == "driver") run_ = session_;
  bus_.Subscribe<stop_t>(channels_.Of<stop_t>(), [this](const stop_t& stop) {
    const bool meant = stop.addressee == 0 || stop.addressee == session_ || stop.addressee == run_;
    if (meant && !stop_) stop_ = stop;
  });
  bus_.Subscribe<process_status_t>(channels_.Of<process_status_t>(), [this](const process_status_t& status) {
    if (names_.size() < kMostNames && !names_.contains(status.session)) {
      names_[status.session] =
          status.role + " on " + status.host + " (process " + std::to_string(status.pid) + ")";
    }
    if (status.session == session_) return;
    const bool plant = status.role == "plant" || status.role == "driver";
    const bool there = status.state == process_status_t::READY || status.state == process_status_t::RUNNING;
    if (plant && there && run_ == 0) run_ = status.session;
    const bool asks = status.state == process_status_t::READY && (plant || status.role == kLaunchRole);
    if (asks && state_ == process_status_t::RUNNING) Announce(state_, status_text_);
  });
}

void Participant::Announce(int8_t state, const std::string& text) {
  state_ = state;
  status_text_ = text;
  next_announcement_ = clock_.Now() + kAnnouncementPeriod;
  process_status_t status;
  status.utime = clock_.Utime();
  status.session = session_;
  status.role = role_;
  status.host = host_;
  status.version = HYDRO_VERSION;
  status.pid = getpid();
  status.state = state;
  status.text = text;
  bus_.Publish(channels_.Of<process_status_t>(), status);
}

void Participant::Poll() {
  const auto now = clock_.Now();
  if (state_ == process_status_t::READY && now >= next_announcement_) Announce(state_, status_text_);
  if (loop_statistics_t* report = statistics_.Poll(now)) {
    report->utime = clock_.Utime();
    bus_.Publish(channels_.Of<loop_statistics_t>(), *report);
  }
  if (!clock_.simulated()) Publish(statistics_.PollHistogram(now));
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
  WatchRefusals();
}

void Participant::WatchRefusals() {
  const auto news = refusals_.Observe(bus_.refused(), clock_.Now());
  if (news == RefusalWatch::News::kNone) return;
  const auto count = static_cast<double>(refusals_.count());
  if (news == RefusalWatch::News::kBegins) {
    Raise(RefusalWatch::kCode, refusals_.Text(), count, 0, false);
    return;
  }
  if (const auto fault = active_.find(RefusalWatch::kCode); fault != active_.end()) {
    fault->second.text = refusals_.Text();  // with the final count
    fault->second.value = count;
    if (!clock_.simulated()) spdlog::error("{}", fault->second.text);
  }
  Clear(RefusalWatch::kCode);
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
  if (!clock_.simulated()) spdlog::error("fault {}: {}", code, text);
  return true;
}

void Participant::Clear(const std::string& code) {
  const auto found = active_.find(code);
  if (found != active_.end() && !found->second.latched) End(code);
}

void Participant::Release(const std::string& code) {
  if (active_.contains(code)) End(code);
}

void Participant::End(const std::string& code) {
  const auto found = active_.find(code);
  fault_t fault = found->second;
  active_.erase(found);
  latched_ -= fault.latched ? 1 : 0;
  fault.active = false;
  PublishFault(fault);
  if (!clock_.simulated()) spdlog::info("fault {} has gone", code);
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
  message.session = session_;
  message.sequence = fault_sequence_++;
  bus_.Publish(channels_.Of<fault_t>(), message);
}

void Participant::RequestStop(const std::string& reason, int exit_code) {
  if (stop_) return;
  stop_t stop;
  stop.utime = clock_.Utime();
  stop.tick = tick_;
  stop.session = session_;
  stop.addressee = run_ != 0 ? run_ : session_;
  stop.source = role_;
  stop.reason = reason;
  stop.exit_code = exit_code;
  stop_ = stop;
  bus_.Publish(channels_.Of<stop_t>(), stop);
  if (exit_code != 0 && !clock_.simulated()) spdlog::error("{}", reason);
}

int Participant::Leave(const std::string& failure) {
  if (!clock_.simulated()) {
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
