// The lines that the computer and the sketch exchange. Pure: text in, numbers out.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string_view>

struct Command {
  char text[16];
  size_t size = 0;
};

// "V-1.234\n". A signal handler calls this, so it prints by hand: printf() may allocate.
inline Command CommandFor(double volts) noexcept {
  const long millivolts = std::lround(1000 * volts);
  Command command{.text = {'V'}, .size = 1};
  if (millivolts < 0) command.text[command.size++] = '-';
  const long size = millivolts < 0 ? -millivolts : millivolts;
  for (long unit = 100000; unit > 0; unit /= 10) {
    if (unit == 100) command.text[command.size++] = '.';
    command.text[command.size++] = static_cast<char>('0' + size / unit % 10);
  }
  command.text[command.size++] = '\n';
  return command;
}

struct Answer {
  std::array<int, 4> inputs{};  // of the converters, 0 to 65535
  int32_t count = 0;            // of the encoder
};

// What a line says, without its end. Nothing of a line that is not whole: one without a check sum can be
// wrong in no other way that shows.
inline std::optional<Answer> AnswerIn(std::string_view line) {
  if (line.ends_with('\r')) line.remove_suffix(1);
  Answer answer;
  const char* at = line.data();
  const char* const end = at + line.size();
  for (int& input : answer.inputs) {
    const auto [next, error] = std::from_chars(at, end, input);
    if (error != std::errc() || next == end || *next != ',' || input < 0 || input > 65535)
      return std::nullopt;
    at = next + 1;
  }
  const auto [next, error] = std::from_chars(at, end, answer.count);
  if (error != std::errc() || next != end) return std::nullopt;
  return answer;
}
