#include "scope/signals/view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "base/number_text.h"
#include "base/text_file.h"

namespace hydro::scope {
namespace {

constexpr size_t kMostChannels = 64;
constexpr double kMostPixels = 16384;
constexpr double kMostNumbers = 400000;  // channels times pixels: 6.4 MB per frame
constexpr double kLongestSpan = 1e6;     // s

}  // namespace

std::vector<Signal> FindSignals(const Run& run, const std::vector<std::string>& channels) {
  if (channels.size() > kMostChannels) {
    throw InputError("channels: found " + std::to_string(channels.size()) + ", allowed are 64");
  }
  std::vector<Signal> signals;
  signals.reserve(channels.size());
  for (const std::string& id : channels) {
    const auto signal = run.Find(id);
    if (!signal) {
      throw InputError("channels: found " + Quoted(id) + ", allowed are those that \"runs\" lists for run " +
                       std::to_string(run.id));
    }
    signals.push_back(*signal);
  }
  return signals;
}

void CheckWindow(double span, double pixels, size_t channels) {
  if (!(span > 0 && span <= kLongestSpan)) {
    throw InputError("span: found " + ShortestNumber(span) + ", allowed is above 0 to 1000000 s");
  }
  const double most =
      std::min(kMostPixels, std::floor(kMostNumbers / static_cast<double>(std::max<size_t>(channels, 1))));
  if (!(pixels >= 1 && pixels <= most)) {
    throw InputError("pixels: found " + ShortestNumber(pixels) + ", allowed is 1 to " + ShortestNumber(most) +
                     " for so many channels");
  }
}

View::View(ViewRequest request, const Run& run) : request_(std::move(request)) {
  CheckWindow(request_.span, request_.pixels, request_.channels.size());
  if (!(request_.fps > 0))
    throw InputError("fps: found " + ShortestNumber(request_.fps) + ", allowed is above 0");
  request_.fps = std::min(request_.fps, 60.0);
  FindSignals(run, request_.channels);
}

// Finds the signals again in a run that has begun again or has new channels.
void View::Follow(const Run& run) {
  const bool same_run = run_ == &run;
  if (same_run && revision_ == run.revision) return;
  signals_.clear();
  for (const std::string& id : request_.channels) {
    // Nothing is shown of a loop that has not yet reported in this run.
    static const History kNothing(1);
    signals_.push_back(run.Find(id).value_or(Signal{&kNothing, 0, 0}));
  }
  const double width = request_.span / request_.pixels;
  const bool narrow = run.spacing() > width;
  const BinGrid grid{narrow ? -run.spacing() / 2 : 0, narrow ? run.spacing() : width, 0, 0};
  if (!same_run || grid.width != grid_.width) {
    sent_.clear();
    newest_bin_.reset();
    grid_ = grid;
  }
  run_ = &run;
  revision_ = run.revision;
}

// The earliest time of the rows that have not been sent.
std::optional<double> View::EarliestNew() const {
  std::optional<double> earliest;
  for (const Signal& signal : signals_) {
    const History& history = *signal.history;
    const auto sent = sent_.find(&history);
    // A ghost that begins again has fewer rows than before.
    const bool known = sent != sent_.end() && sent->second <= history.end();
    const History::Row row = std::max(history.begin(), known ? sent->second : 0);
    if (row < history.end()) earliest = std::min(earliest.value_or(history.time(row)), history.time(row));
  }
  return earliest;
}

std::string View::Next(const Run& run, TimePoint now) {
  const std::chrono::duration<double> since = last_ ? now - *last_ : std::chrono::duration<double>(1e9);
  // Rather half a turn early than a whole turn late.
  if (since.count() < 1 / request_.fps - 0.004) return {};
  Follow(run);
  const auto earliest = EarliestNew();
  if (!earliest) return {};
  const int64_t last = grid_.BinOf(run.last_time());
  const auto most = static_cast<int64_t>(request_.pixels);
  int64_t first = grid_.BinOf(std::max(*earliest, run.last_time() - request_.span));
  if (newest_bin_) {
    first = std::min(first, *newest_bin_);
    const double due = since.count() * request_.fps;
    if (due >= 3) skipped_frames_ += static_cast<uint64_t>(due) - 1;
  }
  if (last - first > most) {
    if (newest_bin_) skipped_bins_ += static_cast<uint64_t>(last - most - first);
    first = last - most;
  }
  grid_.first = first;
  grid_.bins = static_cast<uint32_t>(std::max<int64_t>(0, last - first + 1));
  for (const Signal& signal : signals_) sent_[signal.history] = signal.history->end();
  newest_bin_ = last;
  last_ = now;
  return EncodeBins(request_.id, request_.run, kLastIncomplete, grid_, signals_);
}

}  // namespace hydro::scope
