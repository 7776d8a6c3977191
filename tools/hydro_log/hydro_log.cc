#include "tools/hydro_log/hydro_log.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>

#include "base/input_error.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "base/tables/table.h"
#include "base/text_file.h"
#include "runs/info.h"
#include "runs/limb_info.h"
#include "runs/log/joined.h"
#include "runs/log/repair.h"
#include "runs/recorded/compare.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/run_table.h"
#include "runs/recorded/senders.h"
#include "settings/command_line.h"
#include "tools/hydro_log/export_verb.h"
#include "tools/hydro_log/run_verbs.h"

namespace hydro::hydro_log {
namespace {

class InfoVerb {
 public:
  explicit InfoVerb(settings::CommandLine& line) {
    settings::CommandLine& verb = line.AddVerb("info", "What a log holds and whether it is complete.");
    verb.AddPositional("LOG", &log_, "FILE the log");
    runs::AddStackChoice(&verb, &choice_);
    verb.AddFlag("--json", &json_, "print JSON");
    verb.AddFlag("--si", &si_, "print figures in SI units");
  }
  int Run() const {
    const runs::LimbLog log =
        runs::ReadLimbLog(log_, choice_, runs::Undecodable::kLeftOut, log::OnDamage::kStop);
    std::fputs((log.whole() ? TextOf(runs::SummariseLimb(log, si_)) : TextOf(runs::Summarise(log.limb, si_)))
                   .c_str(),
               stdout);
    if (log.limb.verdict.completeness != log::Completeness::kDamaged) return 0;
    throw log::LogError(log_ + ": " + log.limb.verdict.where + "; hydro-log repair " + log_ +
                        " keeps what can be read");
  }

 private:
  std::string TextOf(const runs::LogInfo& info) const {
    return json_ ? runs::InfoJson(info) : PrintableLines(runs::InfoText(info));
  }
  std::string TextOf(const runs::LimbInfo& info) const {
    return json_ ? runs::LimbInfoJson(info) : PrintableLines(runs::LimbInfoText(info));
  }

  std::string log_;
  runs::StackChoice choice_;
  bool json_ = false, si_ = false;
};

class ImportVerb {
 public:
  explicit ImportVerb(settings::CommandLine& line) {
    settings::CommandLine& verb = line.AddVerb("import", "Write a table as a log, the inverse of export.");
    verb.AddPositional(
        "TABLE", &table_,
        "FILE the table: X.csv or X.mat, with any of export's columns that include time_s; in a "
        "MAT file they may stand in one struct");
    verb.AddOption("-o,--output", &out_, "FILE the log", true);
    verb.AddForce();
  }
  int Run() const {
    tables::RequireTableName(table_);
    CheckKeeps(out_, {table_});
    tables::Table table = tables::ReadTableWithoutUnits(table_);
    tables::TakeStructOf("time_s", &table);
    if (!table.layout.empty()) {
      Remark("hydro-log: " + table_ + ": read with " + table.layout);
    }
    runs::ImportRun(table, settings::ProgramVersion(), out_);
    if (!table.left_out.empty()) {
      const tables::LeftOut& first = table.left_out.front();
      Remark("hydro-log: warning: " + table_ + ": left out what is no signal of the run, " +
             std::to_string(table.left_out.size()) + " in all; the first: " + first.name + ": " + first.why);
    }
    return 0;
  }

 private:
  std::string table_, out_;
};

class CompareVerb {
 public:
  explicit CompareVerb(settings::CommandLine& line) {
    settings::CommandLine& verb =
        line.AddVerb("compare", "Tell whether two logs hold the same run, bit by bit.");
    verb.AddPositional("A", &a_, "FILE a log");
    verb.AddPositional("B", &b_, "FILE the other");
    runs::AddStackChoice(&verb, &choice_);
    verb.AddOption("--suffix-a", &suffix_a_, "TEXT suffix for A alone");
    verb.AddOption("--suffix-b", &suffix_b_, "TEXT suffix for B alone");
  }
  int Run() const {
    const runs::LimbLog a = Read(a_, suffix_a_), b = Read(b_, suffix_b_);
    // Two runs that ended before their first state are not a run and its repetition.
    if (!HasStates(a) && !HasStates(b)) {
      throw InputError(a_ + ": found no state, and none in " + b_ +
                       ": nothing was compared; logs of runs are needed");
    }
    const std::optional<std::string> difference = runs::FirstDifference(a, a_, b, b_);
    WarnOf(a.limb);
    WarnOf(b.limb);
    const bool whole = log::Caution(a.limb.verdict).empty() && log::Caution(b.limb.verdict).empty();
    const char* identical = whole ? "identical" : "identical in what is there (the logs are not whole)";
    std::puts(difference.value_or(identical).c_str());
    return difference.has_value() ? 1 : 0;
  }

