// The example of a board whose sketch speaks lines of text, with a pseudo terminal in place of its port and
// this test in place of the sketch. (e2e.own_driver runs the sketch itself.)
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>

#include "examples/own_driver/serial_board/board.h"
#include "tests/plant/front_end/pseudo_terminal.h"

namespace serial_board {
namespace {

using hydro::plant::DeviceError;
using hydro::plant::DeviceReadings;
using hydro::plant::PseudoTerminal;
using std::chrono::milliseconds;
using ::testing::HasSubstr;

std::string Written(double volts) {
  const Command command = CommandFor(volts);
  return {command.text, command.size};
}

// Tests that a command is what the sketch's strtof() reads as that voltage, to the millivolt.
TEST(SerialBoardLinesTest, Commands) {
  EXPECT_EQ(Written(0), "V000.000\n");
  EXPECT_EQ(Written(1.2344), "V001.234\n");
  EXPECT_EQ(Written(-0.0007), "V-000.001\n");
  EXPECT_EQ(Written(-9.9996), "V-010.000\n");
  for (int i = -10000; i <= 10000; i += 7)
    ASSERT_EQ(std::stod(Written(1e-3 * i).substr(1)), std::stod(std::to_string(1e-3 * i)));
}

// Tests that only a whole answer within the converters' range says anything.
TEST(SerialBoardLinesTest, Answers) {
  const auto answer = AnswerIn("2048,0,65535,7,-123456\r");
  ASSERT_TRUE(answer);
  EXPECT_THAT(answer->inputs, ::testing::ElementsAre(2048, 0, 65535, 7));
  EXPECT_EQ(answer->count, -123456);
  for (const char* line : {"", "\r", ",,,,", "2048,0,4095,7", "2048,0,4095,7,", "2048,0,4095,7,1,",
                           "48,0,65536,7,1", "1,2,-3,4,5", "1,2,3,4,2147483648", "1,2,3,4,5 ", "1,2,3,4,5x",
                           "1;2,3,4,5", "1,2,3,4,nan", " 1,2,3,4,5", "1,2,3,4,5\r\r"})
    EXPECT_FALSE(AnswerIn(line)) << line;
}

class SerialBoardTest : public ::testing::Test {
 protected:
  // What the driver has written, once `count` bytes of it are there.
  std::string Heard(size_t count) {
    std::string text;
    for (int i = 0; i < 5000 && text.size() < count; ++i) {
      const auto bytes = terminal_.Receive();
      text.append(bytes.begin(), bytes.end());
      if (text.size() < count) std::this_thread::sleep_for(milliseconds(1));
    }
    return text;
  }
  void Say(const std::string& text) { terminal_.Send({text.begin(), text.end()}); }

  // The board has already answered what its driver asks first.
  std::unique_ptr<SerialBoard> Open(bool drives = true) {
    std::string todo;
    const int port = OpenPort(terminal_.path(), *RateOf(2000000), &todo);
    if (port < 0) throw std::runtime_error(todo);
    Say("9000,9000,9000,32768,0\r\n");
    auto board = std::make_unique<SerialBoard>(port, "board", clock_, drives, milliseconds(10000));
    EXPECT_EQ(Heard(9), "V000.000\n");
    return board;
  }

  DeviceReadings Read(SerialBoard& board) {
    DeviceReadings readings;
    readings.inputs.resize(board.Describe().inputs.size());
    board.Read(readings);
    return readings;
  }

  PseudoTerminal terminal_;
  hydro::bus::WallClock clock_;
};

// Tests what an answer becomes, and that one of which a piece is missing or too much leaves the readings as
// they were.
TEST_F(SerialBoardTest, Reads) {
  auto board = Open();
  board->Drive(1.5);
  EXPECT_EQ(Heard(9), "V001.500\n");
  const auto asked = clock_.Now();
  Say("100,200,300,37683,-5\r\n");
  const DeviceReadings readings = Read(*board);
  EXPECT_EQ(readings.inputs[0].value, 100);
  EXPECT_EQ(readings.inputs[2].value, 300);
  EXPECT_EQ(readings.inputs[3].value, 4294967291.0);
  EXPECT_NEAR(readings.output.value, 1.5, 0.003);
  EXPECT_LE(readings.inputs[0].at, asked) << "as old as its command";
  Say("1,200,300,20\r\n" + std::string(600, '1') + "\n5,5,5,");
  EXPECT_EQ(Read(*board).inputs[0].value, 100);
  Say("2048,5\n");
  EXPECT_EQ(Read(*board).inputs[0].value, 5) << "the rest of a line may come later";
}

// Tests that a board that is slow is not asked again before it has answered or 5 ms have passed, and that a
// zero does not wait.
TEST_F(SerialBoardTest, NeverMoreThanOneQuestion) {
  auto board = Open();
  board->Drive(1);
  EXPECT_EQ(Heard(9), "V001.000\n");
  const auto begin = clock_.Now();
  board->Drive(2);
  if (clock_.Now() - begin < milliseconds(4)) {
    EXPECT_EQ(terminal_.Receive().size(), 0U);
  }
  EXPECT_TRUE(board->Zero(0));
  EXPECT_EQ(Heard(9), "V000.000\n");
  std::this_thread::sleep_for(milliseconds(6));
  board->Drive(3);
  EXPECT_EQ(Heard(9), "V003.000\n");
  Say("9000,9000,9000,32768,0\r\n");
  board->Drive(4);
  EXPECT_EQ(Heard(9), "V004.000\n");
}

// Tests that --check-sensors makes the board speak, and asks for nothing but zero.
TEST_F(SerialBoardTest, CheckSensorsAsksForZero) {
  auto board = Open(false);
  Read(*board);
  EXPECT_EQ(Heard(9), "V000.000\n");
}

// Tests that a cable that is pulled ends the run by a DeviceError at the next command.
TEST_F(SerialBoardTest, Unplugged) {
  auto board = Open();
  terminal_.Unplug();
  const auto drive_on = [&] {
    for (int i = 0; i < 100; ++i) {
      board->Drive(1);
      std::this_thread::sleep_for(milliseconds(1));
    }
  };
  EXPECT_THROW(drive_on(), DeviceError);
}

// Tests what is said of a board with another sketch.
TEST_F(SerialBoardTest, NobodyAnswers) {
  std::string todo;
  const int port = OpenPort(terminal_.path(), *RateOf(115200), &todo);
  ASSERT_GE(port, 0);
  Say("Hello, world!\n");
  try {
    SerialBoard board(port, "board", clock_, true, milliseconds(20));
    FAIL() << "nothing thrown";
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has not answered within 20 ms (driver.own.answer_ms)"));
  }
}

// Tests that each says what to do, and that only rates of the list are allowed.
TEST_F(SerialBoardTest, PortsThatCannotBeOpened) {
  std::string todo;
  EXPECT_EQ(OpenPort("/nowhere", *RateOf(115200), &todo), -1);
  EXPECT_THAT(todo, HasSubstr("is the board plugged in?"));
  EXPECT_EQ(OpenPort("/dev/null", *RateOf(115200), &todo), -1);
  EXPECT_EQ(todo, "a serial port");
  const auto board = Open();
  EXPECT_EQ(OpenPort(terminal_.path(), *RateOf(115200), &todo), -1);
  EXPECT_THAT(todo, HasSubstr("no other program"));
  EXPECT_FALSE(RateOf(123456));
  EXPECT_THAT(AllowedRates(), HasSubstr("115200, 230400"));
}

}  // namespace
}  // namespace serial_board
