#include "runs/log/joined.h"

#include "base/mapped_file.h"
#include "base/new_file.h"
#include "base/word_list.h"
#include "runs/log/log_reader.h"

namespace hydro::log {
namespace {

// "run-2.lcmlog" for the second recording of "run.lcmlog", or of "run.lcmlog.damaged1", the name under which
// a repair keeps it.
std::string PartName(const std::string& file, size_t number) {
  std::string stem = file, ending;
  const size_t damaged = stem.rfind(".damaged");
  if (damaged != std::string::npos && stem.find_first_not_of("0123456789", damaged + 8) == std::string::npos)
    stem.resize(damaged);
  for (const std::string_view known : {".lcmlog", ".lcm", ".log"}) {
    if (!ending.empty() || !stem.ends_with(known) || stem.size() == known.size()) continue;
    ending = known;
    stem.resize(stem.size() - known.size());
  }
  return stem + "-" + std::to_string(number) + ending;
}

}  // namespace

std::string DescribeJoined(const RepairResult& result, const std::string& file) {
  if (result.joined_at.empty()) return {};
  const size_t count = result.joined_at.size() + 1;
  return file + ": " + std::to_string(count) +
         " recordings were joined in it, and other verbs read one run; hydro-log repair --split " +
         ShellWord(file) + " takes them apart: " + PartName(file, 1) + " to " + PartName(file, count) + "\n";
}

std::vector<JoinedPart> SplitJoined(const std::string& file) {
  std::vector<int64_t> ends = RepairLog(file, "").joined_at;
  if (ends.empty()) {
    throw InputError(file +
                     ": found one recording, allowed with --split a log in which several were joined (of a "
                     "repaired log, the one that it was repaired from)");
  }
  const MappedFile contents(file);
  ends.push_back(static_cast<int64_t>(contents.size()));
  std::vector<JoinedPart> parts(ends.size());
  for (size_t k = 0; k < parts.size(); ++k) {
    parts[k].file = PartName(file, k + 1);
    CheckCanBeCreated(parts[k].file);
  }
  for (size_t k = 0; k < parts.size(); ++k) {
    const int64_t begin = k == 0 ? 0 : ends[k - 1];
    NewFile out(parts[k].file, Opening::kTemporary, Existing::kKept);
    out.Write(contents.data() + begin, static_cast<size_t>(ends[k] - begin));
    out.Finish();
    parts[k].verdict = ExamineLog(MappedFile(parts[k].file));
  }
  return parts;
}

}  // namespace hydro::log
