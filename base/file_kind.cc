#include "base/file_kind.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <utility>

namespace hydro {
namespace {

using namespace std::string_view_literals;

constexpr std::pair<std::string_view, FileKind> kBeginnings[] = {
    {"\xed\xa1\xda\x01"sv, FileKind::kLog},
    {"MATLAB 5.0 MAT"sv, FileKind::kMat},
    {"MATLAB 7.3 MAT"sv, FileKind::kMat},
    {"\x89HDF\r\n\x1a\n"sv, FileKind::kHdf5},
    {"\x89MCAP0\r\n"sv, FileKind::kMcap},
    {"\x89PNG\r\n"sv, FileKind::kPicture},
    {"\xff\xd8\xff"sv, FileKind::kPicture},
    {"<svg"sv, FileKind::kPicture},
    {"<!DOCTYPE html"sv, FileKind::kPage},
    {"<!doctype html"sv, FileKind::kPage},
    {"<html"sv, FileKind::kPage},
    {"%PDF-"sv, FileKind::kPdf},
    {"PK\x03\x04"sv, FileKind::kSpreadsheet},
    {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1"sv, FileKind::kSpreadsheet},
    {"\x1f\x8b"sv, FileKind::kCompressed},
    {"\x28\xb5\x2f\xfd"sv, FileKind::kCompressed},
    {"\x7f"
     "ELF"sv,
     FileKind::kProgram},
    {"hydro-torture "sv, FileKind::kSchedule},
};

// Sections that only one kind of TOML file has; the most distinctive come first.
constexpr std::pair<std::string_view, FileKind> kSections[] = {
    {"[[joint]]", FileKind::kLimb},    {"[limb]", FileKind::kLimb},      {"[columns]", FileKind::kSidecar},
    {"[[step]]", FileKind::kStudy},    {"[[draw]]", FileKind::kStudy},   {"[[grid]]", FileKind::kStudy},
    {"[collect]", FileKind::kStudy},   {"[model]", FileKind::kStack},    {"[[process]]", FileKind::kStack},
    {"[plant]", FileKind::kStack},     {"[position]", FileKind::kStack}, {"[pressure]", FileKind::kStack},
    {"[parameters]", FileKind::kModel}};

bool HasLine(std::string_view text, std::string_view begins) {
  for (size_t at = text.find(begins); at != std::string_view::npos; at = text.find(begins, at + 1)) {
    if (at == 0 || text[at - 1] == '\n') return true;
  }
  return false;
}

struct Words {
  const char* what;
  const char* who;  // "%" stands for the file
};

Words WordsFor(FileKind kind) {
  switch (kind) {
    case FileKind::kLog:
      return {"an LCM event log",
              "hydro-log info % says what is in it, hydro-log export % -o RUN.csv makes a table of it"};
    case FileKind::kMat:
      return {"a MAT file",
              "hydro-diagnose reads it with a sidecar beside it, hydro-log import makes a log of export's "
              "columns"};
    case FileKind::kHdf5:
      return {"an HDF5 file",
              "hydro-log export writes such files for other tools; no program here reads them"};
    case FileKind::kMcap:
      return {"an MCAP file",
              "hydro-log export writes such files for other tools; no program here reads them"};
    case FileKind::kPicture:
      return {"a picture", "no program here reads one"};
    case FileKind::kPage:
      return {"a page for a browser", "no program here reads one"};
    case FileKind::kPdf:
      return {"a PDF document", "no program here reads one"};
    case FileKind::kSpreadsheet:
      return {"a spreadsheet or a ZIP archive", "save the table as CSV"};
    case FileKind::kCompressed:
      return {"a compressed file", "unpack it first"};
    case FileKind::kProgram:
      return {"a program", "it is run, not read"};
    case FileKind::kJson:
      return {"JSON", "programs here write JSON, and read none"};
    case FileKind::kStack:
      return {"the configuration of a stack", "hydro-launch % and hydro-sim % -o RUN.lcmlog run it"};
    case FileKind::kLimb:
      return {"the configuration of a limb", "hydro-launch % and hydro-sim % -o RUN.lcmlog run it"};
    case FileKind::kModel:
      return {"a model ([parameters])",
              "hydro-diagnose takes it as --model %, a configuration as [model] file"};
    case FileKind::kSidecar:
      return {"a sidecar, which describes a table", "give hydro-diagnose the table beside it"};
    case FileKind::kStudy:
      return {"a study", "hydro-batch % runs it"};
    case FileKind::kSchedule:
      return {"a schedule of faults", "hydro-torture --replay % runs it"};
  }
  return {"a file of another kind", "see the documentation"};
}

}  // namespace

std::string EndingOf(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

std::optional<FileKind> FindFileKind(std::string_view beginning) {
  if (beginning.starts_with("\xef\xbb\xbf")) beginning.remove_prefix(3);
  for (const auto& [bytes, kind] : kBeginnings) {
    if (beginning.starts_with(bytes)) return kind;
  }
  if (beginning.starts_with("<?xml") && beginning.find("<svg") != std::string_view::npos)
    return FileKind::kPicture;
  const size_t first = beginning.find_first_not_of(" \t\r\n");
  if (first != std::string_view::npos && beginning[first] == '{') return FileKind::kJson;
  // A text that only mentions sections has none at the beginning of a line.
  if (beginning.find('\0') != std::string_view::npos) return std::nullopt;
  for (const auto& [section, kind] : kSections) {
    if (HasLine(beginning, section)) return kind;
  }
  return std::nullopt;
}

std::string OtherKind(FileKind kind, const std::string& file, const std::string& allowed) {
  const Words words = WordsFor(kind);
  std::string text = "found " + std::string(words.what) + ", allowed " + allowed + "; ";
  for (const char* c = words.who; *c != '\0'; ++c) *c == '%' ? text += file : text += *c;
  return text;
}

void RequireKind(FileKind kind, std::string_view text, const std::string& file, const std::string& allowed) {
  const std::optional<FileKind> found = FindFileKind(text);
  if (found.has_value() && *found != kind) throw InputError(file + ": " + OtherKind(*found, file, allowed));
}

}  // namespace hydro
