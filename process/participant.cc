#include "process/participant.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <hydro/loop_statistics_t.hpp>

#include "bus/session.h"

namespace hydro {
namespace {

constexpr auto kAnnouncementPeriod = std::chrono::milliseconds(100);

std::string HostName() {
  char name[256] = {};
  return gethostname(name, sizeof name - 1) == 0 ? name : "unknown";
}

}  // namespace

Participant::Participant(Bus& bus, Clock& clock, const Channels& channels, const std::string& role)
    : bus_(bus),
      clock_(clock),
      channels_(channels),
      role_(role),
      host_(HostName()),
      session_(SessionOn(clock)),
      statistics_(role, host_, session_, clock.Now()) {
  bus_.Subscribe<stop_t>(channels_.stop, [this](const stop_t& stop) {
    if (!stop_) stop_ = stop;
  });
  bus_.Subscribe<process_status_t>(channels_.process_status, [this](const process_status_t& status) {
    const bool calls_the_roll = status.state == process_status_t::READY && status.session != session_ &&
                                (status.role == "plant" || status.role == "driver");
    if (calls_the_roll && state_ == process_status_t::RUNNING) Announce(state_, status_text_);
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
  bus_.Publish(channels_.process_status, status);
}

void Participant::Poll() {
  const auto now = clock_.Now();
  if (state_ == process_status_t::READY && now >= next_announcement_) Announce(state_, status_text_);
  if (auto report = statistics_.Poll(now)) {
    report->utime = clock_.Utime();
    bus_.Publish(channels_.loop_statistics, *report);
  }
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
    fault->second.text = refusals_.Text();  // all of them, now that there are no more
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
  latched_ = latched_ || latched;
  PublishFault(fault);
  if (!clock_.simulated()) spdlog::error("fault {}: {}", code, text);
  return true;
}

void Participant::Clear(const std::string& code) {
  const auto found = active_.find(code);
  if (found == active_.end() || found->second.latched) return;
  fault_t fault = found->second;
  active_.erase(found);
  fault.active = false;
  PublishFault(fault);
  if (!clock_.simulated()) spdlog::info("fault {} has gone", code);
}

void Participant::PublishFault(const fault_t& fault) {
  fault_t message = fault;
  message.utime = clock_.Utime();
  message.tick = tick_;
  message.session = session_;
  message.sequence = fault_sequence_++;
  bus_.Publish(channels_.fault, message);
}

void Participant::RequestStop(const std::string& reason, int exit_code) {
  if (stop_) return;
  stop_t stop;
  stop.utime = clock_.Utime();
  stop.tick = tick_;
  stop.session = session_;
  stop.source = role_;
  stop.reason = reason;
  stop.exit_code = exit_code;
  stop_ = stop;
  bus_.Publish(channels_.stop, stop);
  if (exit_code != 0 && !clock_.simulated()) spdlog::error("{}", reason);
}

int Participant::Leave() {
  if (!clock_.simulated()) {
    loop_statistics_t total = statistics_.Total(clock_.Now());
    total.utime = clock_.Utime();
    bus_.Publish(channels_.loop_statistics, total);
  }
  const bool failed = stop_ && stop_->exit_code != 0;
  Announce(failed ? process_status_t::FAILED : process_status_t::DONE, failed ? stop_->reason : "");
  return failed ? 1 : 0;
}

}  // namespace hydro
