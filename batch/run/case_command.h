// The commands of a case, with its values in place of the placeholders:
//   {case}        the case's number
//   {value:KEY}   the case's value of a varied key
//   {folder}      the folder in which the case runs
//   {inputs}      the folder with the study's files
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/study/study.h"

namespace hydro::batch {

struct CasePlace {
  int64_t index = 0;
  std::string folder, inputs;  // absolute paths
};

// Throws InputError for an unknown placeholder.
std::vector<std::string> CaseCommand(const Step& step, const std::vector<std::string>& keys,
                                     const std::vector<Value>& values, const CasePlace& place);

// The path of a program that a study names: as given when the name has a slash, or else beside this program,
// or else in PATH. Throws InputError.
std::string ProgramPath(const std::string& name);

// Throws InputError when the study's commands have unknown placeholders or programs that do not exist.
void CheckCommands(const Study& study);

// Wakes all waiting threads, once. Any thread may call these functions.
class StopBell {
 public:
  StopBell();
  ~StopBell();
  StopBell(const StopBell&) = delete;
  StopBell& operator=(const StopBell&) = delete;

  void Ring() const;
  bool Rings() const;
  // Waits for the bell at most that long.
  bool RingsWithin(std::chrono::milliseconds time) const;
  int descriptor() const { return descriptor_; }  // readable once it rang

 private:
  int descriptor_;
};

struct ChildRequest {
  std::vector<std::string> argv;  // argv[0]: path of the program
  std::string folder;             // folder in which it runs
  std::string out, err;           // files for its output
  std::optional<std::chrono::steady_clock::time_point> deadline = std::nullopt;
};

enum class ChildEnd { kEnded, kLate, kStopped };

struct ChildResult {
  ChildEnd end = ChildEnd::kEnded;
  int wait_status = 0;
};

// Runs a command and waits until it ends, is late, or must stop. A child that is late or stopped gets
// SIGTERM, together with its whole process group, and SIGKILL two seconds later. Throws process::StartError,
// and StoreError for the files.
ChildResult RunChild(const ChildRequest& request, const StopBell& bell);

}  // namespace hydro::batch
