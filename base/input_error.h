// Reports bad usage, configuration or input: exit code 2 and one line.
#pragma once

#include <stdexcept>

namespace hydro {

// what() is that line: file, line or key, what was found, what is allowed.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hydro
