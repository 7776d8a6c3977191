// Writes the files of hydro-launch --timing: REPORT.json and, beside it, REPORT.html.
#pragma once

#include <string>
#include <vector>

#include "runs/timing/timing_record.h"

namespace hydro::launch {

class TimingFiles {
 public:
  // `json` is "REPORT.json". Throws InputError when the name has another ending or the folder is not
  // writable, so that the error comes before the run starts.
  explicit TimingFiles(const std::string& json);

  // Writes both files, each whole or not at all. Throws WriteError or InputError.
  void Write(const std::vector<timing::TimedProcess>& processes, const std::string& source) const;

  const std::string& json() const { return json_; }
  const std::string& page() const { return page_; }

 private:
  std::string json_;
  std::string page_;
};

}  // namespace hydro::launch
