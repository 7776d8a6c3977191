#include "runs/exports/export_runs.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

#include "base/input_error.h"
#include "base/number_text.h"
#include "bus/messages.h"
#include "runs/exports/channel_sheets.h"
#include "runs/exports/sheet_units.h"
#include "runs/log/log_verdict.h"
#include "runs/recorded/run_config.h"

namespace hydro::exports {
namespace {

using Say = std::function<void(const std::string&)>;

struct Recording {
  std::vector<std::string> files;
  runs::RunLog log;  // all messages of the log
  std::vector<std::string> cautions;
};

bool GoesOn(const runs::RunLog& before, const runs::RunLog& log) {
  const auto& first = before.messages.Of<state_t>();
  const auto& second = log.messages.Of<state_t>();
  return before.suffix == log.suffix && !first.empty() && !second.empty() &&
         first.back().session == second.front().session && second.front().tick > first.back().tick;
}

void Append(runs::RunLog&& log, runs::RunLog* to) {
  bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>&) {
    auto& messages = log.messages.Of<Message>();
    auto& all = to->messages.Of<Message>();
    all.insert(all.end(), std::make_move_iterator(messages.begin()), std::make_move_iterator(messages.end()));
  });
  std::unordered_map<std::string, size_t> places;
  for (size_t i = 0; i < to->channels.size(); ++i) places.emplace(to->channels[i].channel, i);
  for (const runs::ChannelSummary& channel : log.channels) {
    const auto [same, is_new] = places.try_emplace(channel.channel, to->channels.size());
    if (is_new) {
      to->channels.push_back(channel);
    } else {
      to->channels[same->second].events += channel.events;
      to->channels[same->second].undecodable += channel.undecodable;
    }
  }
  to->events += log.events;
}

// Adds the log to the recording that it continues, or starts a new one.
void AddRecording(const std::string& file, runs::RunLog&& log, const Say& say,
                  std::vector<Recording>* recordings) {
  const std::string left_out = runs::DescribeUndecodable(log), caution = runs::DescribeCaution(log);
  if (!left_out.empty()) say(left_out);
  if (const std::string sampling = runs::DescribeSampling(runs::SampleTicks(log.messages));
      !sampling.empty()) {
    say(file + (log.joint.empty() ? "" : ": joint " + log.joint) + ": the table has " + sampling +
        "; voltage_V is what acted up to each");
  }
  const auto before = std::find_if(recordings->rbegin(), recordings->rend(),
                                   [&](const Recording& one) { return one.log.suffix == log.suffix; });
  Recording* recording = before == recordings->rend() ? nullptr : &*before;
  if (recording != nullptr && GoesOn(recording->log, log)) {
    recording->files.push_back(file);
    Append(std::move(log), &recording->log);
  } else {
    recording = &recordings->emplace_back(Recording{{file}, std::move(log), {}});
  }
  if (!caution.empty()) recording->cautions.push_back(caution);
}

std::vector<Recording> ReadRecordings(const std::vector<std::string>& files, const runs::StackChoice& choice,
                                      const Say& say) {
  std::vector<Recording> recordings;
  for (const std::string& file : files) {
    runs::LimbLog log = runs::ReadLimbLog(file, choice, runs::Undecodable::kLeftOut);
    if (!log.whole()) AddRecording(file, std::move(log.limb), say, &recordings);
    for (runs::RunLog& joint : log.joints) AddRecording(file, std::move(joint), say, &recordings);
  }
  return recordings;
}

// The stem of the log, followed by the joint's name for a limb, and by a number where another run already has
// that name.
std::string NameFor(const Recording& recording, const std::vector<ExportedRun>& others) {
  const std::string stem = std::filesystem::path(recording.files.front()).stem().string() +
                           (recording.log.joint.empty() ? "" : "_" + recording.log.joint);
  std::string name = stem;
  for (int i = 2;
       std::any_of(others.begin(), others.end(), [&](const ExportedRun& run) { return run.name == name; });
       ++i) {
    name = stem + "_" + std::to_string(i);
  }
  return name;
}

void Describe(const Recording& recording, const std::optional<UnitSystem>& units, bool si, ExportedRun* run) {
  const auto fact = [&](const char* name, const std::string& value) {
    if (!value.empty()) run->facts.emplace_back(name, value);
  };
  std::string logs;
  for (const std::string& file : recording.files) {
    logs += (logs.empty() ? "" : ", ") + std::filesystem::path(file).filename().string();
  }
  fact("log", logs);
  fact("log_is", log::NameOf(recording.log.verdict.completeness));
  fact("channel_suffix", recording.log.suffix);
  fact("joint", recording.log.joint);
  if (units) {
    fact("units", si ? "SI"
                     : "length " + std::string(units->length) + ", force " + std::string(units->force) +
                           ", pressure " + units->UnitFor("psi"));
  }
  const auto& descriptions = recording.log.messages.Of<run_description_t>();
  if (descriptions.empty()) return;
  const run_description_t& description = descriptions.front();
  fact("recorded_by", description.program);
  fact("version", description.version);
  fact("host", description.host);
  fact("config_file", description.config_file);
  fact("model_file", description.model_file);
  fact("rate_hz", ShortestNumber(description.rate_hz));
  fact("seed", std::to_string(description.seed));
  run->config_text = description.config_text;
  run->model_text = description.model_text;
}

