// hydro-logger CONFIG -o FILE: records the bus.
#include <string>
#include <utility>

#include "base/number_text.h"
#include "base/read_files.h"
#include "base/text_file.h"
#include "logger/logger_app.h"
#include "process/process_main.h"
#include "settings/limb_config.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine command_line("hydro-logger",
                                            "Records every message on the bus into an LCM event log.");
  command_line.AddExamples({"hydro-logger config/demo.toml -o run.lcmlog"}, "docs/logs.md");
  hydro::settings::CommonOptions options;
  hydro::logger::LoggerOptions logger;
  double rotate_mb = 0;
  command_line.AddCommon(&options);
  command_line.AddOption("-o,--output", &logger.file, "FILE where to record; short for --log");
  command_line.AddOption("--rotate-mb", &rotate_mb,
                         "MB start a new file (FILE-001 ...) when one grows larger than this; 0: never");
  if (const auto exit_code = command_line.Parse(argc, argv)) return *exit_code;
  const std::string log = std::exchange(options.log, "");  // only the logger itself records
  return hydro::process::RunProcess(
      "hydro-logger", options,
      [&](hydro::bus::Bus& bus, hydro::bus::Clock& clock, const hydro::settings::StackConfig& config) {
        logger.file = hydro::settings::FileToRecord(logger.file, log);
        if (logger.file.empty()) throw hydro::InputError("-o FILE is required");
        hydro::CheckKeeps(logger.file);
        if (rotate_mb != 0 && !(rotate_mb >= 0.01 && rotate_mb <= 1e9)) {
          throw hydro::InputError("--rotate-mb: found " + hydro::ShortestNumber(rotate_mb) +
                                  ", allowed 0 (never) and 0.01 to 1e9");
        }
        logger.rotate_bytes = static_cast<int64_t>(rotate_mb * 1e6);
        hydro::logger::LoggerApp app(bus, clock, config, logger);
        return hydro::process::RunApp(bus, clock, app);
      },
      hydro::settings::LoadCommonConfig);
}
