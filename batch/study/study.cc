#include "batch/study/study.h"

namespace hydro::batch {

int64_t Study::cases() const {
  int64_t count = draw_count;
  for (const GridFactor& factor : grid) count *= static_cast<int64_t>(factor.values.size());
  return list.keys.empty() ? count : count * static_cast<int64_t>(list.rows.size());
}

std::vector<std::string> Study::Keys() const {
  std::vector<std::string> keys;
  for (const GridFactor& factor : grid) keys.push_back(factor.key);
  for (const std::string& key : list.keys) keys.push_back(key);
  for (const Draw& draw : draws) keys.push_back(draw.key);
  return keys;
}

// The draws change fastest, then the rows of the list, then the last factor of the grid.
std::vector<Value> Study::Values(int64_t index) const {
  const int64_t draw = same_draws ? index % draw_count : index;
  int64_t rest = index / draw_count;
  std::vector<Value> of_list;
  if (!list.keys.empty()) {
    const auto rows = static_cast<int64_t>(list.rows.size());
    of_list = list.rows[static_cast<size_t>(rest % rows)];
    rest /= rows;
  }
  std::vector<Value> values(grid.size());
  for (size_t i = grid.size(); i-- > 0;) {
    const auto count = static_cast<int64_t>(grid[i].values.size());
    values[i] = grid[i].values[static_cast<size_t>(rest % count)];
    rest /= count;
  }
  values.insert(values.end(), of_list.begin(), of_list.end());
  for (const Draw& each : draws) values.push_back(DrawnValue(each, seed, draw));
  return values;
}

}  // namespace hydro::batch
