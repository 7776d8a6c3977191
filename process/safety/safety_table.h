// What happens when something goes wrong: one row for each situation, in safety_table.toml, which the build
// compiles in. docs/safety.md shows the table
// (tests/process writes it there), the tests compare the code with it, and hydro-torture reports which rows
// its runs have reached.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace hydro::settings {
struct TomlNode;
}

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

// As the table writes it: "zero_volts", "by_rearm".
std::string_view NameOf(SafeOutput output);
std::string_view NameOf(Cleared cleared);

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
  std::string_view id;        // the section's name
  std::string_view fault;     // what happens
  std::string_view detected;  // by whom, and how
  std::string_view codes = {};
  Within within;  // a text, or { text = "text", ticks = 5, after = "stale_input_s" }
  // output = { zero_volts = "text" }
  SafeOutput output = SafeOutput::kZeroVolts;
  std::string_view output_text;
  // cleared = { by_itself = "text", explicit = "by_rearm" }
  Cleared restart = Cleared::kByItself;  // with limits.rearm = "restart"
  Cleared explicit_rearm =
      Cleared::kByItself;  // with "explicit"; like `restart` where the row has no such key
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

// The rows of such a document, which must outlive them. Throws InputError for a key or a name that no row may
// have.
std::vector<SafetyRow> ReadSafetyTable(const settings::TomlNode& document);

}  // namespace hydro::process
