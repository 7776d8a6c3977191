// The files of hydro-launch --timing: REPORT.json and REPORT.html beside it.
#pragma once

#include <string>
#include <vector>

#include "runs/timing/timing_record.h"

namespace hydro::launch {

class TimingFiles {
 public:
  // `json`: "REPORT.json". Throws InputError when the name ends otherwise or the folder is not writable, so
  // that this is known before the run starts.
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
