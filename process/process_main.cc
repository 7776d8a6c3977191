#include "process/process_main.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>

#include "bus/real_time.h"
#include "bus/udpm_bus.h"
#include "logger/log_writer.h"
#include "process/stop_signal.h"

namespace hydro {
namespace {

const ProcessSection& SectionOf(const StackConfig& config, const std::string& program) {
  static const ProcessSection kNone;
  for (const ProcessSection& section : config.processes) {
    if (section.program == program) return section;
  }
  return kNone;
}

}  // namespace

int RunProcess(const std::string& program, const CommonOptions& options, const ProcessBody& body) {
  return RunProgram(program, [&] {
    // Words for a person go to stderr: stdout is for results.
    spdlog::set_default_logger(spdlog::stderr_color_mt(program));
    spdlog::set_pattern("%H:%M:%S.%e %n: %v");
    const StackConfig config = LoadStackConfig(options.config, options.overrides);
    CatchStopSignals();
    const ProcessSection& section = SectionOf(config, program);
    RealTimeRequest request;
    request.priority = section.priority;
    request.cpu = section.cpu;
    request.lock_memory = section.priority > 0;
    ApplyRealTime(request);
    UdpmBus bus(config.bus.url);
    if (const std::string hint = bus.receive_buffer_hint(); !hint.empty()) spdlog::warn("{}", hint);
    std::unique_ptr<LogWriter> log;
    if (!options.log.empty()) {
      log = std::make_unique<LogWriter>(options.log, Opening::kDirect);
      bus.SubscribeAll([&log](const RawMessage& m) {
        log->Append(m.channel, m.data, static_cast<size_t>(m.size), m.receive_utime);
      });
    }
    WallClock clock;
    const int exit_code = body(bus, clock, config);
    if (log) log->Finish();
    return exit_code;
  });
}

}  // namespace hydro
