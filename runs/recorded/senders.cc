#include "runs/recorded/senders.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <type_traits>

#include "base/integers.h"
#include "bus/channels.h"
#include "runs/recorded/message_order.h"

namespace hydro::runs {
namespace {

std::set<int64_t> SessionsOf(const std::vector<state_t>& states) {
  std::set<int64_t> sessions;
  for (const state_t& state : states) sessions.insert(state.session);
  return sessions;
}

// Finds a tick with two different states, rather than one state sent twice.
std::optional<int64_t> ContradictedTick(const std::vector<state_t>& states) {
  const std::vector<const state_t*> ordered = InOrder(states);
  for (size_t k = 1; k < ordered.size(); ++k) {
    if (ordered[k]->tick == ordered[k - 1]->tick) return ordered[k]->tick;
  }
  return std::nullopt;
}

// Splits the states of one session into runs, where their numbers begin again.
std::vector<std::vector<state_t>> PartsOf(const std::vector<state_t>& states) {
  std::vector<std::vector<state_t>> parts;
  for (const state_t& state : states) {
    if (parts.empty() || state.sequence <= parts.back().front().sequence) parts.emplace_back();
    parts.back().push_back(state);
  }
  return parts;
}

// The time at which a run was recorded, from its states.
struct Span {
  int64_t first = 0, last = 0;
  int64_t DistanceOf(int64_t utime) const {
    return utime < first ? SaturatingDifference(first, utime)
                         : (utime > last ? SaturatingDifference(utime, last) : 0);
  }
};

Span SpanOf(const std::vector<state_t>& states) {
  const auto [first, last] = std::minmax_element(
      states.begin(), states.end(), [](const state_t& a, const state_t& b) { return a.utime < b.utime; });
  return {first->utime, last->utime};
}

template <class Message>
void Distribute(const std::vector<Message>& messages, const std::vector<Span>& spans,
                std::vector<SenderMessages>* runs) {
  for (const Message& message : messages) {
    const auto own = std::find_if(runs->begin(), runs->end(),
                                  [&](const SenderMessages& run) { return run.session == message.session; });
    auto run = own;
    if (own == runs->end()) {
      const auto nearest = std::min_element(spans.begin(), spans.end(), [&](const Span& a, const Span& b) {
        return a.DistanceOf(message.utime) < b.DistanceOf(message.utime);
      });
      run = runs->begin() + (nearest - spans.begin());
    }
    run->messages.template Of<Message>().push_back(message);
  }
}

}  // namespace

bool HoldsSeveralRuns(const RunMessages& messages) {
  const std::vector<state_t>& states = messages.Of<state_t>();
  return SessionsOf(states).size() > 1 || ContradictedTick(states).has_value();
}

std::vector<SenderMessages> RunsIn(const RunMessages& messages) {
  const std::vector<state_t>& states = messages.Of<state_t>();
  if (!HoldsSeveralRuns(messages)) return {{states.empty() ? 0 : states.front().session, messages}};
  std::vector<std::vector<state_t>> by_run;
  std::map<int64_t, size_t> places;
  for (const state_t& state : states) {
    const auto [place, is_new] = places.try_emplace(state.session, by_run.size());
    if (is_new) by_run.emplace_back();
    by_run[place->second].push_back(state);
  }
  if (by_run.size() > kMostRuns) return {};
  std::vector<SenderMessages> runs;
  std::vector<Span> spans;
  bool alone = true;  // each session is one run
  for (const std::vector<state_t>& of_session : by_run) {
    std::vector<std::vector<state_t>> parts{of_session};
    if (ContradictedTick(of_session)) parts = PartsOf(of_session);
    alone = alone && parts.size() == 1;
    for (std::vector<state_t>& part : parts) {
      if (ContradictedTick(part)) return {};
      if (runs.size() == kMostRuns) return {};
      spans.push_back(SpanOf(part));
      runs.push_back({part.front().session, {}});
      runs.back().messages.Of<state_t>() = std::move(part);
    }
  }
  // Where two runs have the same session, nothing tells to which of them the other messages belong.
  if (!alone) return runs;
  bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>&) {
    if constexpr (!std::is_same_v<Message, state_t> && requires(const Message& one) {
                    one.session;
                    one.utime;
                  }) {
      Distribute(messages.Of<Message>(), spans, &runs);
    }
  });
  return runs;
}

void RequireOneRun(const RunLog& log) {
  const std::vector<state_t>& states = log.messages.Of<state_t>();
  const std::set<int64_t> sessions = SessionsOf(states);
  const std::optional<int64_t> tick = ContradictedTick(states);
  if (sessions.size() <= 1 && !tick.has_value()) return;
  const std::string channel = bus::Channels(log.suffix).Of<state_t>();
  const std::string count = std::to_string(sessions.size());
  std::string found = sessions.size() > 1
                          ? "states from " + count + " senders on " + channel + ", " + count + " runs"
                          : "states of two runs with one session on " + channel;
  if (tick.has_value()) found += " (two different states of tick " + std::to_string(*tick) + ")";
  std::vector<std::string> remarks = log.verdict.remarks;
  remarks.push_back(log.verdict.note);
  std::string remedy = ", so record each into a log of its own";
  for (const std::string& remark : remarks) {
    if (remark.find("joined") != std::string::npos)
      remedy = "; " + remark + ": hydro-log repair --split " + log.file + " takes them apart";
  }
  throw InputError(log.file + ": found " + found + "; one run by one sender is needed" + remedy +
                   "; hydro-log info " + log.file + " shows each");
}

void RequireOneRun(const LimbLog& log) {
  if (!log.whole()) return RequireOneRun(log.limb);
  for (const RunLog& joint : log.joints) RequireOneRun(joint);
}

}  // namespace hydro::runs
