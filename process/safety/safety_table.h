// What happens when something goes wrong: a row for each situation. docs/safety.md shows the table (tests/process
// writes it there), the tests hold the code against it, and hydro-torture says which rows its runs have reached.
#pragma once

#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace hydro::process {

// The promise: plant ticks from the detection of a fault to zero volts. No row allows more.
inline constexpr int kZeroVoltsWithinTicks = 5;

enum class SafeOutput {
  kZeroVolts,
  kReferenceRamped,  // the pressure reference goes to zero first, then the voltage
  kNotObeyed,        // what is wrong has no effect; control goes on
  kControlGoesOn,
};

// How a row's output ends.
enum class Cleared {
  kByItself,
  kByRearm,
  kRunEnds,
};

struct Within {
  std::string_view text;
  // What a program can check: at most so many plant ticks ...
  std::optional<int> ticks = {};
  // ... after the time of this key of [limits] has passed, counted from what happened; empty: after its detection.
  std::string_view after = {};
};

// Texts are Markdown, for a cell of docs/safety.md. Lists are words with one space between.
struct SafetyRow {
  std::string_view id;
  std::string_view fault;     // what happens
  std::string_view detected;  // by whom, and how
  std::string_view codes = {};
  Within within;
  SafeOutput output;
  std::string_view output_text;
  Cleared restart;         // with limits.rearm = "restart"
  Cleared explicit_rearm;  // with "explicit"
  std::string_view cleared_text;
  // tests/e2e: fault_loops.FaultLoopsTest.test_plant_dies; other folders of tests/: plant/PlantAppTest.ModelErrorEndsTheRun.
  std::string_view tests = {};
  // Kinds of faults that hydro-torture injects (sim/torture/schedule/fault_kinds.cc), each enough by itself to reach the
  // row in some run: "slow", or "slow:plant" where it matters to whom.
  std::string_view injected = {};
  std::string_view not_injected = {};  // why there are none
};

// In the order of docs/safety.md.
const std::vector<SafetyRow>& SafetyTable();

// Throws std::invalid_argument for an id that no row has.
const SafetyRow& SafetyRowOf(std::string_view id);
// Its ticks. Throws the same when the row states none.
int TicksWithin(std::string_view id);

// "a b" is a, b.
std::vector<std::string_view> WordsOf(std::string_view list);

// The parts of the table, a file each.
std::span<const SafetyRow> ProcessRows();
std::span<const SafetyRow> LoggerRows();
std::span<const SafetyRow> RigRows();
std::span<const SafetyRow> MotorCommandRows();
std::span<const SafetyRow> PressureCommandRows();
std::span<const SafetyRow> TuningRows();
std::span<const SafetyRow> NetworkRows();
std::span<const SafetyRow> RunRows();

}  // namespace hydro::process
