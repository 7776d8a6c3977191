// RunProgram() of command_line.h: what must hold for every process before it starts its work, and how it
// ends.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <system_error>

#include "base/input_error.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "settings/command_line.h"

namespace hydro::settings {
namespace {

constexpr size_t kStack = size_t{512} << 10;  // bytes, more than any program's main thread uses

[[gnu::noinline]] void TouchStack() {
  constexpr size_t kPage = 4096;
  volatile char stack[kStack - (size_t{64} << 10)];
  for (size_t i = 0; i < sizeof stack; i += kPage) stack[sizeof stack - 1 - i] = 0;
}

// Under a memory limit (ulimit -v), a process whose stack cannot grow ends without a message. So the stack
// grows before the rest of the memory is used up.
void ReserveStack() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return;
  void* const room = mmap(nullptr, kStack, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (room == MAP_FAILED) throw std::bad_alloc();
  munmap(room, kStack);
  TouchStack();
}

// Opens those of the descriptors 0 to 2 that were closed at the start (`1>&-`), so that no file, socket or
// signalfd can get a number to which printf() writes. Each is opened for the opposite of its use, so that
// using it still fails with EBADF.
void OpenStandardDescriptors() {
  for (const int standard : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(standard, F_GETFD) >= 0 || errno != EBADF) continue;
    // open() returns the lowest free number, which is this one because those below it are open.
    if (open("/dev/null", standard == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
  }
}

}  // namespace

int RunProgram(const std::string& program, const std::function<int()>& body) {
  OpenStandardDescriptors();
  std::signal(SIGXFSZ,
              SIG_IGN);  // makes a file at its size limit (ulimit -f) an error of write(), like a full disk
  try {
    ReserveStack();
    const int exit_code = body();
    SayRemarks();
    return FinishStandardOutput(program, exit_code);
  } catch (const InputError& error) {
    std::fprintf(stderr, "%s: %s\n", program.c_str(), Printable(error.what()).c_str());
    return 2;
  } catch (const std::bad_alloc&) {
    std::fprintf(
        stderr,
        "%s: out of memory: it needs more than this process may have; a larger limit (ulimit -v) or a "
        "smaller input is needed\n",
        program.c_str());
    return 1;
  } catch (const std::system_error& error) {
    // What a thread that could not be started says.
    const bool resource = error.code() == std::errc::resource_unavailable_try_again;
    std::fprintf(stderr, "%s: %s%s\n", program.c_str(), Printable(error.what()).c_str(),
                 resource ? ": a process or thread that it needs was refused; larger limits (ulimit -v, "
                            "ulimit -u) are needed"
                          : "");
    return 1;
  } catch (const std::exception& error) {
    SayRemarks();
    std::fprintf(stderr, "%s: %s\n", program.c_str(), Printable(error.what()).c_str());
    return 1;
  }
}

}  // namespace hydro::settings
