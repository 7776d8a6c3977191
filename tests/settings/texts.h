// A valid configuration and model that the tests of this folder change.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "settings/model_file.h"
#include "settings/stack_config.h"

namespace hydro {

inline const char kModelText[] = R"(name = "Table 1"
[parameters]
k_1 = 4.0
T_pmax = 40.0
D = 0.00796
J = 0.03
b = 0.01455
T_s = 4.0
f = 0.0
beta = 247000
V_ms = 3.16
r = 1.83
d = 2.20
c_E = 6.5e-6
c_I = 1.0e-6
p_3 = 100.0
k_2 = 3.68
J_a = 23.3
mgl = 0.0
)";

inline const char kConfigText[] = R"([model]
file = "model.toml"
[plant]
rate_hz = 1000
[pressure]
natural_frequency_rad_s = 150
damping_ratio = 0.5
[position]
c1 = 10500
c2 = 350
[reference]
signal = "arm_angle"
kind = "steps"
steps = [[0.1, 0.1]]
)";

inline StackConfig Parsed(const std::string& config, const std::string& model = kModelText) {
  return ParseStackConfig(config, "stack.toml", model, "model.toml");
}

// What InputError says, or "" when nothing was thrown. Anything else that is thrown fails the test.
template <class Body>
std::string InputErrorOf(const Body& body) {
  try {
    body();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline std::string Replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "nothing to replace: " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// A folder of its own for each test, gone afterwards.
class FolderTest : public ::testing::Test {
 protected:
  FolderTest() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ =
        std::filesystem::temp_directory_path() / (std::string("hydro_") + info->test_suite_name() + "_" +
                                                  info->name() + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  ~FolderTest() override { std::filesystem::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = folder_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file.string();
  }

  std::filesystem::path folder_;
};

}  // namespace hydro
