// What the tests of logs share: a folder for each test, and a small run.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "base/read_files.h"
#include "bus/channels.h"
#include "hydro/run_description_t.hpp"
#include "runs/log/log_reader.h"
#include "runs/log/log_writer.h"
#include "runs/recorded/run_log.h"
#include "tests/temporary_folder.h"

namespace hydro::log {

// Tests that write logs into a folder of their own, and may write a name again.
class LogTest : public testing::Test {
 protected:
  LogTest() { AllowReplacing(); }  // tests write the same names again and again; new_file_test is about this
  ~LogTest() override { AllowReplacing(false); }

  std::string Path(const std::string& name) const { return folder_ / name; }

 private:
  // In memory where possible: tests write thousands of logs, and each is forced to the disk
  // (base/new_file.h).
  const TemporaryFolder folder_{TemporaryFolder::InMemory()};
};

inline std::string ReadBytes(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void WriteBytes(const std::string& file, const std::string& bytes) {
  // Truncating a file to nothing, or renaming over one, makes ext4 write to the disk at once: slow when done
  // ten thousand times.
  std::filesystem::remove(file);
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << bytes;
}

// The contents of an event, to compare whole logs.
struct EventContents {
  std::string channel;
  std::string data;
  int64_t utime;
  bool operator==(const EventContents&) const = default;
};

inline void PrintTo(const EventContents& event, std::ostream* out) {
  *out << event.channel << " at " << event.utime << " us: " << event.data.size() << " bytes, "
       << event.data.substr(0, 20);
}

inline std::vector<EventContents> ReadEvents(const std::string& file) {
  LogReader reader(file);
  std::vector<EventContents> events;
  LogEvent event;
  while (reader.Next(event)) {
    events.push_back({std::string(event.channel),
                      std::string(reinterpret_cast<const char*>(event.data), static_cast<size_t>(event.size)),
                      event.utime});
  }
  return events;
}

inline void WriteEvents(const std::string& file, const std::vector<EventContents>& events) {
  ForgetRead(file);  // each call stands for another process
  LogWriter writer(file, Opening::kTemporary);
  for (const EventContents& event : events) {
    writer.Append(event.channel, event.data.data(), event.data.size(), event.utime);
  }
  writer.Finish();
}

// As lcm-logger and versions of this project without checksums write them.
inline void WritePlain(const std::string& file, const std::vector<EventContents>& events) {
  std::string bytes;
  for (size_t k = 0; k < events.size(); ++k) {
    uint8_t header[kLogHeaderSize];
    StoreBigEndian32(kLogSyncWord, header);
    StoreBigEndian64(k, header + 4);
    StoreBigEndian64(static_cast<uint64_t>(events[k].utime), header + 12);
    StoreBigEndian32(static_cast<uint32_t>(events[k].channel.size()), header + 20);
    StoreBigEndian32(static_cast<uint32_t>(events[k].data.size()), header + 24);
    bytes.append(reinterpret_cast<const char*>(header), sizeof header);
    bytes += events[k].channel + events[k].data;
  }
  WriteBytes(file, bytes);
}

// The log `file` without its check events.
inline std::string PlainBytes(const std::string& file) {
  WritePlain(file + ".plain", ReadEvents(file));
  return ReadBytes(file + ".plain");
}

// A matcher for the message of the InputError that `work` must throw, at `where`.
template <class Work>
std::string InputErrorOf(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no InputError was thrown";
  return {};
}

// `ticks` ticks of a run at 1 kHz with messages whose fields all have distinct values.
inline runs::RunMessages SampleRun(int64_t ticks) {
  runs::RunMessages run;
  for (int64_t tick = 0; tick < ticks; ++tick) {
    const double x = static_cast<double>(tick);
    state_t state{};
    state.utime = 1000 * tick;
    state.tick = state.sequence = tick;
    state.session = 11;
    state.time = 1e-3 * x;
    state.motor_angle = 0.1 * x;
    state.motor_speed = 100 + 0.1 * x;
    state.arm_angle = 0.01 * x;
    state.arm_speed = 10 - x / 3;
    state.p1 = 100 + x / 7;
    state.p2 = 200 - x / 7;
    state.voltage = tick == 0 ? 0 : -0.5 + x - 1;
    state.command_tick = tick - 1;
    run.Of<state_t>().push_back(state);
    if (tick % 5 == 0) {
      pressure_command_t pressure{};
      pressure.utime = state.utime;
      pressure.tick = tick;
      pressure.sequence = tick / 5;
      pressure.session = 13;
      pressure.pressure_ref = 50 + x;
      run.Of<pressure_command_t>().push_back(pressure);
      arm_reference_t reference{};
      reference.utime = state.utime;
      reference.tick = tick;
      reference.sequence = tick / 5;
      reference.session = 13;
      reference.signal = arm_reference_t::ARM_ANGLE;
      reference.value = 0.2 + x;
      run.Of<arm_reference_t>().push_back(reference);
    }
    motor_command_t command{};
    command.utime = state.utime;
    command.tick = command.sequence = tick;
    command.session = 12;
    command.voltage = -0.5 + x;
    command.pressure_command_tick = tick == 0 ? -1 : (tick - 1) / 5 * 5;
    command.pressure_ref = tick == 0 ? 0 : 50 + static_cast<double>(command.pressure_command_tick);
    run.Of<motor_command_t>().push_back(command);
  }
  fault_t fault{};
  fault.tick = 2;
  fault.session = 12;
  fault.source = "pressure_ctrl";
  fault.code = "stale_state";
  fault.text = "found 0.2 s, 0.1 s is allowed";
  fault.value = 0.2;
  fault.limit = 0.1;
  fault.active = 1;
  run.Of<fault_t>().push_back(fault);
  return run;
}

// Tick by tick, in a plausible order of arrival.
inline void WriteRun(const std::string& file, const runs::RunMessages& run, const std::string& suffix = "",
                     const std::string& config_text = "[plant]\nrate_hz = 1000\n",
                     const std::string& model_text = "name = \"Table 1\"\n",
                     const std::string& program = "hydro-sim") {
  const bus::Channels channels(suffix);
  ForgetRead(file);  // each call stands for another process
  LogWriter writer(file, Opening::kTemporary);
  run_description_t description{};
  description.session = 11;
  description.config_file = "demo.toml";
  description.config_text = config_text;
  description.model_file = "table1.toml";
  description.model_text = model_text;
  description.program = program;
  description.version = "1.2.3";
  description.host = "bench";
  description.rate_hz = 1000;
  description.seed = 7;
  writer.AppendMessage(channels.Of<run_description_t>(), description, 0);
  const auto append_tick = [&writer](const std::string& channel, const auto& messages, int64_t tick) {
    for (const auto& message : messages) {
      if (message.tick == tick) writer.AppendMessage(channel, message, 1000 * tick);
    }
  };
  int64_t last = 0;
  for (const state_t& state : run.Of<state_t>()) last = std::max(last, state.tick);
  for (int64_t tick = -1; tick <= last; ++tick) {
    append_tick(channels.Of<state_t>(), run.Of<state_t>(), tick);
    append_tick(channels.Of<pressure_command_t>(), run.Of<pressure_command_t>(), tick);
    append_tick(channels.Of<arm_reference_t>(), run.Of<arm_reference_t>(), tick);
    append_tick(channels.Of<motor_command_t>(), run.Of<motor_command_t>(), tick);
    append_tick(channels.Of<fault_t>(), run.Of<fault_t>(), tick);
  }
  writer.Finish();
}

}  // namespace hydro::log
