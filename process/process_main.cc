#include "process/process_main.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <memory>

#include "base/file_watch.h"
#include "base/read_files.h"
#include "bus/udpm/udpm_url.h"
#include "process/stack_bus.h"
#include "process/status.h"
#include "process/stderr_log.h"
#include "process/stop_signal.h"
#include "process/stop_socket.h"
#include "process/timing/real_time.h"
#include "runs/log/log_writer.h"

namespace hydro::process {
namespace {

const settings::ProcessSection& SectionOf(const settings::StackConfig& config, const std::string& program) {
  static const settings::ProcessSection kNone;
  for (const settings::ProcessSection& section : config.processes) {
    if (section.program == program) return section;
  }
  return kNone;
}

timing::RealTimeRequest RealTimeRequestOf(const settings::ProcessSection& section) {
  timing::RealTimeRequest request;
  request.priority = section.priority;
  request.cpu = section.cpu;
  request.lock_memory = section.lock_memory;
  return request;
}

// Without a key, anyone who can reach the multicast group can drive the actuator. Only the process that obeys
// commands warns.
void WarnOfOpenNetwork(const std::string& program, const settings::BusSection& bus) {
  const bool obeys_commands = IsPlant(RoleOf(program));
  const int ttl = bus::ParseUdpmUrl(bus.url).ttl;
  if (!obeys_commands || ttl == 0 || !bus.key_file.empty()) return;
  spdlog::warn(
      "bus.url has ttl={} and there is no bus.key_file: anyone on this network can command the motor "
      "(docs/security.md)",
      ttl);
}

// The --log option of a process whose main work is something else: that work goes on when the log can no
// longer be written.
class Recording {
 public:
  void Open(const std::string& file) {
    writer_ = std::make_unique<log::LogWriter>(file, Opening::kDirect);
    watch_.Watch(file);
  }

  void Add(const bus::RawMessage& message) {
    if (!writer_ || message.channel.empty()) return;
    Try([&] {
      writer_->Append(message.channel, message.data, static_cast<size_t>(message.size),
                      message.receive_utime);
      const auto now = std::chrono::steady_clock::now();
      if (now - flushed_ < kFlushPeriod) return;
      flushed_ = now;
      writer_->Flush();
      if (const auto wrong = watch_.Look(now)) ReportGone(*wrong);
    });
  }

  // Returns false when some of the log could not be written, or when the file is no longer where it was.
  bool Close() {
    if (writer_) Try([&] { writer_->Finish(); });
    if (const auto wrong = watch_.LookNow()) ReportGone(*wrong);
    return !failed_;
  }

 private:
  static constexpr auto kFlushPeriod = std::chrono::milliseconds(20);

  // Recording goes on: an open file still takes what is written.
  void ReportGone(const std::string& wrong) {
    failed_ = true;
    spdlog::error("{}; this program will end with 1", wrong);
  }

  void Try(const std::function<void()>& write) {
    try {
      write();
    } catch (const std::exception& error) {
      failed_ = true;
      writer_.reset();
      spdlog::error("{}; --log ends here", error.what());
    }
  }

  std::unique_ptr<log::LogWriter> writer_;
  FileWatch watch_;
  std::chrono::steady_clock::time_point flushed_;
  bool failed_ = false;
};

}  // namespace

int RunProcess(const std::string& program, const settings::CommonOptions& options, const ProcessBody& body,
               const ConfigLoader& load) {
  return settings::RunProgram(program, [&] {
    const StderrLog log(program);  // stdout is for results
    const settings::StackConfig config = load(options.config, options.overrides);
    CheckKeeps(options.log);
    CheckIsNew(options.log);
    CatchStopSignals();
    timing::ApplyRealTime(RealTimeRequestOf(SectionOf(config, program)));
    const StopSocket stop_socket(
        StopSocketPrefix(bus::ParseUdpmUrl(config.bus.url).port, config.bus.channel_suffix), RoleOf(program));
    const std::unique_ptr<bus::UdpmBus> opened = OpenStackBus(config.bus);
    bus::UdpmBus& bus = *opened;
    WarnOfOpenNetwork(program, config.bus);
    if (const std::string hint = bus.receive_buffer_hint(); !hint.empty()) spdlog::warn("{}", hint);
    Recording recording;
    if (!options.log.empty()) {
      recording.Open(options.log);
      bus.SubscribeAll([&recording](const bus::RawMessage& message) { recording.Add(message); });
    }
    bus::WallClock clock;
    const int exit_code = body(bus, clock, config);
    return recording.Close() ? exit_code : 1;
  });
}

}  // namespace hydro::process