 private:
  runs::LimbLog Read(const std::string& file, const std::optional<std::string>& suffix) const {
    runs::StackChoice choice = choice_;
    if (suffix) choice.suffix = suffix;
    // Messages that cannot be read cannot be called "identical bit by bit", so they are refused here.
    runs::LimbLog log = runs::ReadLimbLog(file, choice);
    runs::RequireOneRun(log);
    return log;
  }

  static bool HasStates(const runs::LimbLog& log) {
    const auto has = [](const runs::RunLog& run) { return !run.messages.Of<state_t>().empty(); };
    return has(log.limb) || std::any_of(log.joints.begin(), log.joints.end(), has);
  }

  std::string a_, b_;
  runs::StackChoice choice_;
  std::optional<std::string> suffix_a_, suffix_b_;
};

class RepairVerb {
 public:
  explicit RepairVerb(settings::CommandLine& line) {
    settings::CommandLine& verb = line.AddVerb(
        "repair",
        "Keep what can be read of a damaged log. Without -o the log is "
        "replaced, and the damaged one kept as LOG.damaged (LOG.damaged1 ... where that is taken).");
    verb.AddPositional("LOG", &log_, "FILE the log");
    verb.AddOption("-o,--output", &out_, "FILE write the repaired log there and leave LOG alone");
    verb.AddFlag(
        "--split", &split_,
        "write each of the recordings that were joined in LOG, as it is there, to LOG-1, LOG-2, ...");
    verb.AddForce();
  }
  int Run() const {
    if (split_) return Split();
    if (!out_.empty()) CheckKeeps(out_, {log_});
    const log::RepairResult result = out_.empty() ? log::RepairInPlace(log_) : log::RepairLog(log_, out_);
    if (!result.mended()) {
      const std::string copy = out_.empty() ? "" : "; " + out_ + " has the same messages";
      std::printf("%s\n", Printable(log_ + ": nothing to repair" + copy).c_str());
    } else {
      std::fputs(PrintableLines(log::Describe(result, log_)).c_str(), stdout);
    }
    const std::string joined = log::DescribeJoined(result, result.damaged.empty() ? log_ : result.damaged);
    std::fputs(PrintableLines(joined.empty() ? WhyNotOneRun() : joined).c_str(), stdout);
    return 0;
  }

 private:
  // A log may be exactly as it was written and still be refused by the other verbs.
  std::string WhyNotOneRun() const {
    std::optional<runs::LimbLog> log;
    try {
      log = runs::ReadLimbLog(out_.empty() ? log_ : out_, {}, runs::Undecodable::kLeftOut);
    } catch (const InputError&) {
      return "";  // a log of no stack, or of several: nothing is said about their runs
    }
    try {
      runs::RequireOneRun(*log);
    } catch (const InputError& error) {
      return std::string(error.what()) + "\n";
    }
    return "";
  }

  int Split() const {
    if (!out_.empty()) throw InputError("--split: found it beside -o, allowed one of the two");
    std::string text;
    for (const log::JoinedPart& part : log::SplitJoined(log_)) {
      text += part.file + ": " + log::NameOf(part.verdict.completeness);
      if (part.verdict.completeness == log::Completeness::kDamaged)
        text += ": " + part.verdict.where + "; hydro-log repair " + part.file + " keeps what can be read";
      text += "\n";
    }
    std::fputs(PrintableLines(text).c_str(), stdout);
    return 0;
  }

  std::string log_, out_;
  bool split_ = false;
};

}  // namespace

int RunHydroLog(int argc, const char* const* argv) {
  settings::CommandLine line("hydro-log", "Reads, converts, compares, replays and repairs logs.");
  line.AddExamples({"hydro-log summary run.lcmlog", "hydro-log export run.lcmlog -o run.csv"},
                   "docs/logs.md");
  const InfoVerb info(line);
  const ExportVerb export_verb(line);
  const ImportVerb import_verb(line);
  const CompareVerb compare(line);
  const RepairVerb repair(line);
  const SummaryVerb summary(line);
  const TimingVerb timing(line);
  const ReplayVerb replay(line);
  if (const auto exit_code = line.Parse(argc, argv)) return *exit_code;
  return settings::RunProgram("hydro-log", [&] {
    const std::string verb = line.verb();
    if (verb == "info") return info.Run();
    if (verb == "export") return export_verb.Run();
    if (verb == "import") return import_verb.Run();
    if (verb == "compare") return compare.Run();
    if (verb == "summary") return summary.Run();
    if (verb == "timing") return timing.Run();
    if (verb == "replay") return replay.Run();
    return repair.Run();
  });
}

}  // namespace hydro::hydro_log
