#include "base/standard_output.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <memory>

#include "base/new_file.h"

namespace hydro {
namespace {

// Tests that `-` is checked and written without a file of that name, and that what else is said goes
// elsewhere.
TEST(StandardOutputTest, TakesTheText) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::tmpfile(), std::fclose);
  CheckCanBeWritten("-");
  WriteTextFile("-", "text\n", out.get());
  std::rewind(out.get());
  char text[16] = {};
  EXPECT_EQ(std::fread(text, 1, sizeof text, out.get()), 5u);
  EXPECT_STREQ(text, "text\n");
  EXPECT_FALSE(std::filesystem::exists("-"));
  EXPECT_EQ(OutputBeside({"a.json", "-"}, out.get(), stderr), stderr);
  EXPECT_EQ(OutputBeside({"a.json", ""}, out.get(), stderr), out.get());
}

// Tests that an output that takes nothing is an error.
TEST(StandardOutputTest, Full) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> full(std::fopen("/dev/full", "w"), std::fclose);
  EXPECT_THROW(WriteTextFile("-", "text", full.get()), WriteError);
}

}  // namespace
}  // namespace hydro
