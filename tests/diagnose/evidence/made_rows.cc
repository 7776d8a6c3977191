#include "made_rows.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/random.h"

namespace hydro::testing {

namespace {

using Eigen::Index;

std::vector<diagnose::ScanColumn> ColumnsOf(size_t runs) {
  std::vector<diagnose::ScanColumn> columns = {{"J", "", 0.05, false}, {"b", "", 0.3, false}};
  for (size_t r = 0; r < runs; ++r) columns.push_back({"T_s[" + std::to_string(r) + "]", "", 0.05, false});
  columns.push_back({"pump.drag:k", "pump.drag", 1, false});
  columns.push_back({"pump.stribeck|0.1:x", "pump.stribeck|0.1", 1, true});
  columns.push_back({"pump.stribeck|0.3:x", "pump.stribeck|0.3", 1, true});
  columns.push_back({"motor.cogging|7:s", "motor.cogging|7", 1, false});
  columns.push_back({"motor.cogging|7:c", "motor.cogging|7", 1, false});
  for (const char* j : {"1", "2", "3"})
    columns.push_back({std::string("closure.torque(speed):") + j, "closure.torque(speed)", 1, false});
  columns.push_back({"wide.J", "value.J", 0.5, false});
  for (size_t r = 0; r < runs; ++r)
    columns.push_back({"run.T_s[" + std::to_string(r) + "]", "run.T_s", 0.3, false});
  return columns;
}

bool IsOfAnotherRun(const std::string& name, size_t run) {
  return name.find('[') != std::string::npos && !name.ends_with("[" + std::to_string(run) + "]");
}

// A column that looks like another: how much of it is that one.
const std::map<std::string, std::pair<std::string, double>> kAlike = {
    {"wide.J", {"J", 1.0}}, {"pump.stribeck|0.3:x", {"pump.stribeck|0.1:x", 0.9}}};

}  // namespace

int ColumnOf(const diagnose::Rows& rows, const std::string& name) {
  const auto at = std::find_if(rows.columns.begin(), rows.columns.end(),
                               [&](const auto& one) { return one.name == name; });
  if (at == rows.columns.end()) throw std::out_of_range("no column " + name);
  return static_cast<int>(at - rows.columns.begin());
}

diagnose::Rows MakeRows(const Made& made) {
  diagnose::Rows rows;
  rows.columns = ColumnsOf(made.runs);
  Eigen::VectorXd sd(static_cast<Index>(rows.columns.size()));
  for (size_t i = 0; i < rows.columns.size(); ++i) sd[static_cast<Index>(i)] = rows.columns[i].sd;
  rows.prior = sd.array().square().matrix().asDiagonal();
  rows.base = {0, 1};
  rows.other_torques = {1};
  rows.clock = 0;
  uint64_t key = NameKey("made rows") + (made.seed << 32);
  for (size_t run = 0; run < made.runs; ++run) {
    diagnose::RowBlock block;
    block.run = run;
    block.main_column = 0;
    for (size_t i = 0; i < rows.columns.size(); ++i)
      if (!IsOfAnotherRun(rows.columns[i].name, run)) block.columns.push_back(static_cast<int>(i));
    const auto count = static_cast<Index>(made.rows) * static_cast<Index>(made.deviations.size());
    block.X.resize(count, static_cast<Index>(block.columns.size()));
    for (double& x : block.X.reshaped()) x = StandardNormal(++key);
    const auto place = [&](const std::string& name) {
      return std::lower_bound(block.columns.begin(), block.columns.end(), ColumnOf(rows, name)) -
             block.columns.begin();
    };
    for (const auto& [name, alike] : kAlike)
      block.X.col(place(name)) = alike.second * block.X.col(place(alike.first)) +
                                 std::sqrt(1 - alike.second * alike.second) * block.X.col(place(name));
    block.X.col(place("run.T_s[" + std::to_string(run) + "]")) =
        block.X.col(place("T_s[" + std::to_string(run) + "]"));
    block.y.resize(count);
    for (Index i = 0; i < count; ++i) {
      block.band.push_back(static_cast<int>(i) / made.rows);
      block.y[i] = made.deviations[static_cast<size_t>(block.band.back())] * StandardNormal(++key);
    }
    for (const auto& [name, amount] : made.truth)
      if (!IsOfAnotherRun(name, run)) block.y -= amount * block.X.col(place(name));
    block.frequency = Eigen::VectorXd::Constant(count, 10.0);
    block.sensor_variance = Eigen::VectorXd::Constant(count, 1e-4);
    rows.blocks.push_back(std::move(block));
  }
  return rows;
}

}  // namespace hydro::testing
