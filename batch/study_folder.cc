#include "batch/study_folder.h"

#include <algorithm>
#include <filesystem>

#include "base/new_file.h"
#include "base/read_files.h"
#include "base/text_file.h"
#include "batch/report/study_numbers.h"
#include "batch/report/study_page.h"
#include "batch/run/case_command.h"
#include "batch/study/study.h"

namespace hydro::batch {
namespace {

namespace fs = std::filesystem;

void CheckSame(const Study& study, const std::string& folder) {
  const Study there = OpenStudy(folder);
  const std::string difference = StudyDifference(there, study);
  if (difference.empty()) return;
  throw InputError(folder + ": found the cases of another study: " + difference +
                   "; go on with that one, or give another --out");
}

// Whether hydro-batch has made the folder. A study that its user has written may be called study.toml too: it
// is not in the form in which WriteStudy() writes, and no case of it has run there. Folders of other
// versions, which may write in another form, have cases.
bool IsMade(const Study& study, const std::string& folder) {
  std::error_code failed;
  return ReadTextFile(folder + "/study.toml") == study.files.at("study.toml") ||
         (fs::is_directory(folder + "/cases", failed) && fs::is_directory(folder + "/times", failed));
}

// Every file that FinishStudy() writes, so that a study that reads one of them is refused before its cases
// run.
void CheckKeepsInputs(const std::string& folder) {
  for (const char* name :
       {"table.csv", "table.json", "index.html", "distributions.svg", "worst.svg", "surface.svg"})
    CheckKeeps(folder + "/" + name);
}

// study.toml is written last, so that its presence means that everything is there.
void WriteStudy(const Study& study, const std::string& folder) {
  std::error_code failed;
  if (fs::exists(folder, failed) && !fs::is_directory(folder, failed))
    throw InputError(folder + ": found a file, allowed a folder");
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename();
    if (study.files.contains(name) || study.files.contains(WholeOfPart(name)) || name == "inputs" ||
        name.starts_with("lock"))
      continue;
    throw InputError(folder + ": found " + Quoted(name) +
                     " in it, allowed a new folder, an empty one, or one of hydro-batch");
  }
  fs::create_directories(folder + "/inputs", failed);
  if (failed) throw InputError(folder + ": cannot be made: " + failed.message());
  for (const auto& [name, text] : study.files) {
    if (name != "study.toml") WriteWholeFile(folder + "/" + name, text);
  }
  WriteWholeFile(folder + "/study.toml", study.files.at("study.toml"));
}

namespace fs = std::filesystem;

// Removes what a killed process left when it was writing one of the study's own files.
void SweepParts(const Study& study, const std::string& folder) {
  std::error_code failed;
  std::vector<fs::path> left;
  for (const auto& entry : fs::directory_iterator(folder, failed)) {
    const fs::path whole = WholeOfPart(entry.path().filename());
    const bool ours = study.files.contains(whole) || whole == "table.csv" || whole == "table.json" ||
                      whole.extension() == ".svg" || whole.extension() == ".html";
    if (ours && entry.is_regular_file(failed) && !IsBeingWritten(entry.path())) left.push_back(entry.path());
  }
  for (const fs::path& path : left) fs::remove(path, failed);
}

}  // namespace

void PrepareStudy(const Study& study, const std::string& folder) {
  CheckCommands(study);
  CheckKeepsInputs(folder);
  const std::string file = folder + "/study.toml";
  if (fs::exists(file)) {
    CheckSame(study, folder);
    // The report may differ.
    if (OpenStudy(folder).files.at("study.toml") != study.files.at("study.toml")) {
      ForgetRead(file);
      WriteWholeFile(file, study.files.at("study.toml"));
    }
  } else {
    WriteStudy(study, folder);
  }
}

Study OpenStudy(const std::string& folder) {
  const std::string file = folder + "/study.toml";
  if (!fs::exists(file))
    throw InputError(folder + ": found no study.toml in it, allowed the folder of a study");
  Study study = ReadStudy(file);
  if (!IsMade(study, folder))
    throw InputError(folder +
                     ": found \"study.toml\" in it, which hydro-batch has not written, allowed a new " +
                     "folder, an empty one, or one of hydro-batch");
  return study;
}

TableCounts FinishStudy(const std::string& folder, int jobs) {
  const Study study = OpenStudy(folder);
  CaseStore(folder).SweepStaging();
  SweepParts(study, folder);
  StudyNumbers numbers(study);
  TableCounts counts = WriteTable(study, folder, jobs, [&](const TableRow& row) { numbers.Add(row); });
  WritePage(study, folder, counts, numbers);
  return counts;
}

}  // namespace hydro::batch
