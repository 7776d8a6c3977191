// The command line that every program shares.
//
//   int main(int argc, char** argv) {
//     hydro::settings::CommandLine line("hydro-plant", "The simulated actuator.");
//     hydro::settings::CommonOptions options;
//     line.AddCommon(&options);
//     if (const auto code = line.Parse(argc, argv)) return *code;
//     return hydro::settings::RunProgram("hydro-plant", [&] {
//       return Run(hydro::settings::LoadStackConfig(options.config, options.overrides));
//     });
//   }
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace hydro::settings {

// The version of all programs, e.g. "0.3.0".
std::string ProgramVersion();

struct CommonOptions {
  std::string config;  // CONFIG
  // For LoadStackConfig: the --set options, and --time, --duration and --seed as the keys that they set.
  std::vector<std::string> overrides;
  std::string log;     // --log; empty: not given
  bool force = false;  // --force was given, for programs that pass it on
  bool si = false;     // show figures in SI
};

// Parse() sets the targets given to Add..., which must outlive it. The target of an absent option keeps its
// value.
class CommandLine {
 public:
  CommandLine(const std::string& program, const std::string& description);
  ~CommandLine();
  CommandLine(CommandLine&&) noexcept;
  CommandLine& operator=(CommandLine&&) noexcept;

  // CONFIG, --set section.key=value, --time realtime|lockstep, --duration S, --seed N, --log FILE, --force,
  // --si. Without `config_required`, an absent CONFIG leaves options->config empty.
  void AddCommon(CommonOptions* options, bool config_required = true);

  // `names` is written as "-o,--out". `help` begins with the value's name in capitals: "FILE where to write".
  // Refuses an empty value, such as that of an unset shell variable, because it would count as not given.
  void AddOption(const std::string& names, std::string* target, const std::string& help,
                 bool required = false);
  // The same, but an empty text is a valid value.
  void AddOption(const std::string& names, std::optional<std::string>* target, const std::string& help);
  void AddOption(const std::string& names, double* target, const std::string& help, bool required = false);
  void AddOption(const std::string& names, int* target, const std::string& help, bool required = false);
  void AddOption(const std::string& names, int64_t* target, const std::string& help, bool required = false);
  // The same for an option that may be given several times.
  void AddOption(const std::string& names, std::vector<std::string>* target, const std::string& help,
                 bool required = false);
  void AddFlag(const std::string& names, bool* target, const std::string& help);
  // Adds --force, which replaces files that already exist (new_file.h). Every program that writes files under
  // a given name needs it.
  void AddForce(bool* target = nullptr);
  void AddPositional(const std::string& name, std::string* target, const std::string& help,
                     bool required = true);
  void AddPositional(const std::string& name, std::vector<std::string>* target, const std::string& help,
                     bool required = true);

  // Ends --help with lines that can be typed, and the page to read.
  void AddExamples(const std::vector<std::string>& lines, const std::string& page);

  // Adds a verb with options of its own, as in `hydro-log info LOG`; the command line must then have exactly
  // one verb. The reference stays valid as long as this object.
  CommandLine& AddVerb(const std::string& name, const std::string& description);

  // The given verb; empty before Parse() and for a program without verbs.
  std::string verb() const;

  // The options and flags that were given, as "--log", in the order of declaration.
  std::vector<std::string> Given() const;

  // Returns nothing when the program should continue. Otherwise returns the exit code with which it must end
  // now: 0 after --help or --version (1 when they could not be written), 2 for bad usage. One line on stderr
  // explains every code but 0.
  std::optional<int> Parse(int argc, const char* const* argv);

 private:
  class Impl;
  explicit CommandLine(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// Where a program whose -o is short for --log records; empty when neither is given. Throws InputError when
// both are given.
std::string FileToRecord(const std::string& output, const std::string& log);

// Runs a program's body. Nothing may open a file before this call (run_program.cc). An exception becomes one
// line "program: ..." on stderr and an exit code: 2 for InputError, 1 for anything else.
int RunProgram(const std::string& program, const std::function<int()>& body);

}  // namespace hydro::settings