// Nothing where the run's model is damaged and messages are asked for, which have a meaning without it.
std::optional<UnitSystem> UnitsOf(const Recording& recording, const Selection& selection, const Say& say) {
  const auto& descriptions = recording.log.messages.Of<run_description_t>();
  if (descriptions.empty()) return UnitSystem{};
  try {
    return runs::ModelUnits(descriptions.front(), recording.log.file);
  } catch (const InputError& error) {
    if (selection.si || (WantsTable(selection) && !selection.all)) throw;
    say(std::string(error.what()) + "; exported without " + (selection.all ? "the run's table and " : "") +
        "units");
    return std::nullopt;
  }
}

// Names the columns' units, or none where they are not known.
void SetUnits(const std::optional<UnitSystem>& units, bool si, Sheet* sheet) {
  if (units) return SetUnits(*units, si, sheet);
  for (SheetColumn& column : sheet->columns) column.field.unit.clear();
}

// Adds the run's table. When all channels are exported, the table may be missing, and a line says so.
void AddTable(const Recording& recording, const Selection& selection, const Say& say, ExportedRun* run) {
  try {
    run->sheets.push_back(TableSheet(recording.log));
  } catch (const InputError& error) {
    if (!selection.all || recording.log.messages.Of<state_t>().empty()) {
      if (!selection.all) throw;
      return;
    }
    say(std::string(error.what()) + "; exported without the run's table");
  }
}

ExportedRun Export(const Recording& recording, const std::string& name, const Selection& selection,
                   bool times, const Say& say) {
  ExportedRun run;
  run.name = name;
  run.files = recording.files;
  const std::optional<UnitSystem> units = UnitsOf(recording, selection, say);
  Describe(recording, units, selection.si, &run);
  if (units && WantsTable(selection)) AddTable(recording, selection, say, &run);
  const bool table = !run.sheets.empty();
  std::vector<std::string> channels = ChosenChannels(selection, recording.log);
  const std::string states(bus::RowOf<state_t>().channel);
  const bool only_times =
      table && times && std::find(channels.begin(), channels.end(), states) == channels.end();
  if (only_times) channels.insert(channels.begin(), states);
  if (!channels.empty()) {
    std::vector<Sheet> sheets = ReadChannels(recording.files, recording.log.suffix, channels);
    const auto found =
        std::find_if(sheets.begin(), sheets.end(), [&](const Sheet& one) { return one.name == states; });
    if (table && found != sheets.end()) SetTimesOf(*found, &run.sheets.front());
    if (only_times) sheets.erase(found);
    std::move(sheets.begin(), sheets.end(), std::back_inserter(run.sheets));
  }
  for (Sheet& sheet : run.sheets) {
    Cut(selection, &sheet);
    SetUnits(units, selection.si, &sheet);
  }
  return run;
}

void CheckNotEmpty(const Recording& recording, const Selection& selection, const ExportedRun& run) {
  if (std::any_of(run.sheets.begin(), run.sheets.end(), [](const Sheet& sheet) { return sheet.rows() > 0; }))
    return;
  const auto& states = recording.log.messages.Of<state_t>();
  if (states.empty() || (!selection.from_s && !selection.to_s)) {
    throw InputError(recording.log.file +
                     ": found no message of this stack, allowed is a log that holds some");
  }
  throw InputError("--from, --to: found nothing of " + recording.log.file +
                   " there, allowed is a window of its run, " + ShortestNumber(states.front().time) +
                   " s to " + ShortestNumber(states.back().time) + " s");
}

}  // namespace

std::vector<ExportedRun> ReadRuns(const std::vector<std::string>& files, const runs::StackChoice& choice,
                                  const Selection& selection, bool times, const Say& say) {
  CheckSelection(selection);
  std::vector<ExportedRun> runs;
  const std::vector<Recording> recordings = ReadRecordings(files, choice, say);
  runs.reserve(recordings.size());
  for (const Recording& recording : recordings) {
    runs.push_back(Export(recording, NameFor(recording, runs), selection, times, say));
    CheckNotEmpty(recording, selection, runs.back());
  }
  // Cautions come only after all runs were read, so that they do not precede an error.
  for (const Recording& recording : recordings)
    std::for_each(recording.cautions.begin(), recording.cautions.end(), say);
  return runs;
}

}  // namespace hydro::exports
