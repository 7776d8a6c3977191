#include "scope/signals/history.h"

#include <algorithm>
#include <cmath>

namespace hydro::scope {
namespace {

constexpr uint64_t kBlockRows = 4096;
constexpr uint64_t kFineRows = 16;     // rows in a stretch of the first level
constexpr uint64_t kCoarseRows = 256;  // rows in a stretch of the second level
constexpr uint64_t kFine = kBlockRows / kFineRows;
constexpr uint64_t kCoarse = kBlockRows / kCoarseRows;

}  // namespace

struct History::Block {
  explicit Block(size_t columns)
      : values(columns * kBlockRows), fine(columns * kFine), coarse(columns * kCoarse), whole(columns) {}

  uint64_t rows = 0;
  std::array<double, kBlockRows> times;
  std::vector<double> values;  // by column
  std::vector<Extremes> fine;
  std::vector<Extremes> coarse;
  std::vector<Extremes> whole;
};

History::History(size_t columns, uint64_t most_rows) : columns_(columns), most_rows_(most_rows) {}
History::~History() = default;
History::History(History&&) noexcept = default;
History& History::operator=(History&&) noexcept = default;

bool History::Append(double time, const double* values) {
  if (!std::isfinite(time) || (end_ > first_ && !(time > last_time()))) return false;
  if (blocks_.empty() || blocks_.back()->rows == kBlockRows) {
    blocks_.push_back(std::make_unique<Block>(columns_));
    if (blocks_.size() > 2 && end_ - first_ - kBlockRows >= most_rows_) {
      first_ += blocks_.front()->rows;
      blocks_.pop_front();
    }
  }
  Block& block = *blocks_.back();
  const uint64_t row = block.rows++;
  block.times[row] = time;
  for (size_t c = 0; c < columns_; ++c) {
    block.values[c * kBlockRows + row] = values[c];
    block.fine[c * kFine + row / kFineRows].Add(values[c]);
    block.coarse[c * kCoarse + row / kCoarseRows].Add(values[c]);
    block.whole[c].Add(values[c]);
  }
  ++end_;
  return true;
}

void History::DropBefore(double time) {
  while (blocks_.size() > 1 && blocks_.front()->times[kBlockRows - 1] < time) {
    first_ += kBlockRows;
    blocks_.pop_front();
  }
}

const History::Block& History::BlockOf(Row row) const { return *blocks_[(row - first_) / kBlockRows]; }

double History::time(Row row) const { return BlockOf(row).times[(row - first_) % kBlockRows]; }

double History::value(Row row, size_t column) const {
  return BlockOf(row).values[column * kBlockRows + (row - first_) % kBlockRows];
}

double History::last_time() const {
  return empty() ? std::numeric_limits<double>::quiet_NaN() : blocks_.back()->times[blocks_.back()->rows - 1];
}

History::Row History::LowerBound(double time) const {
  const auto block = std::partition_point(blocks_.begin(), blocks_.end(),
                                          [&](const auto& b) { return b->times[b->rows - 1] < time; });
  if (block == blocks_.end()) return end_;
  const auto* const begin = (*block)->times.data();
  const auto* const found = std::lower_bound(begin, begin + (*block)->rows, time);
  return first_ + static_cast<uint64_t>(block - blocks_.begin()) * kBlockRows +
         static_cast<uint64_t>(found - begin);
}

History::Row History::LowerBoundFrom(Row hint, double time) const {
  // Steps that double from the hint find a nearby row in a few comparisons.
  Row low = std::max(hint, first_);
  uint64_t step = 1;
  Row high = low;
  while (high < end_ && this->time(high) < time) {
    low = high + 1;
    high = low + step;
    step *= 2;
  }
  high = std::min(high, end_);
  while (low < high) {
    const Row middle = low + (high - low) / 2;
    if (this->time(middle) < time) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}

Extremes History::Find(Row from, Row to, size_t column) const {
  Extremes found;
  const auto add = [&](const Extremes& other) {
    found.Add(other.min);
    found.Add(other.max);
  };
  // Row numbers within blocks count from the first kept block, so that stretches lie at multiples of their
  // length.
  uint64_t at = from - first_;
  const uint64_t last = to - first_;
  while (at < last) {
    const Block& block = *blocks_[at / kBlockRows];
    const uint64_t row = at % kBlockRows;
    const uint64_t left = last - at;
    if (row == 0 && left >= kBlockRows) {
      add(block.whole[column]);
      at += kBlockRows;
    } else if (row % kCoarseRows == 0 && left >= kCoarseRows) {
      add(block.coarse[column * kCoarse + row / kCoarseRows]);
      at += kCoarseRows;
    } else if (row % kFineRows == 0 && left >= kFineRows) {
      add(block.fine[column * kFine + row / kFineRows]);
      at += kFineRows;
    } else {
      found.Add(block.values[column * kBlockRows + row]);
      ++at;
    }
  }
  return found;
}

size_t History::memory() const {
  const size_t column = sizeof(double) * kBlockRows + sizeof(Extremes) * (kFine + kCoarse + 1);
  return blocks_.size() * (sizeof(Block) + columns_ * column);
}

}  // namespace hydro::scope
