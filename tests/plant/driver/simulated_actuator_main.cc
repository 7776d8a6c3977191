// simulated_actuator FILE MODEL.toml: the rig behind a SimulatedBoard, an actuator that moves in its own
// time. Makes FILE, says "ready" and runs until a signal ends it. Does what hydro-driver-check orders on
// standard input (plant/driver/simulated_device.h), as far as a board can: one that is silent refuses
// readings.
//
// How it is wired (the configuration under test must find the scales by itself):
//   analog input 0, 1   p1, p2: transducers of 0 to 2000 psi that give 0.5 to 4.5 V
//   analog input 2      the motor's tachometer, its wires crossed: -0.01 V per rad/s
//   analog input 3      the arm's potentiometer: 2.5 V at mid-stroke, 5 V per rad
//   counter 0           the motor's encoder, 4096 counts a turn, just below its wrap at the start
//   analog output 0     the amplifier, inverting: -2 V of eq. (1) per V
//   line 0              the watchdog: without a change for 0.5 s it keeps the voltage from the motor
#include <linux/futex.h>
#include <poll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>
#include <string>
#include <utility>

#include "model/actuator.h"
#include "settings/model_file.h"
#include "tests/plant/driver/simulated_board.h"

namespace {

using hydro::testing::SimulatedBoard;

constexpr double kWatchdogTime = 0.5;  // s
constexpr int64_t kLag = 5000000;      // ns, so that a question on its way does not come too late
constexpr double kCountsPerRad = 4096 / (2 * std::numbers::pi);
constexpr int64_t kFirstCount = SimulatedBoard::kMaxCount - 20;

// Of the clock that the driver's requests are stamped with.
int64_t Now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return int64_t{now.tv_sec} * 1000000000 + now.tv_nsec;
}

int64_t Code(double volts) {
  return std::llround(std::clamp((volts + 10) / 20, 0.0, 1.0) * SimulatedBoard::kMaxCode);
}

double Volts(int64_t code) { return 20 * static_cast<double>(code) / SimulatedBoard::kMaxCode - 10; }

// What a checker asks, a word a line, looked for between two requests of the driver.
class Orders {
 public:
  explicit Orders(SimulatedBoard& board) : board_(board) {}

  bool slow() const { return slow_; }

  void Look() {
    pollfd waits{.fd = open_ ? STDIN_FILENO : -1, .events = POLLIN, .revents = 0};
    if (poll(&waits, 1, 0) <= 0) return;
    char text[256];
    const ssize_t got = read(STDIN_FILENO, text, sizeof text);
    open_ = got > 0;
    for (ssize_t i = 0; i < got; ++i) {
      if (text[i] == '\n') {
        Obey(std::exchange(line_, ""));
      } else {
        line_ += text[i];
      }
    }
  }

 private:
  void Obey(const std::string& word) {
    static constexpr std::pair<const char*, int64_t> kOrders[] = {{"none", SimulatedBoard::kNothing},
                                                                  {"silent", SimulatedBoard::kReadsFail},
                                                                  {"nan", SimulatedBoard::kInput0High},
                                                                  {"lies", SimulatedBoard::kOutputLies},
                                                                  {"slow", SimulatedBoard::kNothing}};
    std::string answer = "no";
    if (word == "output") answer = "output " + std::to_string(board_.voltage);
    for (const auto& [name, order] : kOrders) {
      if (word != name) continue;
      board_.order = order;
      slow_ = word == "slow";
      answer = "ok";
    }
    std::puts(answer.c_str());
    std::fflush(stdout);
  }

  SimulatedBoard& board_;
  bool open_ = true;
  bool slow_ = false;
  std::string line_;
};

class Rig {
 public:
  Rig(SimulatedBoard& board, const hydro::model::ModelDescription& model)
      : board_(board), actuator_(model, {}) {
    Show();
  }

  // Lets the actuator move until `time`, under the voltage that is put out now; what the driver has changed
  // since the last call has acted for less than a tick.
  void Run(double time) {
    if (board_.edges != edges_) {
      edges_ = board_.edges;
      last_edge_ = time;
    }
    const bool enabled = edges_ > 0 && time - last_edge_ < kWatchdogTime;
    const bool driven = board_.opened > board_.closed;  // after its end a driver changes the line no more
    if (board_.enabled != 0 && !enabled && driven) ++board_.trips;
    board_.enabled = enabled ? 1 : 0;
    board_.voltage = enabled ? -2 * Volts(board_.outputs[0]) : 0;
    if (time > actuator_.time()) actuator_.Advance(board_.voltage, time);
    Show();
  }

 private:
  void Show() {
    const hydro::model::Measurement measured = actuator_.Measure();
    board_.inputs[0] = Code(0.5 + measured.p1 / 500);
    board_.inputs[1] = Code(0.5 + measured.p2 / 500);
    board_.inputs[2] = Code(-0.01 * measured.motor_speed);
    board_.inputs[3] = Code(2.5 + 5 * measured.arm_angle);
    const int64_t count = kFirstCount + std::llround(std::floor(measured.motor_angle * kCountsPerRad));
    board_.counters[0] = count & SimulatedBoard::kMaxCount;
    board_.time_s = actuator_.time();
    board_.p1 = measured.p1;
    board_.p2 = measured.p2;
    board_.motor_speed = measured.motor_speed;
    board_.arm_angle = measured.arm_angle;
  }

  SimulatedBoard& board_;
  hydro::model::Actuator actuator_;
  int64_t edges_ = 0;
  double last_edge_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: simulated_actuator FILE MODEL.toml\n");
    return 2;
  }
  try {
    const hydro::model::ModelDescription model = hydro::settings::LoadModelFile(argv[2]);
    SimulatedBoard* board = hydro::testing::CreateBoard(argv[1]);
    if (board == nullptr) {
      std::perror(argv[1]);
      return 2;
    }
    Rig rig(*board, model);
    board->attended = 1;
    std::puts("ready");
    std::fflush(stdout);
    Orders orders(*board);
    const int64_t start = Now();
    for (std::atomic_ref<uint32_t> request(board->request), reply(board->reply);;) {
      const uint32_t asked = request.load();
      const bool waits = reply.load() != asked;
      rig.Run(1e-9 * static_cast<double>((waits ? board->asked_ns : Now() - kLag) - start));
      orders.Look();
      if (waits) {
        if (orders.slow()) usleep(20000);
        reply.store(asked);
        syscall(SYS_futex, &board->reply, FUTEX_WAKE, 1, nullptr, nullptr, 0);
      }
      const timespec millisecond{0, 1000000};
      syscall(SYS_futex, &board->request, FUTEX_WAIT, asked, &millisecond, nullptr, 0);
      if (getppid() == 1) return 0;  // the test has gone
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "simulated_actuator: %s\n", error.what());
    return 1;
  }
}
