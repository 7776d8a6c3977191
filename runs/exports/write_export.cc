#include "runs/exports/write_export.h"

#include <algorithm>
#include <iterator>

#include "base/file_kind.h"
#include "base/input_error.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "runs/exports/output.h"

namespace hydro::exports {
namespace {

constexpr struct {
  Format format;
  const char* name;
  std::initializer_list<const char*> endings;
} kFormats[] = {{Format::kCsv, "csv", {".csv"}},
                {Format::kMat, "mat", {".mat"}},
                {Format::kMat73, "mat73", {".mat"}},
                {Format::kHdf5, "hdf5", {".h5", ".hdf5"}},
                {Format::kMcap, "mcap", {".mcap"}}};

// The first format with that ending.
std::optional<Format> FormatOf(const std::string& ending) {
  for (const auto& format : kFormats) {
    for (const char* one : format.endings) {
      if (ending == one) return format.format;
    }
  }
  return std::nullopt;
}

Format FormatNamed(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& format : kFormats) {
    if (name == format.name) return format.format;
    names.emplace_back(format.name);
  }
  throw InputError("--format: found " + Quoted(name) + DidYouMean(name, names) + ", allowed are " +
                   QuotedList(names));
}

}  // namespace

const char* NameOf(Format format) {
  return std::find_if(std::begin(kFormats), std::end(kFormats),
                      [&](const auto& one) { return one.format == format; })
      ->name;
}

bool IsFolder(const std::string& file) { return file.ends_with('/'); }

Format FormatFor(const std::string& file, const std::optional<std::string>& name) {
  const std::optional<Format> by_ending = FormatOf(EndingOf(file));
  if (name.has_value()) {
    const Format named = FormatNamed(*name);
    if (IsFolder(file) && named != Format::kCsv) {
      throw InputError(file + ": found a folder with --format " + *name + ", allowed is one for csv");
    }
    const bool same = by_ending == named || (by_ending == Format::kMat && named == Format::kMat73);
    if (!by_ending || same) return named;
    throw InputError(file + ": found an ending of " + NameOf(*by_ending) + " with --format " + *name +
                     ", allowed is one that fits it");
  }
  if (file == kStandardOutput || IsFolder(file)) return Format::kCsv;
  if (by_ending) return *by_ending;
  throw InputError(file +
                   ": found a name that tells no format, allowed are names that end in .csv, .mat, .h5, " +
                   ".hdf5 or .mcap, any with --format, or a folder, FOLDER/, for CSV");
}

void WriteExport(const std::vector<ExportedRun>& runs, Format format, const std::string& program,
                 const std::string& file, Missing missing) {
  switch (format) {
    case Format::kCsv:
      return WriteCsvExport(runs, missing, file);
    case Format::kMat:
      return WriteMatExport(runs, file);
    case Format::kMat73:
      return WriteMat73Export(runs, file);
    case Format::kHdf5:
      return WriteHdf5Export(runs, program, file);
    case Format::kMcap:
      return WriteMcapExport(runs, program, file);
  }
}

}  // namespace hydro::exports
