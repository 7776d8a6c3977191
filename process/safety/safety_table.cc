#include "process/safety/safety_table.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace hydro::process {

const std::vector<SafetyRow>& SafetyTable() {
  static const std::vector<SafetyRow> table = [] {
    std::vector<SafetyRow> rows;
    for (const auto part : {ProcessRows(), LoggerRows(), RigRows(), MotorCommandRows(), PressureCommandRows(),
                            TuningRows(), NetworkRows(), RunRows()}) {
      rows.insert(rows.end(), part.begin(), part.end());
    }
    return rows;
  }();
  return table;
}

const SafetyRow& SafetyRowOf(std::string_view id) {
  const std::vector<SafetyRow>& table = SafetyTable();
  const auto found = std::find_if(table.begin(), table.end(), [&](const SafetyRow& r) { return r.id == id; });
  if (found == table.end()) throw std::invalid_argument("no row of the safety table is " + std::string(id));
  return *found;
}

int TicksWithin(std::string_view id) {
  const std::optional<int> ticks = SafetyRowOf(id).within.ticks;
  if (!ticks)
    throw std::invalid_argument("the row " + std::string(id) + " of the safety table states no ticks");
  return *ticks;
}

std::vector<std::string_view> WordsOf(std::string_view list) {
  std::vector<std::string_view> words;
  while (!list.empty()) {
    const size_t end = std::min(list.find(' '), list.size());
    words.push_back(list.substr(0, end));
    list.remove_prefix(std::min(end + 1, list.size()));
  }
  return words;
}

}  // namespace hydro::process
