// Tells how far a study is from its folder alone, because the study may be running on another host.
#pragma once

#include <cstdint>
#include <string>

namespace hydro::batch {

struct StudyStatus {
  std::string name;
  int64_t cases = 0, done = 0, failed = 0;
  std::string driver;       // "process 123 on node17"; empty: none
  int active = 0;           // processes that stored a case within the last minute
  double last_case_s = -1;  // s since a case ended; -1: none has
  double rate = 0;          // cases per second, over those that ended within a minute of the last
  int64_t missing() const { return cases - done - failed; }
};

// Throws InputError when the folder is not a study's.
StudyStatus ReadStatus(const std::string& folder);

// A line or two for people.
std::string StatusText(const StudyStatus& status);

// "3 h 20 min", "45 s"
std::string DurationText(double seconds);

}  // namespace hydro::batch
