#include <cmath>
#include <string>
#include <string_view>

#include "base/tables/mat_sizes.h"
#include "base/tables/table.h"
#include "runs/log/log_reader.h"
#include "runs/measured/measured_run.h"
#include "runs/recorded/run_log.h"
#include "runs/recorded/run_table.h"
#include "settings/stack_config.h"
#include "settings/trajectory_spec.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/targets.h"

// matio forgets a few bytes of some variables that it refuses.
extern "C" const char*
__lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier): the sanitizer's name
extern "C" const char* __lsan_default_suppressions() { return "leak:libmatio"; }

namespace hydro::fuzz {
namespace {

// Between the CSV and its sidecar.
constexpr std::string_view kSeparator = "\n----\n";

}  // namespace

void Table(const uint8_t* data, size_t size) {
  static const ScratchFolder folder;
  const std::string file = folder.Write("table.csv", Text(data, size));
  Accepts([&] {
    const ::hydro::tables::Table table = tables::ReadTable(file);
    for (const tables::Column& column : table.columns) {
      Promise(column.values.size() == table.rows(), "columns are of one length");
    }
    tables::WriteTable(table, folder.Path("again.csv"));
    Accepts([&] {
      runs::ImportRun(table, "fuzz", folder.Path("import.log"));
      Promise(runs::ReadRunLog(folder.Path("import.log")).messages.Of<state_t>().size() == table.rows(),
              "an import has a state a row");
      Promise(runs::ExportRun(runs::ReadRunLog(folder.Path("import.log"))).rows() == table.rows(),
              "an import exports as many rows");
    });
  });
}

// Version 5. That of 7.3 is HDF5's own to read.
void Mat(const uint8_t* data, size_t size) {
  static const ScratchFolder folder;
  const std::string_view text = Text(data, size);
  if (text.find("\x89HDF\r\n") != std::string_view::npos) return;
  const std::string file = folder.Write("table.mat", text);
  Accepts([&] {
    const ::hydro::tables::Table table = tables::ReadTable(file);
    size_t numbers = 0;
    for (const tables::Column& column : table.columns) {
      Promise(column.values.size() == table.rows(), "columns are of one length");
      numbers += column.values.size();
    }
    Promise(numbers <= tables::MostNumbers(size), "a table holds no more than its file can");
  });
}

void MeasuredRun(const uint8_t* data, size_t size) {
  static const ScratchFolder folder;
  const std::string_view text = Text(data, size);
  const size_t separator = text.find(kSeparator);
  if (separator == text.npos) return;
  const std::string file = folder.Write("run.csv", text.substr(0, separator));
  folder.Write("run.toml", text.substr(separator + kSeparator.size()));
  Accepts([&] {
    const ::hydro::runs::MeasuredRun run = runs::ReadMeasuredRun(file);
    Promise(run.samples() >= 2, "a run has two samples or more");
    for (size_t i = 0; i < run.samples(); ++i) {
      Promise(std::isfinite(run.time[i]), "times are finite");
      Promise(i == 0 || run.time[i] > run.time[i - 1], "times increase");
      Promise(std::isfinite(run.voltage.values[i]), "no command is missing");
    }
    for (const runs::MeasuredSignal* signal :
         {&run.voltage, &run.pressure_ref, &run.motor_speed, &run.motor_angle, &run.arm_angle, &run.arm_speed,
          &run.p1, &run.p2}) {
      Promise(!signal->measured() || signal->values.size() == run.samples(), "signals are of one length");
      Promise(!signal->noise || *signal->noise > 0, "noise is above 0");
    }
  });
}

void Points(const uint8_t* data, size_t size) {
  Accepts([&] {
    settings::TrajectorySpec spec;
    spec.kind = settings::TrajectorySpec::Kind::kCsv;
    spec.points = settings::ParseCsvPoints(std::string(Text(data, size)), "points.csv", "value");
    for (const trajectory::Interpolation interpolation :
         {trajectory::Interpolation::kHold, trajectory::Interpolation::kLinear,
          trajectory::Interpolation::kCubic}) {
      spec.interpolation = interpolation;
      const auto trajectory = settings::MakeTrajectory(spec);
      Promise(trajectory->Min() <= trajectory->Max(), "a trajectory has a range");
      for (const trajectory::Step& point : spec.points) {
        const double slack = 1e-9 * (std::abs(trajectory->Max()) + std::abs(trajectory->Min()));
        const double value = trajectory->Value(point.time);
        Promise(!(value > trajectory->Max() + slack) && !(value < trajectory->Min() - slack),
                "values are in the range");
        trajectory->Rate(point.time);
        Promise(!(trajectory->NextBreak(point.time) <= point.time), "the next break is later");
      }
    }
  });
}

}  // namespace hydro::fuzz
