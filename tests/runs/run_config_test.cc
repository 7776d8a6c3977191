#include "runs/recorded/run_config.h"

#include <gmock/gmock.h>

#include "tests/runs/log/log_fixture.h"

namespace hydro::runs {
namespace {

using testing::HasSubstr;

run_description_t DescriptionOf(const std::string& config_text, const std::string& model_text = "") {
  run_description_t description{};
  description.config_text = config_text;
  description.model_text = model_text;
  return description;
}

// Tests that every kind of value is shown on one line, sorted by key.
TEST(RunConfigTest, EntriesOfEveryKind) {
  using Entry = std::pair<std::string, std::string>;
  EXPECT_THAT(
      ConfigEntries(DescriptionOf("z = 1\nb = true\nf = 2e-7\nn = nan\nd = 1984-06-01\ns = \"it's\\n\"\n"
                                  "a = {y = 'q', x = [1.0, -3]}\np = [{k = 1, c = 'x'}]\n"),
                    "a.lcmlog"),
      testing::ElementsAre(Entry("a.x", "[1, -3]"), Entry("a.y", "'q'"), Entry("b", "true"),
                           Entry("d", "1984-06-01"), Entry("f", "2e-07"), Entry("n", "nan"),
                           Entry("p", "[{c = 'x', k = 1}]"), Entry("s", "\"it's\\u000A\""), Entry("z", "1")));
}

// Tests the delay and the model's name, given and not given.
TEST(RunConfigTest, DelayAndModelName) {
  EXPECT_EQ(CommandDelayTicks(DescriptionOf(""), "a.lcmlog"), 1);
  EXPECT_EQ(CommandDelayTicks(DescriptionOf("plant = 3\n"), "a.lcmlog"), 1);
  EXPECT_EQ(CommandDelayTicks(DescriptionOf("[plant]\ncommand_delay_ticks = 0\n"), "a.lcmlog"), 0);
  for (const char* delay : {"2", "0.5", "\"1\"", "[1]", "nan"}) {
    EXPECT_THAT(log::InputErrorOf([&] {
                  CommandDelayTicks(DescriptionOf("[plant]\ncommand_delay_ticks = " + std::string(delay)),
                                    "a.lcmlog");
                }),
                HasSubstr("a.lcmlog: run description: configuration:2: plant.command_delay_ticks: found"));
  }
  EXPECT_EQ(ModelName(DescriptionOf("", "name = \"Table 1\"\n"), "a.lcmlog"), "Table 1");
  EXPECT_EQ(ModelName(DescriptionOf("", "name = 3\n"), "a.lcmlog"), "");
}

// Tests that no text in a log exhausts the stack: it is refused with one line that names the log and the
// place.
TEST(RunConfigTest, HostileTexts) {
  for (const size_t size : {20'000, 100'000}) {
    std::string deep = "a";
    for (size_t i = 1; i < size; ++i) deep += ".a";
    for (const std::string& text :
         {deep + " = 1\n", "[" + deep + "]\n", "[[" + deep + "]]\n", "x = {" + deep + " = 1}\n",
          "x = " + std::string(size, '['), "x = " + std::string(size, '[') + std::string(size, ']')}) {
      const run_description_t description = DescriptionOf(text, text);
      const std::string entries = log::InputErrorOf([&] { ConfigEntries(description, "a.lcmlog"); });
      EXPECT_THAT(entries, HasSubstr("a.lcmlog: run description: configuration:1: syntax: found a "));
      EXPECT_EQ(entries.find('\n'), std::string::npos);
      EXPECT_EQ(log::InputErrorOf([&] { CommandDelayTicks(description, "a.lcmlog"); }), entries);
      EXPECT_THAT(log::InputErrorOf([&] { ModelName(description, "a.lcmlog"); }),
                  HasSubstr("a.lcmlog: run description: model:1: syntax: found a "));
    }
  }
}

}  // namespace
}  // namespace hydro::runs
