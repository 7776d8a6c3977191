// The libcomedi C functions that the driver calls, on a SimulatedBoard: linked into unit tests, or loaded
// before the real libcomedi (LD_PRELOAD) by end-to-end tests.
#include <comedilib.h>
#include <fcntl.h>
#include <linux/futex.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <stdexcept>

#include "tests/plant/driver/simulated_board.h"

using hydro::testing::SimulatedBoard;

struct comedi_t_struct {
  SimulatedBoard* board;
  int fd;
};

namespace hydro::testing {

SimulatedBoard* MapBoard(const char* file, int* fd) {
  *fd = open(file, O_RDWR | O_CLOEXEC);
  if (*fd < 0) return nullptr;
  void* memory = mmap(nullptr, sizeof(SimulatedBoard), PROT_READ | PROT_WRITE, MAP_SHARED, *fd, 0);
  auto* board = static_cast<SimulatedBoard*>(memory);
  const bool whole = lseek(*fd, 0, SEEK_END) == static_cast<off_t>(sizeof(SimulatedBoard));
  if (memory == MAP_FAILED || !whole || board->magic != SimulatedBoard::kMagic) {
    close(*fd);
    errno = ENODEV;
    return nullptr;
  }
  return board;
}

SimulatedBoard* CreateBoard(const char* file) {
  SimulatedBoard board;
  for (int64_t& code : board.inputs) code = SimulatedBoard::kZeroCode;
  for (int64_t& code : board.outputs) code = 50000;
  int fd = open(file, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  const bool written = fd >= 0 && write(fd, &board, sizeof board) == static_cast<ssize_t>(sizeof board);
  if (fd >= 0) close(fd);
  return written ? MapBoard(file, &fd) : nullptr;
}

}  // namespace hydro::testing

namespace {

constexpr int kTypes[] = {COMEDI_SUBD_AI, COMEDI_SUBD_AO, COMEDI_SUBD_DIO, COMEDI_SUBD_COUNTER};
constexpr int kChannels[] = {SimulatedBoard::kInputs, SimulatedBoard::kOutputs, SimulatedBoard::kLines,
                             SimulatedBoard::kCounters};
constexpr int kSubdevices = 4;
comedi_range ranges[] = {{-10, 10, UNIT_volt}, {-5, 5, UNIT_volt}, {0, 10, UNIT_volt}};
constexpr int kRanges[] = {3, 2, 1, 1};

int error = 0;

int Fail(int number) {
  error = number;
  return -1;
}

bool Known(comedi_t* device, unsigned subdevice, unsigned channel) {
  return device != nullptr && subdevice < kSubdevices &&
         channel < static_cast<unsigned>(kChannels[subdevice]);
}

int64_t SteadyTime() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return int64_t{now.tv_sec} * 1000000000 + now.tv_nsec;
}

// Asks the process behind the board for its registers at this moment, however late it gets to answer.
void Ring(SimulatedBoard& board) {
  if (board.attended == 0) return;
  std::atomic_ref<uint32_t> request(board.request);
  std::atomic_ref<uint32_t> reply(board.reply);
  board.asked_ns = SteadyTime();
  const uint32_t mine = request.fetch_add(1) + 1;
  syscall(SYS_futex, &board.request, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
  for (int tries = 0; tries < 10; ++tries) {
    const uint32_t seen = reply.load();
    if (static_cast<int32_t>(seen - mine) >= 0) return;
    const timespec patience{0, 100000000};
    syscall(SYS_futex, &board.reply, FUTEX_WAIT, seen, &patience, nullptr, 0);
  }
}

[[gnu::noinline]] int64_t Deeper(int64_t levels) {
  volatile char frame[4096];
  frame[0] = static_cast<char>(levels);
  return levels == 0 ? 0 : Deeper(levels - 1) + frame[0];
}

void Obey(SimulatedBoard& board) {
  const int64_t order = board.order;
  if (order <= SimulatedBoard::kLastToStay) return;
  board.order = SimulatedBoard::kNothing;
  switch (order) {
    case SimulatedBoard::kThrow:
      throw std::runtime_error("thrown by the simulated board");
    case SimulatedBoard::kThrowNumber:
      throw 1;
    case SimulatedBoard::kTerminate:
      std::terminate();
    case SimulatedBoard::kExit:
      std::exit(3);
    case SimulatedBoard::kQuickExit:
      std::quick_exit(3);
    case SimulatedBoard::kUnderscoreExit:
      _exit(3);
    case SimulatedBoard::kAbort:
      std::abort();
    case SimulatedBoard::kNullPointer:
      *static_cast<volatile int*>(nullptr) = 1;
      return;
    case SimulatedBoard::kStackOverflow:
      board.order = SimulatedBoard::kNothing + Deeper(int64_t{1} << 40);
      return;
    default:
      return;
  }
}

bool Interrupted(const SimulatedBoard& board) {
  static bool last = false;
  last = board.order == SimulatedBoard::kInterrupt && !last;
  return last;
}

int Read(comedi_t* device, unsigned subdevice, unsigned channel, lsampl_t* data) {
  if (!Known(device, subdevice, channel)) return Fail(EINVAL);
  SimulatedBoard& board = *device->board;
  Obey(board);
  if (board.order == SimulatedBoard::kReadsFail) return Fail(EIO);
  if (Interrupted(board)) return Fail(EINTR);
  // One request for all analog inputs, as in a scan, and one for each counter; an output is a register.
  static unsigned first_input = SimulatedBoard::kInputs;
  if (subdevice == 0 && first_input == SimulatedBoard::kInputs) first_input = channel;
  if (subdevice == 3 || (subdevice == 0 && channel == first_input)) Ring(board);
  ++board.reads;
  if (subdevice == 3) {
    *data = static_cast<lsampl_t>(board.counters[channel]);
  } else if (subdevice == 0) {
    int64_t code = board.inputs[channel];
    if (channel == 0 && board.order == SimulatedBoard::kInput0High) code = SimulatedBoard::kMaxCode;
    if (channel == 0 && board.order == SimulatedBoard::kInput0Open) code = SimulatedBoard::kZeroCode;
    *data = static_cast<lsampl_t>(code);
  } else if (subdevice == 1) {
    const bool lies = board.order == SimulatedBoard::kOutputLies;
    *data = static_cast<lsampl_t>(lies ? SimulatedBoard::kMaxCode : board.outputs[channel]);
  } else {
    return Fail(EINVAL);
  }
  return 1;
}

}  // namespace

extern "C" {

comedi_t* comedi_open(const char* file) {
  int fd = -1;
  SimulatedBoard* board = hydro::testing::MapBoard(file, &fd);
  if (board == nullptr) {
    error = errno;
    return nullptr;
  }
  ++board->opened;
  return new comedi_t_struct{board, fd};
}

int comedi_close(comedi_t* device) {
  ++device->board->closed;
  munmap(device->board, sizeof(SimulatedBoard));
  close(device->fd);
  delete device;
  return 0;
}

int comedi_errno() { return error; }
const char* comedi_strerror(int number) { return std::strerror(number); }
int comedi_fileno(comedi_t* device) { return device->fd; }
const char* comedi_get_board_name(comedi_t*) { return "simulated"; }
int comedi_get_n_subdevices(comedi_t*) { return kSubdevices; }
int comedi_get_subdevice_type(comedi_t*, unsigned subdevice) {
  return subdevice < kSubdevices ? kTypes[subdevice] : Fail(EINVAL);
}
int comedi_get_n_channels(comedi_t*, unsigned subdevice) {
  return subdevice < kSubdevices ? kChannels[subdevice] : Fail(EINVAL);
}
lsampl_t comedi_get_maxdata(comedi_t* device, unsigned subdevice, unsigned channel) {
  if (!Known(device, subdevice, channel)) return 0;
  const int64_t most[] = {SimulatedBoard::kMaxCode, SimulatedBoard::kMaxCode, 1, SimulatedBoard::kMaxCount};
  return static_cast<lsampl_t>(most[subdevice]);
}
int comedi_get_n_ranges(comedi_t* device, unsigned subdevice, unsigned channel) {
  return Known(device, subdevice, channel) ? kRanges[subdevice] : Fail(EINVAL);
}
comedi_range* comedi_get_range(comedi_t* device, unsigned subdevice, unsigned channel, unsigned range) {
  const bool known = Known(device, subdevice, channel) && range < static_cast<unsigned>(kRanges[subdevice]);
  return known ? &ranges[range] : nullptr;
}

int comedi_data_read(comedi_t* device, unsigned subdevice, unsigned channel, unsigned /*range*/,
                     unsigned /*reference*/, lsampl_t* data) {
  return Read(device, subdevice, channel, data);
}

int comedi_data_read_delayed(comedi_t* device, unsigned subdevice, unsigned channel, unsigned /*range*/,
                             unsigned /*reference*/, lsampl_t* data, unsigned /*ns*/) {
  if (device != nullptr) ++device->board->delayed_reads;
  return Read(device, subdevice, channel, data);
}

int comedi_data_write(comedi_t* device, unsigned subdevice, unsigned channel, unsigned /*range*/,
                      unsigned /*reference*/, lsampl_t data) {
  if (!Known(device, subdevice, channel) || subdevice != 1) return Fail(EINVAL);
  SimulatedBoard& board = *device->board;
  ++board.writes;
  if (board.order == SimulatedBoard::kWritesFail) return Fail(EIO);
  if (board.order == SimulatedBoard::kNextWriteFails) {
    board.order = SimulatedBoard::kNothing;
    return Fail(EIO);
  }
  if (Interrupted(board)) return Fail(EINTR);
  board.outputs[channel] = data;
  if (data != SimulatedBoard::kZeroCode) ++board.nonzero_writes;
  return 1;
}

int comedi_dio_config(comedi_t* device, unsigned subdevice, unsigned channel, unsigned direction) {
  if (!Known(device, subdevice, channel) || subdevice != 2) return Fail(EINVAL);
  if (direction == COMEDI_OUTPUT) device->board->directions |= int64_t{1} << channel;
  return 0;
}

int comedi_dio_write(comedi_t* device, unsigned subdevice, unsigned channel, unsigned bit) {
  if (!Known(device, subdevice, channel) || subdevice != 2) return Fail(EINVAL);
  SimulatedBoard& board = *device->board;
  if (board.order == SimulatedBoard::kWritesFail) return Fail(EIO);
  ++board.line_writes;
  const int64_t before = board.lines;
  board.lines = (before & ~(int64_t{1} << channel)) | (int64_t{bit != 0} << channel);
  if ((board.lines ^ before) & 1) ++board.edges;
  return 1;
}

}  // extern "C"
