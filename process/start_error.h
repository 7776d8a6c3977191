#pragma once

#include <stdexcept>

namespace hydro::process {

// A program could not be started; what() is one line.
class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hydro::process
