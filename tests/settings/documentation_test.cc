#include <sstream>

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

std::string Documentation() {
  std::ifstream stream(std::filesystem::path(HYDRO_SOURCE_DIR) / "docs" / "configuration.md");
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

// The text under the heading "## `[section]`" of docs/configuration.md.
std::string Chapter(const std::string& heading) {
  const std::string text = Documentation();
  const size_t begin = text.find("## `" + heading + "`");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find("\n## ", begin + 1) - begin);
}

// The keys listed in the message about an unknown key.
std::vector<std::string> Allowed(const std::string& error) {
  std::vector<std::string> keys;
  const size_t begin = error.find("allowed ");
  const size_t end = error.find(", did you mean");
  if (begin == std::string::npos) return keys;
  for (size_t quote = error.find('"', begin); quote < end;) {
    const size_t close = error.find('"', quote + 1);
    keys.push_back(error.substr(quote + 1, close - quote - 1));
    quote = error.find('"', close + 1);
  }
  return keys;
}

void ExpectDocumented(const std::string& heading, const std::string& config, size_t least) {
  const std::string chapter = Chapter(heading);
  ASSERT_NE(chapter, "") << "docs/configuration.md has no heading for " << heading;
  const std::vector<std::string> keys = Allowed(InputErrorOf([&] { Parsed(config); }));
  EXPECT_GE(keys.size(), least) << config;
  for (const std::string& key : keys) {
    EXPECT_NE(chapter.find("`" + key + "`"), std::string::npos) << heading << " does not mention " << key;
  }
}

const char kDriverSensors[] = R"(
[driver.p1]
source = "analog"
subdevice = 0
channel = 0
scale = 1
[driver.p2]
source = "analog"
subdevice = 0
channel = 1
scale = 1
[driver.motor_speed]
source = "analog"
subdevice = 0
channel = 2
scale = 1
[driver.arm_angle]
source = "analog"
subdevice = 0
channel = 3
scale = 1
)";

// Tests that every section and every key that the reader accepts is in docs/configuration.md.
TEST(DocumentationTest, MentionsEveryKey) {
  for (const std::string& section : Allowed(InputErrorOf([] { Parsed("zzz = 1\n"); }))) {
    if (section == "process") continue;
    ExpectDocumented("[" + section + "]", "[" + section + "]\nzzz = 1\n", 1);
  }
  ExpectDocumented("[[process]]", std::string(kConfigText) + "[[process]]\nzzz = 1\n", 4);
  ExpectDocumented("[driver]", std::string(kDriverSensors) + "[driver.voltage]\nzzz = 1\n", 7);
  for (const char* part :
       {"[driver.watchdog]\nzzz = 1\n", "[driver.motor_angle]\nsource = \"counter\"\nzzz = 1\n",
        "[driver.motor_angle]\nsource = \"analog\"\nzzz = 1\n",
        "[driver.arm_speed]\nsource = \"derivative\"\nzzz = 1\n"}) {
    const std::string amplifier = "[driver.voltage]\nsubdevice = 1\nchannel = 0\nscale = 1\n";
    ExpectDocumented("[driver]", kDriverSensors + amplifier + part, 2);
  }
  ExpectDocumented("[pressure]", "[pressure]\nzzz = 1\n", 8);
  for (const char* kind : {"steps", "sine", "square", "chirp", "csv"}) {
    ExpectDocumented("[reference]", std::string("[reference]\nkind = \"") + kind + "\"\nzzz = 1\n", 4);
  }
}

}  // namespace
}  // namespace hydro::settings
