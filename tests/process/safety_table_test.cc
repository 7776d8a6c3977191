#include "process/safety/safety_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>

#include "base/input_error.h"
#include "process/fault_codes.h"
#include "settings/toml/toml_document.h"
#include "tests/process/safety_page.h"

namespace hydro::process {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

// What a row's codes do together: the strongest.
SafeOutput OutputOf(const SafetyRow& row) {
  const std::vector<std::string_view> codes = WordsOf(row.codes);
  if (std::any_of(codes.begin(), codes.end(), ZeroesVoltage)) return SafeOutput::kZeroVolts;
  return std::all_of(codes.begin(), codes.end(), IsWarning) ? SafeOutput::kControlGoesOn
                                                            : SafeOutput::kReferenceRamped;
}

// Tests that each row has a name of its own, by which it is found, and says everything.
TEST(SafetyTableTest, RowsAreWhole) {
  std::set<std::string_view> ids, faults;
  for (const SafetyRow& row : SafetyTable()) {
    EXPECT_TRUE(ids.insert(row.id).second) << row.id;
    EXPECT_TRUE(faults.insert(row.fault).second) << row.fault;
    EXPECT_EQ(&SafetyRowOf(row.id), &row);
    for (const auto text : {row.fault, row.detected, row.within.text, row.output_text, row.cleared_text}) {
      EXPECT_FALSE(text.empty()) << row.id;
      EXPECT_EQ(text.find_first_of("|\n"), text.npos) << row.id << ": a cell of a table: " << text;
    }
    EXPECT_NE(row.injected.empty(), row.not_injected.empty()) << row.id;
    EXPECT_FALSE(row.tests.empty() && row.injected.empty()) << row.id << ": nothing shows it";
  }
  EXPECT_THROW(SafetyRowOf("sunshine"), std::invalid_argument);
  EXPECT_EQ(TicksWithin("stop"), 5);
  EXPECT_THROW(TicksWithin("disk_full"), std::invalid_argument);
}

// Tests that a row reads as it is written, and that a key or a name that does not exist is refused with its
// line: a misspelt one would leave a row half empty.
TEST(SafetyTableTest, ReadsRowsAndRefusesUnknownNames) {
  const auto read = [](const std::string& text) {
    return ReadSafetyTable(settings::ParseToml(text, "rows.toml"));
  };
  const settings::TomlNode document = settings::ParseToml(
      "[a]\nfault = 'f'\nwithin = 'soon'\noutput = { not_obeyed = 'none' }\ncleared = { run_ends = 'never' "
      "}\n"
      "[b]\nwithin = { text = '5 ticks', ticks = 5, after = 'stale_input_s' }\n"
      "cleared = { by_itself = 'later', explicit = 'by_rearm' }\n",
      "rows.toml");
  const std::vector<SafetyRow> rows = ReadSafetyTable(document);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].id, "a");
  EXPECT_EQ(rows[0].fault, "f");
  EXPECT_EQ(rows[0].within.text, "soon");
  EXPECT_EQ(rows[0].within.ticks, std::nullopt);
  EXPECT_EQ(rows[0].output, SafeOutput::kNotObeyed);
  EXPECT_EQ(rows[0].output_text, "none");
  EXPECT_EQ(rows[0].explicit_rearm, Cleared::kRunEnds);
  EXPECT_EQ(rows[1].within.ticks, 5);
  EXPECT_EQ(rows[1].within.after, "stale_input_s");
  EXPECT_EQ(rows[1].restart, Cleared::kByItself);
  EXPECT_EQ(rows[1].explicit_rearm, Cleared::kByRearm);
  for (const std::string wrong :
       {"falt = 'f'", "within = { tick = 5 }", "output = { zero_volt = '0 V' }",
        "cleared = { by_hand = 'x' }", "cleared = { by_itself = 'x', explicit = 'never' }",
        "cleared = { by_itself = 'x', implicit = 'y' }"}) {
    try {
      read("[a]\n" + wrong + "\n");
      ADD_FAILURE() << wrong;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("rows.toml:2: found '")) << wrong;
    }
  }
}

TEST(SafetyTableTest, WordsOfAList) {
  EXPECT_THAT(WordsOf(""), IsEmpty());
  EXPECT_THAT(WordsOf("a"), ElementsAre("a"));
  EXPECT_THAT(WordsOf("a b:c d"), ElementsAre("a", "b:c", "d"));
}

// Tests that every code stands in a row, and that every code of a row exists.
TEST(SafetyTableTest, HasEveryCode) {
  std::set<std::string_view> known, named;
  for (const FaultCode& code : FaultCodes())
    EXPECT_TRUE(known.insert(code.code).second) << code.code << " twice";
  for (const SafetyRow& row : SafetyTable()) {
    for (const std::string_view code : WordsOf(row.codes)) named.insert(code);
  }
  EXPECT_EQ(named, known);
}

