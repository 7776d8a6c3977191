// What happens when something goes wrong: one row for each situation. docs/safety.md shows the table
// (tests/process writes it there), the tests compare the code with it, and hydro-torture reports which rows
// its runs have reached.
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
  kNotObeyed,        // the wrong input has no effect; control goes on
  kControlGoesOn,
};

// How the output is released after a row's situation.
enum class Cleared {
  kByItself,
  kByRearm,
  kRunEnds,
};

struct Within {
  std::string_view text;
  // The limit that a program can check: at most this number of plant ticks ...
  std::optional<int> ticks = {};
  // ... after the time of this key of [limits] has passed, counted from the event; when the key is empty,
  // after its detection.
  std::string_view after = {};
};

// Texts are Markdown, for a cell of docs/safety.md. Lists are words separated by one space.
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
  // Tests in tests/e2e: fault_loops.FaultLoopsTest.test_plant_dies; in other folders of tests/:
  // plant/PlantAppTest.ModelErrorEndsTheRun.
  std::string_view tests = {};
  // Kinds of faults that hydro-torture injects (sim/torture/schedule/fault_kinds.cc), each enough by itself
  // to reach the row in some run: "slow", or "slow:plant" where the process that it hits matters.
  std::string_view injected = {};
  std::string_view not_injected = {};  // the reason for injecting none
};

// In the order of docs/safety.md.
const std::vector<SafetyRow>& SafetyTable();

// Throws std::invalid_argument for an id that no row has.
const SafetyRow& SafetyRowOf(std::string_view id);
// The row's ticks. Throws std::invalid_argument when there is no such row or it states none.
int TicksWithin(std::string_view id);

// Splits "a b" into a, b.
std::vector<std::string_view> WordsOf(std::string_view list);

// The parts of the table, one file each.
std::span<const SafetyRow> ProcessRows();
std::span<const SafetyRow> LoggerRows();
std::span<const SafetyRow> RigRows();
std::span<const SafetyRow> MotorCommandRows();
std::span<const SafetyRow> PressureCommandRows();
std::span<const SafetyRow> TuningRows();
std::span<const SafetyRow> NetworkRows();
std::span<const SafetyRow> RunRows();

}  // namespace hydro::process
