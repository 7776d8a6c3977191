// What a case leaves behind: the numbers in its files, and result.json.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/study/study.h"

namespace hydro::batch {

struct CaseResult {
  bool failed = false;
  int attempts = 1;
  std::vector<std::optional<Value>> numbers;  // as Study::collect; none: null in the file that it comes from
  std::string reason;                         // of a failure, one line
};

// The text of result.json, which depends on the arguments alone.
std::string ResultText(const Study& study, int64_t index, const CaseResult& result);

// Reads the text back. Returns nothing when it is not whole, as after a power cut, or when it belongs to
// another case.
std::optional<CaseResult> ParseResult(const Study& study, int64_t index, const std::string& text);

// Collects the numbers that a case leaves in its files, in the order of study.collect; none where the file
// says null. The file exit_codes.json is the list of `exit_codes`, the exit codes of the steps. Throws
// InputError naming file and pointer.
std::vector<std::optional<Value>> CollectNumbers(const Study& study, const std::string& folder,
                                                 const std::vector<int>& exit_codes);

}  // namespace hydro::batch
