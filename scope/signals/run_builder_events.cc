// What a RunBuilder makes of messages that are not sent at every tick.
#include <algorithm>
#include <hydro/messages.hpp>
#include <sstream>
#include <utility>

#include "base/integers.h"
#include "base/text_file.h"
#include "base/utf8.h"
#include "bus/output_left.h"
#include "process/participant.h"
#include "process/status.h"
#include "runs/recorded/tuning_history.h"
#include "scope/signals/decoded.h"
#include "scope/signals/run_builder.h"

namespace hydro::scope {
namespace {

constexpr int64_t kRepeated = 2000000;  // us within which the same stop or answer counts once
constexpr size_t kMostProcesses = 64;   // processes beyond this are a flood of forged ones and are not kept
constexpr size_t kMostText = 400;
constexpr uint64_t kMostReports = 100000;  // of a loop: a day's reports

std::string Shown(const std::string& text) { return Printable(FirstBytes(text, kMostText)); }

std::string StateName(const process_status_t& status) {
  switch (status.state) {
    case process_status_t::READY:
      return "ready";
    case process_status_t::RUNNING:
      return "running";
    case process_status_t::DONE:
      return "done";
    case process_status_t::FAILED:
      return "failed";
    default:
      return "";
  }
}

std::set<std::string> Words(const std::string& text) {
  std::istringstream in(text.substr(0, kMostText));
  std::set<std::string> words;
  for (std::string word; in >> word;) words.insert(Printable(word));
  return words;
}

}  // namespace

bool RunBuilder::TakeRare(std::string_view channel, const uint8_t* data, int size, int64_t utime) {
  const auto take = [&]<class Message>(auto on_message, Message message) {
    if (channel != channels_.Of<Message>()) return false;
    if (!Decoded(&message, data, size)) {
      ++undecodable_;
    } else if (run_ != nullptr || std::is_same_v<Message, run_description_t>) {
      on_message(message);
    }
    return true;
  };
  return take([&](const fault_t& m) { OnFault(m); }, fault_t{}) ||
         take([&](const active_faults_t& m) { OnActiveFaults(m); }, active_faults_t{}) ||
         take([&](const stop_t& m) { OnStop(m, utime); }, stop_t{}) ||
         take([&](const rearm_t& m) { OnRearm(m, utime); }, rearm_t{}) ||
         take([&](const tuned_settings_t& m) { OnSettings(m); }, tuned_settings_t{}) ||
         take([&](const tuning_answer_t& m) { OnTuningAnswer(m); }, tuning_answer_t{}) ||
         take([&](const process_status_t& m) { OnStatus(m); }, process_status_t{}) ||
         take([&](const loop_statistics_t& m) { OnStatistics(m); }, loop_statistics_t{}) ||
         take([&](const run_description_t& m) { OnDescription(m); }, run_description_t{});
}

void RunBuilder::TakeOfLimb(const bus::Channels& limb, std::string_view channel, const uint8_t* data,
                            int size, int64_t utime) {
  if (run_ == nullptr) return;
  const auto take = [&]<class Message>(auto on_message, Message message) {
    if (channel != limb.Of<Message>()) return false;
    Decoded(&message, data, size) ? on_message(message) : void(++undecodable_);
    return true;
  };
  const auto on_stop = [&](stop_t stop) {
    stop.addressee = 0;  // the limb's session is not that of the joint
    OnStop(stop, utime);
  };
  static_cast<void>(take([&](const fault_t& m) { OnFault(m); }, fault_t{}) ||
                    take([&](const active_faults_t& m) { OnActiveFaults(m); }, active_faults_t{}) ||
                    take(on_stop, stop_t{}) ||
                    take([&](const process_status_t& m) { OnStatus(m); }, process_status_t{}) ||
                    take([&](const loop_statistics_t& m) { OnStatistics(m); }, loop_statistics_t{}));
}

// A plant describes its run before it sends its first state.
void RunBuilder::OnDescription(const run_description_t& description) {
  if (session_ && description.session == session_) {
    run_->Describe(description);
  } else {
    early_description_ = description;
  }
}

void RunBuilder::AddEvent(double t, std::string kind, const std::string& source, const std::string& code,
                          const std::string& text) {
  run_->events.Add({0, t, std::move(kind), Shown(source), Shown(code), Shown(text)});
}

void RunBuilder::OnFault(const fault_t& fault) {
  if (fault_sequence_.size() > 4 * kMostProcesses) fault_sequence_.clear();
  const auto [newest, is_new] = fault_sequence_.try_emplace(fault.session, fault.sequence);
  if (!is_new && fault.sequence <= newest->second) return;
  newest->second = fault.sequence;
  std::set<std::string>& active = active_[Shown(fault.source)];
  if (fault.active != 0) {
    active.insert(Shown(fault.code));
  } else {
    active.erase(Shown(fault.code));
  }
  AddEvent(TimeOf(fault.tick), fault.active != 0 ? "fault" : "fault_end", fault.source, fault.code,
           bus::ReasonText(fault.text));
}

// The list makes up for lost messages: a fault that it names and that is unknown here has begun, and a fault
// that two lists in a row lack has ended.
void RunBuilder::OnActiveFaults(const active_faults_t& message) {
  if (active_.size() > kMostProcesses) return;
  const std::string role = Shown(message.role);
  const std::set<std::string> now = Words(message.codes);
  std::set<std::string>& known = active_[role];
  for (const std::string& code : now) {
    if (known.insert(code).second) AddEvent(time_, "fault", role, code, "its message was lost");
  }
  std::set<std::string>& doubted = doubted_[role];
  std::set<std::string> missing;
  for (const std::string& code : known) {
    if (!now.contains(code)) missing.insert(code);
  }
  for (const std::string& code : missing) {
    if (!doubted.contains(code)) continue;
    known.erase(code);
    AddEvent(time_, "fault_end", role, code, "its message was lost");
  }
  std::erase_if(missing, [&](const auto& code) { return !known.contains(code); });
  doubted = std::move(missing);
  for (auto& [name, report] : run_->processes) {
    if (report.role == role) report.faults = Shown(message.codes);
  }
}

void RunBuilder::OnStop(const stop_t& stop, int64_t utime) {
  if (stop.addressee != 0 && stop.addressee != session_) return;  // addressed to another run
  left_ = true;
  const std::string what = stop.source + ": " + stop.reason;
  const bool repeated = what == last_stop_ && SaturatingDifference(utime, last_stop_utime_) < kRepeated;
  last_stop_ = what;
  last_stop_utime_ = utime;
  if (!repeated) AddEvent(TimeOf(stop.tick), "stop", stop.source, "", bus::ReasonText(stop.reason));
}

// The plant sends this when it decides, with the tick at which the change acts, and again once a second.
void RunBuilder::OnSettings(const tuned_settings_t& settings) {
  const bool certain =
      settings.stage == tuned_settings_t::DECIDED || settings.stage == tuned_settings_t::IN_FORCE;
  if (settings.session != session_ || !certain || (tuned_ && settings.version <= tuned_->version)) return;
  if (settings.version > 0) {
    AddEvent(TimeOf(settings.acts_at), "tuning", settings.source,
             "version " + std::to_string(settings.version),
             runs::DescribeTuning(runs::StepTo(settings, tuned_ ? &*tuned_ : nullptr)));
  }
  tuned_ = settings;
}

void RunBuilder::OnTuningAnswer(const tuning_answer_t& answer) {
  if (answer.session != session_ || answer.accepted != 0 || answer.request == tuning_request_) return;
  tuning_request_ = answer.request;
  AddEvent(TimeOf(answer.tick), "tuning", "plant", "refused", answer.text);
}

void RunBuilder::OnRearm(const rearm_t& rearm, int64_t utime) {
  if (rearm.kind == rearm_t::REQUEST || rearm.session != session_) return;
  const std::string what = std::to_string(rearm.kind) + rearm.text;
  const bool repeated = what == last_rearm_ && SaturatingDifference(utime, last_rearm_utime_) < kRepeated;
  last_rearm_ = what;
  last_rearm_utime_ = utime;
  if (repeated) return;
  AddEvent(TimeOf(rearm.tick), "rearm", rearm.source,
           rearm.kind == rearm_t::ACCEPTED ? "accepted" : "refused", rearm.text);
}

ProcessReport& RunBuilder::Report(const std::string& role, const std::string& host) {
  const std::string key = Shown(role) + " on " + Shown(host);
  if (run_->processes.size() >= kMostProcesses && !run_->processes.contains(key)) return flood_;
  ProcessReport& report = run_->processes[key];
  report.role = Shown(role);
  report.host = Shown(host);
  return report;
}

void RunBuilder::OnStatus(const process_status_t& status) {
  if (status.role == process::kLaunchRole) return;
  ProcessReport& report = Report(status.role, status.host);
  report.state = StateName(status);
  report.text = Shown(status.text);
  if (status.session == session_ && process::HasLeft(status)) left_ = true;
}

void RunBuilder::OnStatistics(const loop_statistics_t& statistics) {
  if (statistics.whole_run != 0) return;  // it is the sum of the reports before it
  ProcessReport& report = Report(statistics.role, statistics.host);
  if (statistics.interval_s > 0)
    report.rate_hz = static_cast<double>(statistics.cycles) / statistics.interval_s;
  report.missed = SaturatingSum(report.missed, statistics.missed_deadlines);
  report.lost = SaturatingSum(report.lost, statistics.lost_messages);
  report.latency_p99_us = statistics.latency_p99_us;
  if (run_->loops.size() >= kMostProcesses && !run_->loops.contains(report.role)) return;
  const auto [place, is_new] = run_->loops.try_emplace(report.role, kLoopColumns, kMostReports);
  if (is_new) ++run_->revision;
  const double values[kLoopColumns] = {statistics.latency_p99_us,
                                       static_cast<double>(statistics.missed_deadlines)};
  place->second.Append(time_, values);
}

}  // namespace hydro::scope
