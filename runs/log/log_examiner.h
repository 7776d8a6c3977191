// Goes through a log once and compares it with its check events.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runs/log/log_check.h"
#include "runs/log/log_verdict.h"

namespace hydro::log {

class LogExaminer {
 public:
  explicit LogExaminer(const MappedFile& file) : file_(file) {}
  LogVerdict Examine();

 private:
  // An event since the last check event.
  struct Pending {
    int64_t offset;
    int64_t end;
    int64_t utime;
    uint32_t checksum;
  };

  int64_t size() const { return static_cast<int64_t>(file_.size()); }
  // Each of these returns false when the log is damaged at that place; verdict_ then says how.
  bool TakeEvent(int64_t offset);
  bool TakeMessage(const LogEvent& event);
  bool TakeCheck(const LogEvent& event);
  bool TakeBegin(const LogEvent& event, const LogCheck& check);
  bool Follows(const LogEvent& event, const LogCheck& check);
  bool CompareBlock(const LogEvent& event, const LogCheck& check);
  bool Unreadable(int64_t offset, const std::string& wrong);
  bool Damaged(int64_t readable_end, const std::string& where);
  bool CheckFollows(int64_t offset) const;  // whether a check event stands anywhere at or after `offset`
  void Conclude();

  const MappedFile& file_;
  LogVerdict verdict_;
  std::vector<Pending> pending_;
  int64_t messages_ = 0;
  bool block_compared_ = false;  // pending_ was compared, so everything before the first difference is right
  bool begun_ = false;
  bool ended_ = false;
  int64_t begin_ = 0;        // byte of the kBegin in force
  int64_t checked_end_ = 0;  // byte after the last check event
  int64_t checked_utime_ = 0;
  uint32_t previous_ = 0;
};

}  // namespace hydro::log
