#include "tests/settings/configuration_page.h"

#include <algorithm>

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using testing::HasSubstr;

const KeyFacts& FactsOf(const std::vector<KeyFacts>& all, const std::string& section,
                        const std::string& key) {
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const KeyFacts& f) { return f.section == section && f.key == key; });
  if (found == all.end()) throw std::runtime_error("no " + section + "." + key);
  return *found;
}

// A page with a table for each section.
std::string PageOf(std::vector<KeyFacts> facts) {
  std::stable_sort(facts.begin(), facts.end(),
                   [](const KeyFacts& a, const KeyFacts& b) { return a.section < b.section; });
  std::string page, section;
  for (const KeyFacts& each : facts) {
    if (each.section != section)
      page += "\n`[" + each.section + "]`:\n| key | default | allowed | meaning |\n|---|---|---|---|\n";
    section = each.section;
    page += "| `" + each.key + "` | by hand | | \\|x\\| |\n";
  }
  return page;
}

class ConfigurationPageTest : public ::testing::Test {
 protected:
  std::string Current(const std::string& page) const {
    return CurrentConfigurationPage(page, "page.md", facts_);
  }

  const std::vector<KeyFacts> facts_ = ConfigurationFacts();
  const std::string page_ = PageOf(facts_);
};

// Tests that defaults and what is allowed come from the readers, in short words.
TEST_F(ConfigurationPageTest, FactsComeFromTheReaders) {
  EXPECT_EQ(FactsOf(facts_, "plant", "rate_hz").standard, std::to_string(int(PlantSection{}.rate_hz)));
  EXPECT_EQ(FactsOf(facts_, "plant", "rate_hz").allowed, "above 0, at most 1000000");
  EXPECT_EQ(FactsOf(facts_, "plant", "command_delay_ticks").allowed, "0 or 1");
  EXPECT_EQ(FactsOf(facts_, "plant", "integrator").standard, "`\"auto\"`");
  EXPECT_EQ(FactsOf(facts_, "limits", "motor_speed").standard, "`inf`");
  EXPECT_EQ(FactsOf(facts_, "limits", "motor_speed").allowed, "above 0 or `inf`");
  EXPECT_EQ(FactsOf(facts_, "limits", "rearm").standard, "");
  EXPECT_EQ(FactsOf(facts_, "position", "braking").standard, "none");
  EXPECT_EQ(FactsOf(facts_, "driver.voltage", "scale").standard, "required");
  EXPECT_EQ(FactsOf(facts_, "driver", "p1").allowed, "section with `source` `\"analog\"`");
  EXPECT_EQ(FactsOf(facts_, "bus", "channel_suffix").standard, "`\"\"`");
  EXPECT_EQ(FactsOf(facts_, "reference", "initial").kinds, (std::vector<std::string>{"steps", "planner"}));
  EXPECT_EQ(FactsOf(facts_, "driver.SENSOR", "low_pass_hz").kinds.size(), 3u);
}

// Tests that the columns are written in place, twice the same, and that the others stay.
TEST_F(ConfigurationPageTest, WritesItsColumns) {
  const std::string current = Current(page_);
  EXPECT_THAT(current, HasSubstr("| `rate_hz` | 1000 | above 0, at most 1000000 | \\|x\\| |\n"));
  EXPECT_THAT(current, HasSubstr("| `rearm` | by hand | `\"restart\"`, `\"explicit\"` | \\|x\\| |\n"));
  EXPECT_EQ(Current(current), current);
  EXPECT_EQ(Current("## Other\n\n| key | value |\n|---|---|\n| `x` | 1 |\n\n" + current).substr(0, 8),
            "## Other");
}

// Tests that a key without a row, a row without a key, a second row, and a missing default are named.
TEST_F(ConfigurationPageTest, RefusesWhatDoesNotFit) {
  const auto said = [&](const std::string& from, const std::string& to) {
    return InputErrorOf([&] { Current(Replaced(page_, from, to)); });
  };
  const std::string row = "| `url` | by hand | | \\|x\\| |\n";
  EXPECT_THAT(said(row, ""),
              HasSubstr("page.md: found no row for the key bus.url; add one to the table of [bus]"));
  EXPECT_THAT(said(row, row + row), HasSubstr("page.md:6: found a second row for bus.url"));
  EXPECT_THAT(said("`url`", "`uri`"), HasSubstr("page.md:5: found uri, which is no key of [bus]"));
  EXPECT_THAT(said("`rearm` | by hand", "`rearm` | "), HasSubstr("found no default of rearm"));
  EXPECT_THAT(said(row, "| `url` | |\n"), HasSubstr("page.md:5: found 2 cells, the table has 4 columns"));
  EXPECT_THAT(said("| key | default | allowed |", "| key | default | what |"),
              HasSubstr("page.md:3: found a table of keys without a column allowed"));
  EXPECT_THAT(
      said(row + "| `channel_suffix` | by hand | | \\|x\\| |\n", "| `url`, `channel_suffix` | | | |\n"),
      HasSubstr("found one row for url and channel_suffix, which differ"));
}

}  // namespace
}  // namespace hydro::settings
