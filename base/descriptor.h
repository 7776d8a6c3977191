// A file descriptor that is closed at the end of its scope.
#pragma once

#include <unistd.h>

#include <utility>

namespace hydro {

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}  // negative: there is none, as open() says it
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int number() const { return number_; }
  // Closes it now, and returns whether that succeeded: a shared file system may report only here that its
  // disk is full.
  bool Close() { return close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

}  // namespace hydro
