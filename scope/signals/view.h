// What is new in a run for a client that watches some of its channels.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scope/signals/run.h"

namespace hydro::scope {

struct ViewRequest {
  uint32_t id = 0;
  uint32_t run = 0;
  std::vector<std::string> channels;
  double span = 10;  // s
  uint32_t pixels = 1000;
  double fps = 60;
};

// Frames are made when the client is ready for one. What a slow client could not be shown in time is counted
// but not repeated, and remains in later bins or in history. No sample is lost between two frames: a bin is
// sent again when samples have been added to it, however late.
class View {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;

  // Throws InputError when a channel is unknown or a number makes no sense.
  View(ViewRequest request, const Run& run);

  // The next frame (bins.h), at most `fps` per second; empty when nothing is new, or when it is too early.
  std::string Next(const Run& run, TimePoint now);

  const ViewRequest& request() const { return request_; }
  // Totals so far: bins that scrolled past unseen, and frames that were due while the client was not ready.
  uint64_t skipped_bins() const { return skipped_bins_; }
  uint64_t skipped_frames() const { return skipped_frames_; }

 private:
  void Follow(const Run& run);
  std::optional<double> EarliestNew() const;

  ViewRequest request_;
  const Run* run_ = nullptr;  // the run to which the signals belong
  uint64_t revision_ = 0;
  std::vector<Signal> signals_;
  std::map<const History*, History::Row> sent_;  // rows before these have been sent
  BinGrid grid_;
  std::optional<int64_t> newest_bin_;  // the newest that was sent
  std::optional<TimePoint> last_;      // time of the last frame
  uint64_t skipped_bins_ = 0;
  uint64_t skipped_frames_ = 0;
};

// The channels' columns. Throws InputError for an unknown one, and for more than 64.
std::vector<Signal> FindSignals(const Run& run, const std::vector<std::string>& channels);

// Throws InputError unless span and pixels make sense.
void CheckWindow(double span, double pixels, size_t channels);

}  // namespace hydro::scope
