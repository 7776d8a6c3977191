#include "settings/scope_section.h"

#include <gtest/gtest.h>

#include "base/input_error.h"

namespace hydro::settings {
namespace {

ScopeSection Read(const std::string& text) { return ScopeSectionOf(text, "test.toml"); }

// Tests the defaults: this machine alone, read-only.
TEST(ScopeSectionTest, Defaults) {
  const ScopeSection scope = Read("[plant]\nrate_hz = 1000\n");
  EXPECT_EQ(scope.port, 8765);
  EXPECT_EQ(scope.bind, "127.0.0.1");
  EXPECT_FALSE(scope.control);
  EXPECT_EQ(scope.history_s, 120);
  EXPECT_EQ(scope.upload_mb, 512);
  EXPECT_TRUE(scope.hosts.empty());
  EXPECT_TRUE(scope.origins.empty());
}

// Tests that every key is read.
TEST(ScopeSectionTest, EveryKey) {
  const ScopeSection scope = Read(
      "[scope]\nport = 0\nbind = \"::1\"\ncontrol = true\nhistory_s = 600\nupload_mb = 10\n"
      "hosts = [\"rig.lab\", \"rig.lab:8443\"]\norigins = [\"https://rig.lab\"]\n");
  EXPECT_EQ(scope.port, 0);
  EXPECT_EQ(scope.bind, "::1");
  EXPECT_TRUE(scope.control);
  EXPECT_EQ(scope.history_s, 600);
  EXPECT_EQ(scope.upload_mb, 10);
  EXPECT_EQ(scope.hosts, (std::vector<std::string>{"rig.lab", "rig.lab:8443"}));
  EXPECT_EQ(scope.origins, std::vector<std::string>{"https://rig.lab"});
}

// Tests that what is wrong is named with its line, and what is allowed.
TEST(ScopeSectionTest, RefusesNonsense) {
  for (const char* line :
       {"port = -1", "port = 65536", "port = 1.5", "bind = 5", "control = 1", "history_s = 0",
        "history_s = 4000", "upload_mb = 0", "hosts = \"rig.lab\"", "hosts = [\"http://rig.lab\"]",
        "hosts = [\"a, b\"]", "hosts = [\"\"]", "origins = [\"rig.lab\"]", "origins = [\"https://rig.lab/\"]",
        "origins = [\"*\"]", "token = \"x\""}) {
    try {
      Read(std::string("[scope]\n") + line + "\n");
      ADD_FAILURE() << line;
    } catch (const InputError& error) {
      const std::string text = error.what();
      EXPECT_TRUE(text.starts_with("test.toml:2: scope")) << text;
    }
  }
}

}  // namespace
}  // namespace hydro::settings
