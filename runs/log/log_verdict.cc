#include "runs/log/log_verdict.h"

#include "runs/log/log_examiner.h"

namespace hydro::log {

LogVerdict ExamineLog(const MappedFile& file) { return LogExaminer(file).Examine(); }

const char* NameOf(Completeness completeness) {
  switch (completeness) {
    case Completeness::kComplete:
      return "complete";
    case Completeness::kIncomplete:
      return "incomplete";
    case Completeness::kDamaged:
      return "damaged";
    case Completeness::kWithoutChecksums:
      break;
  }
  return "without checksums";
}

bool EndIsOpen(const LogVerdict& verdict) {
  return verdict.completeness == Completeness::kIncomplete ||
         verdict.completeness == Completeness::kDamaged || !verdict.ending.empty();
}

std::string Caution(const LogVerdict& verdict) {
  std::string text;
  if (verdict.completeness == Completeness::kIncomplete || verdict.completeness == Completeness::kDamaged) {
    text = std::string(NameOf(verdict.completeness)) + ": " + verdict.where;
  }
  if (!verdict.note.empty()) text += (text.empty() ? "" : "; ") + verdict.note;
  if (!verdict.ending.empty()) text += (text.empty() ? "" : "; ") + verdict.ending;
  return text;
}

}  // namespace hydro::log
