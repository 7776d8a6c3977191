#include "tools/hydro_log/export_verb.h"

#include "base/input_error.h"
#include "base/new_folder.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "runs/exports/export_runs.h"
#include "runs/exports/output.h"
#include "runs/exports/write_export.h"

namespace hydro::hydro_log {

ExportVerb::ExportVerb(settings::CommandLine& line) {
  settings::CommandLine& verb = line.AddVerb("export",
                                             "Write runs for other tools: a table, one row per plant tick, "
                                             "or the messages of channels. Each joint of a "
                                             "limb is a run of its own.");
  verb.AddPositional("LOG", &logs_, "FILE the log; several: runs, or one that a recorder split");
  verb.AddOption("-o,--output", &out_,
                 "FILE where to write: X.csv, X.mat, X.h5, X.hdf5, X.mcap, FOLDER/ for a CSV of each table, "
                 "or - for the standard output",
                 true);
  verb.AddOption("--format", &format_,
                 "NAME csv, mat (version 5), mat73, hdf5 or mcap, where the file's name does not tell");
  verb.AddOption(
      "--missing", &missing_,
      "WORD how CSV shows missing values: empty (default) or nan, for readers that take an empty cell for 0");
  verb.AddFlag("--si", &selection_.si, "convert to SI units");
  verb.AddOption("--from", &from_s_, "S leave out what is before this plant time");
  verb.AddOption("--to", &to_s_, "S leave out what is after this plant time");
  verb.AddOption("--rate", &selection_.rate_hz,
                 "HZ thin out to at most this many rows a second; faults stay");
  verb.AddOption(
      "--channel", &selection_.channels,
      "NAME export the messages of this channel (HYDRO_STATE), or table; may be given several times");
  verb.AddFlag("--all-channels", &selection_.all,
               "export the table and the messages of every channel (MCAP: always)");
  verb.AddForce();
  runs::AddStackChoice(&verb, &choice_);
}

int ExportVerb::Run() const {
  const exports::Format format =
      exports::FormatFor(out_, format_.empty() ? std::nullopt : std::optional(format_));
  if (missing_ != "empty" && missing_ != "nan")
    throw InputError("--missing: found " + Quoted(missing_) + ", allowed empty or nan");
  if (missing_ == "nan" && format != exports::Format::kCsv)
    throw InputError("--missing: found nan for " + std::string(exports::NameOf(format)) +
                     ", allowed for CSV: the other formats always have NaN");
  exports::Selection selection = selection_;
  if (from_s_ != kNotGiven) selection.from_s = from_s_;
  if (to_s_ != kNotGiven) selection.to_s = to_s_;
  if (selection.all && !selection.channels.empty()) {
    throw InputError("--channel: found together with --all-channels, allowed is one of the two");
  }
  // A file of messages holds all of them unless some are chosen.
  const bool messages = format == exports::Format::kMcap;
  if (messages && selection.channels.empty()) selection.all = true;
  if (exports::IsFolder(out_)) {
    const NewFolder attempt(out_);
  } else {
    CheckKeeps(out_, logs_);
    CheckCanBeWritten(out_);
  }
  const auto say = [](const std::string& line) { Remark("hydro-log: warning: " + line); };
  const auto runs = exports::ReadRuns(logs_, choice_, selection, messages, say);
  exports::WriteExport(runs, format, "hydro-log " + settings::ProgramVersion(), out_,
                       missing_ == "nan" ? exports::Missing::kNan : exports::Missing::kEmpty);
  return 0;
}

}  // namespace hydro::hydro_log
