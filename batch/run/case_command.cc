#include "batch/run/case_command.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "base/did_you_mean.h"
#include "base/text_file.h"

namespace hydro::batch {
namespace {

std::string Filled(const std::string& name, const std::vector<std::string>& keys,
                   const std::vector<Value>& values, const CasePlace& place) {
  if (name == "case") return std::to_string(place.index);
  if (name == "folder") return place.folder;
  if (name == "inputs") return place.inputs;
  std::vector<std::string> known = {"case", "folder", "inputs"};
  for (size_t i = 0; i < keys.size(); ++i) {
    if (name == "value:" + keys[i]) return PlainText(values[i]);
    known.push_back("value:" + keys[i]);
  }
  throw InputError("step.run: found {" + name + "}, allowed in braces " + QuotedList(known) +
                   DidYouMean(name, known));
}

bool IsName(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == ':' || c == '.' || c == '_' || c == '*' || c == '-';
  });
}

// Braces around anything but a name belong to the command itself, as in JSON or awk, and so does ${...}.
std::string Replaced(const std::string& text, const std::vector<std::string>& keys,
                     const std::vector<Value>& values, const CasePlace& place) {
  std::string result;
  for (size_t i = 0; i < text.size();) {
    const bool opens = text[i] == '{' && (i == 0 || text[i - 1] != '$');
    const size_t end = opens ? text.find('}', i) : std::string::npos;
    const std::string name = end == std::string::npos ? "" : text.substr(i + 1, end - i - 1);
    if (IsName(name)) {
      result += Filled(name, keys, values, place);
      i = end + 1;
    } else {
      result += text[i++];
    }
  }
  return result;
}

}  // namespace

std::vector<std::string> CaseCommand(const Step& step, const std::vector<std::string>& keys,
                                     const std::vector<Value>& values, const CasePlace& place) {
  std::vector<std::string> argv;
  for (const std::string& text : step.argv) argv.push_back(Replaced(text, keys, values, place));
  return argv;
}

std::string ProgramPath(const std::string& name) {
  if (name.find('/') != std::string::npos) return name;
  std::error_code failed;
  const std::filesystem::path own = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
  if (!failed && access((own / name).c_str(), X_OK) == 0) return own / name;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "/usr/bin:/bin" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = (folder.empty() ? "." : folder) + "/" + name;
    if (access(candidate.c_str(), X_OK) == 0 && !std::filesystem::is_directory(candidate, failed))
      return std::filesystem::absolute(candidate);
  }
  throw InputError("step.run: found " + Quoted(name) +
                   ", allowed a program beside hydro-batch, in PATH, or with its path");
}

void CheckCommands(const Study& study) {
  for (const Step& step : study.steps) {
    try {
      const std::string program = CaseCommand(step, study.Keys(), study.Values(0), {}).front();
      if (program == step.argv.front()) ProgramPath(program);
    } catch (const InputError& error) {
      throw InputError(step.place + ": " + error.what());
    }
  }
}

}  // namespace hydro::batch