// Tests that what a row promises of the voltage is what its codes do: zero volts where one of them zeroes it,
// a ramp where the strongest is a ramp, and otherwise control goes on.
TEST(SafetyTableTest, OutputsAreThoseOfTheCodes) {
  for (const SafetyRow& row : SafetyTable()) {
    if (row.codes.empty()) continue;
    const SafeOutput output = row.output == SafeOutput::kNotObeyed ? SafeOutput::kControlGoesOn : row.output;
    EXPECT_EQ(output, OutputOf(row)) << row.id;
  }
}

// Tests that no row allows more ticks than the promise, and that the text of a limit says what a program
// reads.
TEST(SafetyTableTest, LimitsSayWhatIsChecked) {
  int stated = 0;
  for (const SafetyRow& row : SafetyTable()) {
    const std::string text(row.within.text);
    std::smatch number;
    if (std::regex_search(text, number, std::regex(R"((\d+) ticks?\b)"))) {
      ASSERT_TRUE(row.within.ticks) << row.id;
      EXPECT_EQ(std::to_string(*row.within.ticks), number[1]) << row.id;
    }
    if (row.within.ticks) {
      ++stated;
      EXPECT_GE(*row.within.ticks, 0) << row.id;
      EXPECT_LE(*row.within.ticks, kZeroVoltsWithinTicks) << row.id;
    }
    EXPECT_THAT(text, HasSubstr(std::string(row.within.after))) << row.id;
  }
  EXPECT_GT(stated, 15);
}

// Tests that with limits.rearm = "explicit" no motor starts again unasked: what zeroed the voltage needs a
// re-arm, or ends the run. A plant that was started anew was asked to; a joint that follows another's fault
// waits for that one's re-arm.
TEST(SafetyTableTest, ExplicitAsksForARearm) {
  for (const SafetyRow& row : SafetyTable()) {
    const bool zero = row.output == SafeOutput::kZeroVolts || row.output == SafeOutput::kReferenceRamped;
    const bool asked_elsewhere = row.id == "plant_dies" || row.id == "other_joint";
    EXPECT_EQ(row.explicit_rearm != Cleared::kByItself, zero && !asked_elsewhere) << row.id;
    EXPECT_NE(row.restart, Cleared::kByRearm) << row.id << ": \"restart\" knows no re-arm";
    EXPECT_TRUE(row.explicit_rearm != Cleared::kRunEnds || row.restart == Cleared::kRunEnds) << row.id;
    EXPECT_EQ(row.restart == Cleared::kRunEnds,
              std::regex_search(std::string(row.cleared_text), std::regex("the run ends|a new run")))
        << row.id;
  }
}

// Tests that a page keeps what is around its table, and that a page without marks is refused.
TEST(SafetyPageTest, WritesBetweenItsMarks) {
  const std::string begin = "<!-- safety_page --write writes this -->\n", end = "<!-- safety_page ends -->\n";
  EXPECT_EQ(WithTable("before\n" + begin + "old\n" + end + "after\n", "p.md", "| new |\n"),
            "before\n" + begin + "| new |\n" + end + "after\n");
  EXPECT_THROW(WithTable("before\n" + end + begin, "p.md", ""), InputError);
  EXPECT_THROW(WithTable("before\n" + begin, "p.md", ""), InputError);
}

// Tests that users read what happens, without the names of tests.
TEST(SafetyPageTest, WhatHappens) {
  const std::string table = SafetyMarkdown();
  EXPECT_TRUE(table.starts_with("| fault | detected by | within | output | cleared |\n"))
      << table.substr(0, 100);
  EXPECT_THAT(
      table,
      HasSubstr("\n| disk full | logger: exit code 1, the log ends with a whole event; plant, with the "
                "logger's reason (`logger_gone`, a warning) | at once | control goes on | by itself, when a "
                "new logger is heard |\n"));
  EXPECT_THAT(table, Not(HasSubstr("Test.")));
}

// Tests that developers read which tests show a fault, or why hydro-torture does not reach it: a line for
// each row.
TEST(SafetyPageTest, WhichTestsShowIt) {
  const std::string table = SafetyTestsMarkdown();
  EXPECT_TRUE(table.starts_with("| fault | tests | in `hydro-torture` |\n")) << table.substr(0, 100);
  EXPECT_THAT(table, HasSubstr("\n| disk full | `fault_loops` `FaultLoopsTest.test_disk_full`; `tests/plant` "
                               "`PlantFaultsTest.LoggerFailed` | `disk_full` |\n"));
  EXPECT_THAT(table, HasSubstr("| not reached: the simulated network takes every message |\n"));
  for (const std::string& lines : {table, SafetyMarkdown()}) {
    EXPECT_EQ(static_cast<size_t>(std::count(lines.begin(), lines.end(), '\n')), SafetyTable().size() + 2);
  }
}

}  // namespace
}  // namespace hydro::process
