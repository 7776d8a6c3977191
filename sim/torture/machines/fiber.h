// A function with a stack of its own that can stop in the middle and continue later. It lets several blocking
// loops (PlantApp::Run(), process::RunApp()) take turns on one thread.
#pragma once

#include <boost/context/fiber.hpp>
#include <functional>

namespace hydro::torture {

class Fiber {
 public:
  // `body` runs from the first Resume() on. It must not let an exception out.
  explicit Fiber(std::function<void()> body);
  // Unwinds the body if it has not returned. It is better to let the body end.
  ~Fiber() = default;
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  // Runs the body until it calls Suspend() or returns. Called from outside.
  void Resume();

  // Returns to the caller of Resume(). Called by the body, also from within a catch block.
  void Suspend();

  bool done() const { return done_; }

 private:
  // The C++ runtime's record of the exceptions that a thread is handling. Each fiber has its own.
  struct ExceptionState {
    void* caught = nullptr;
    unsigned int uncaught = 0;
  };
  static void Swap(ExceptionState* state);

  std::function<void()> body_;
  bool done_ = false;
  ExceptionState exceptions_;
  boost::context::fiber outside_;
  boost::context::fiber inside_;
};

}  // namespace hydro::torture
