#include "runs/exports/selection.h"

#include <algorithm>
#include <cmath>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "bus/definitions/message_definition.h"

namespace hydro::exports {
namespace {

// The stack's channels for which the log holds messages, in the order of the table of messages.
std::vector<std::string> ChannelsOf(const runs::RunLog& log) {
  std::vector<std::string> found;
  for (const definitions::MessageDefinition& definition : definitions::Definitions()) {
    const std::string name = definition.channel + log.suffix;
    const auto holds = [&](const runs::ChannelSummary& channel) {
      return channel.channel == name && channel.events > channel.undecodable;
    };
    if (std::any_of(log.channels.begin(), log.channels.end(), holds)) found.push_back(definition.channel);
  }
  return found;
}

}  // namespace

void CheckSelection(const Selection& selection) {
  for (const auto& [name, value] :
       {std::pair("--from", selection.from_s), std::pair("--to", selection.to_s)}) {
    if (value && !std::isfinite(*value)) {
      throw InputError(std::string(name) + ": found " + NumberText(*value) + ", allowed is a time in s");
    }
  }
  if (selection.from_s && selection.to_s && *selection.to_s < *selection.from_s) {
    throw InputError("--to: found " + ShortestNumber(*selection.to_s) +
                     " s, allowed is a time from --from, " + ShortestNumber(*selection.from_s) + " s, on");
  }
  if (!std::isfinite(selection.rate_hz) || selection.rate_hz < 0) {
    throw InputError("--rate: found " + NumberText(selection.rate_hz) +
                     ", allowed are rows a second, above 0, or 0 for every row");
  }
}

bool WantsTable(const Selection& selection) {
  return selection.all || selection.channels.empty() ||
         std::find(selection.channels.begin(), selection.channels.end(), kTableName) !=
             selection.channels.end();
}

std::vector<std::string> ChosenChannels(const Selection& selection, const runs::RunLog& log) {
  std::vector<std::string> there = ChannelsOf(log);
  if (selection.all) return there;
  std::vector<std::string> chosen;
  for (const std::string& channel : there) {
    const auto names_it = [&](const std::string& given) {
      return given == channel || given == channel + log.suffix;
    };
    if (std::any_of(selection.channels.begin(), selection.channels.end(), names_it))
      chosen.push_back(channel);
  }
  for (const std::string& given : selection.channels) {
    const auto is_it = [&](const std::string& channel) {
      return given == channel || given == channel + log.suffix;
    };
    if (given == kTableName || std::any_of(chosen.begin(), chosen.end(), is_it)) continue;
    std::vector<std::string> allowed = there;
    allowed.insert(allowed.begin(), kTableName);
    throw InputError("--channel: found " + Quoted(given) + DidYouMean(given, allowed) + ", allowed of " +
                     log.file + " are " + QuotedList(allowed));
  }
  return chosen;
}

void Cut(const Selection& selection, Sheet* sheet) {
  const bool thin = selection.rate_hz > 0 && sheet->every_tick;
  if (!selection.from_s && !selection.to_s && !thin) return;
  std::vector<bool> keep(sheet->rows(), true);
  // Times of ticks are rounded, so a tick at the beginning of an interval may lie a little before it.
  constexpr double kRounding = 1e-6;
  double last_interval = -HUGE_VAL;
  for (size_t row = 0; row < keep.size(); ++row) {
    const double time = sheet->time_s[row];
    // A message from before the first state belongs to the beginning.
    if (selection.from_s && !(time >= *selection.from_s)) keep[row] = false;
    if (selection.to_s && time > *selection.to_s) keep[row] = false;
    if (!keep[row] || !thin || std::isnan(time)) continue;
    const double interval = std::floor(time * selection.rate_hz + kRounding);
    keep[row] = interval != last_interval;
    last_interval = interval;
  }
  KeepRows(keep, sheet);
}

}  // namespace hydro::exports
