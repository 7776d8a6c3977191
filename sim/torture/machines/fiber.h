// A function with a stack of its own that can stop in its middle and go on later: how several blocking loops
// (PlantApp::Run(), process::RunApp()) take turns on one thread.
#pragma once

#include <boost/context/fiber.hpp>
#include <functional>

namespace hydro::torture {

class Fiber {
 public:
  // `body` runs from the first Resume() on. It must not let an exception out.
  explicit Fiber(std::function<void()> body);
  // Unwinds the body if it has not returned; prefer to let it end.
  ~Fiber() = default;
  Fiber(const Fiber&) = delete;
  Fiber& operator=(const Fiber&) = delete;

  // Runs the body until it calls Suspend() or returns. Called from outside.
  void Resume();

  // Returns to the caller of Resume(). Called by the body, also from within a catch block.
  void Suspend();

  bool done() const { return done_; }

 private:
  // What the C++ runtime knows of the exceptions that a thread is handling: each fiber has its own.
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
