// The texts of lcmtypes/*.lcm, which the build compiles into the program.
#pragma once

#include <string_view>
#include <vector>

namespace hydro::definitions {

struct DefinitionText {
  std::string_view file;  // "hydro_state_t.lcm"
  std::string_view text;
};

const std::vector<DefinitionText>& DefinitionTexts();

}  // namespace hydro::definitions
