#include "settings/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <string_view>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/number_text.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "base/word_list.h"

namespace hydro::settings {
namespace {

// "FILE where to write" -> "FILE" and "where to write". A name may have an ending, as in "REPORT.json where
// to write".
std::pair<std::string, std::string> SplitHelp(const std::string& help) {
  const size_t space = help.find(' ');
  const std::string first = help.substr(0, space);
  const bool name = first.size() > 1 || space == 1;
  const bool capitals = std::none_of(first.begin(), std::find(first.begin(), first.end(), '.'),
                                     [](unsigned char c) { return std::islower(c) || std::isspace(c); });
  if (!name || !capitals || space == std::string::npos) return {"VALUE", help};
  return {first, help.substr(space + 1)};
}

[[noreturn]] void Refuse(const std::string& name, const std::string& found, const std::string& allowed) {
  throw CLI::ValidationError(name, "found " + Quoted(found) + ", allowed " + allowed);
}

std::string Filled(const std::string& name, const std::string& text, const std::string& help) {
  if (text.empty()) Refuse(name, text, help);
  return text;
}

// Reads the whole of `text` as a number. CLI11's own conversion would also accept "nan" and "0x10".
double Number(const std::string& name, const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    Refuse(name, text, "a finite number");
  }
  return value;
}

// What is beyond a number's bits is told them.
template <class Whole>
Whole WholeNumber(const std::string& name, const std::string& text,
                  Whole least = std::numeric_limits<Whole>::min()) {
  Whole value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc::result_out_of_range) {
    Refuse(name, text,
           "a whole number from " + std::to_string(least) + " to " +
               std::to_string(std::numeric_limits<Whole>::max()));
  }
  if (error != std::errc() || end != text.data() + text.size()) Refuse(name, text, "a whole number");
  if (value < least) Refuse(name, text, "a whole number of at least " + std::to_string(least));
  return value;
}

std::vector<std::string> OptionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    if (option->get_lnames().empty() && !option->get_snames().empty()) {
      names.push_back("-" + option->get_snames().front());
    }
  }
  return names;
}

// "FILE (where to record the run)": what stands for a value, and what it is for.
std::string ValueOf(const CLI::Option* option) {
  return option == nullptr ? "one" : option->get_type_name() + " (" + option->get_description() + ")";
}

// ", e.g. PROGRAM ...": the first of the program's examples, without what is said about it, and the option
// behind it if the example lacks it.
std::string Example(const CLI::App& program, const CLI::Option* option) {
  std::istringstream footer(program.get_footer());
  std::string line, first;
  const std::string name = option == nullptr || option->get_positional() ? "" : option->get_name();
  while (std::getline(footer, line)) {
    if (!line.starts_with("  ")) continue;
    line = line.substr(2, line.find("  ", 2) - 2);
    if (!name.empty() && line.find(name + " ") != std::string::npos) return ", e.g. " + line;
    if (first.empty()) first = line;
  }
  if (first.empty()) return "";
  return ", e.g. " + first + (name.empty() ? "" : " " + name + " " + option->get_type_name());
}

// Words CLI11's messages in this project's form: what was found, what is allowed. `app` is the program, or
// the verb whose options were read.
std::string Message(const CLI::ParseError& error, const CLI::App& app, const CLI::App& program) {
  std::string text = error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    const std::vector<std::string> extras = app.remaining();
    const std::string found = extras.empty() ? text : extras.front();
    const std::vector<std::string> names = OptionNames(app);
    return "found the unexpected argument " + Quoted(found) + ", allowed " + QuotedList(names) +
           (found.starts_with("--") ? DidYouMean(found.substr(0, found.find('=')), names) : "");
  }
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) {
    const std::string name = text.substr(0, text.find(" is required"));
    if (name == "A subcommand") return "verb: found nothing, allowed one of those that --help lists";
    const CLI::Option* option = app.get_option_no_throw(name);
    return name + ": found nothing, allowed " + ValueOf(option) +
           (&app == &program ? Example(app, option) : "");
  }
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const std::string name = text.substr(0, text.find(':'));
    if (text.find("At Most") != std::string::npos) {
      return name + ": found it more than once, allowed once";
    }
    const CLI::Option* option = app.get_option_no_throw(name);
    return name + ": found no value, allowed " + ValueOf(option) +
           (&app == &program ? Example(app, option) : "");
  }
  constexpr std::string_view kConversion = "Could not convert: ", kIs = " = ";  // of a flag with a value
  if (const size_t at = text.find(kIs); text.starts_with(kConversion) && at != std::string::npos) {
    return text.substr(kConversion.size(), at - kConversion.size()) + ": found " +
           Quoted(text.substr(at + kIs.size())) + " after =, allowed the option alone";
  }
  return text;
}

}  // namespace

std::string ProgramVersion() { return HYDRO_VERSION; }

class CommandLine::Impl {
 public:
  Impl(const std::string& program, const std::string& description)
      : owned_(std::make_unique<CLI::App>(description, program)), app_(owned_.get()) {
    app_->set_version_flag("--version", program + " " + ProgramVersion(), "print the version and exit");
    app_->set_help_flag("-h,--help", "print this and exit");
  }
  explicit Impl(CLI::App* verb) : app_(verb) {}

  CLI::App& app() { return *app_; }

  template <class Target, class Convert>
  CLI::Option* Add(const std::string& names, Target* target, const std::string& help, bool required,
                   Convert convert) {
    const auto [value, rest] = SplitHelp(help);
    const std::string shown = names.substr(names.rfind(',') + 1);
    return app_
        ->add_option_function<std::string>(
            names, [=](const std::string& text) { *target = convert(shown, text); }, rest)
        ->type_name(value)
        ->required(required);
  }

  CLI::Option* AddList(const std::string& names, std::vector<std::string>* target, const std::string& help,
                       bool required) {
    const auto [value, rest] = SplitHelp(help);
    const std::string shown = names.substr(names.rfind(',') + 1);
    return app_
        ->add_option_function<std::vector<std::string>>(
            names,
            [=](const std::vector<std::string>& values) {
              for (const std::string& text : values) Filled(shown, text, help);
              *target = values;
            },
            rest)
        ->type_name(value)
        ->required(required);
  }

  std::vector<std::string> VerbNames() const {
    std::vector<std::string> names;
    for (const CLI::App* verb : app_->get_subcommands([](const CLI::App*) { return true; })) {
      names.push_back(verb->get_name());
    }
    return names;
  }

  // The verb whose options were being read, or the program if there was none.
  const CLI::App& Current() const {
    const auto chosen = app_->get_subcommands();
    return chosen.empty() ? *app_ : *chosen.front();
  }

  std::vector<std::unique_ptr<CommandLine>> verbs_;

 private:
  std::unique_ptr<CLI::App> owned_;
  CLI::App* app_;
};

CommandLine::CommandLine(const std::string& program, const std::string& description)
    : impl_(std::make_unique<Impl>(program, description)) {}
CommandLine::CommandLine(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CommandLine::~CommandLine() = default;
CommandLine::CommandLine(CommandLine&&) noexcept = default;
CommandLine& CommandLine::operator=(CommandLine&&) noexcept = default;

void CommandLine::AddExamples(const std::vector<std::string>& lines, const std::string& page) {
  std::string text = "Examples:";
  for (const std::string& line : lines) text += "\n  " + line;
  impl_->app().footer(text + "\nMore: " + page);
}

void CommandLine::AddCommon(CommonOptions* options, bool config_required) {
  AddPositional("CONFIG", &options->config, "FILE the stack's configuration, TOML", config_required);
  AddOption("--set", &options->overrides,
            "SECTION.KEY=VALUE changes one key of CONFIG, e.g. pressure.damping_ratio=0.7");
  // The callbacks run in the order of declaration, so these options override --set.
  const auto add = [&](const std::string& name, const std::string& help, auto as_override) {
    impl_->Add(name, options, help, false, [=](const std::string& shown, const std::string& text) {
      CommonOptions changed = *options;
      changed.overrides.push_back(as_override(shown, text));
      return changed;
    });
  };
  add("--time", "MODE realtime or lockstep; as --set time.mode=MODE",
      [](const std::string& name, const std::string& text) {
        if (text != "realtime" && text != "lockstep") Refuse(name, text, "\"realtime\" or \"lockstep\"");
        return "time.mode=\"" + text + "\"";
      });
  add("--duration", "S plant time after which the run ends; as --set time.duration_s=S",
      [](const std::string& name, const std::string& text) {
        const double duration = Number(name, text);
        if (duration < 0) Refuse(name, text, "a number of seconds, 0 for a run until it is stopped");
        return "time.duration_s=" + ShortestNumber(duration);
      });
  add("--seed", "N seed of the measurement noise; as --set noise.seed=N",
      [](const std::string& name, const std::string& text) {
        return "noise.seed=" + std::to_string(WholeNumber<int64_t>(name, text, 0));
      });
  add("--joint",
      "NAME of a configuration with [[joint]] sections, the stack of this joint; as --set joint=NAME",
      [](const std::string& name, const std::string& text) {
        return "joint=" + Filled(name, text, "NAME of a [[joint]]");
      });
  AddOption("--log", &options->log, "FILE where to record the run");
  AddForce(&options->force);
  AddFlag("--si", &options->si, "print figures in SI units");
}

void CommandLine::AddOption(const std::string& names, std::string* target, const std::string& help,
                            bool required) {
  impl_->Add(names, target, help, required,
             [help](const std::string& name, const std::string& text) { return Filled(name, text, help); });
}

void CommandLine::AddOption(const std::string& names, std::optional<std::string>* target,
                            const std::string& help) {
  impl_->Add(names, target, help, false, [](const std::string&, const std::string& text) { return text; });
}

void CommandLine::AddOption(const std::string& names, double* target, const std::string& help,
                            bool required) {
  impl_->Add(names, target, help, required, Number);
}

void CommandLine::AddOption(const std::string& names, int* target, const std::string& help, bool required) {
  impl_->Add(names, target, help, required,
             [](const std::string& name, const std::string& text) { return WholeNumber<int>(name, text); });
}

void CommandLine::AddOption(const std::string& names, int64_t* target, const std::string& help,
                            bool required) {
  impl_->Add(names, target, help, required, [](const std::string& name, const std::string& text) {
    return WholeNumber<int64_t>(name, text);
  });
}

void CommandLine::AddOption(const std::string& names, std::vector<std::string>* target,
                            const std::string& help, bool required) {
  // Each occurrence takes one value, because the next argument may be CONFIG.
  impl_->AddList(names, target, help, required)->allow_extra_args(false);
}

void CommandLine::AddFlag(const std::string& names, bool* target, const std::string& help) {
  impl_->app().add_flag_callback(
      names, [target] { *target = true; }, help);
}

void CommandLine::AddForce(bool* target) {
  impl_->app().add_flag_callback(
      "--force",
      [target] {
        AllowReplacing();
        if (target != nullptr) *target = true;
      },
      "replace files that are there already");
}

void CommandLine::AddPositional(const std::string& name, std::string* target, const std::string& help,
                                bool required) {
  AddOption(name, target, help, required);
}

void CommandLine::AddPositional(const std::string& name, std::vector<std::string>* target,
                                const std::string& help, bool required) {
  impl_->AddList(name, target, help, required);
}

CommandLine& CommandLine::AddVerb(const std::string& name, const std::string& description) {
  CLI::App* verb = impl_->app().add_subcommand(name, description);
  impl_->app().require_subcommand(1);
  impl_->verbs_.push_back(std::unique_ptr<CommandLine>(new CommandLine(std::make_unique<Impl>(verb))));
  return *impl_->verbs_.back();
}

std::string CommandLine::verb() const {
  const auto chosen = impl_->app().get_subcommands();
  return chosen.empty() ? "" : chosen.front()->get_name();
}

std::vector<std::string> CommandLine::Given() const {
  std::vector<std::string> given;
  for (const CLI::Option* option : impl_->app().get_options()) {
    if (option->count() > 0 && !option->get_lnames().empty()) given.push_back("--" + option->get_lnames()[0]);
  }
  return given;
}

std::optional<int> CommandLine::Parse(int argc, const char* const* argv) {
  CLI::App& app = impl_->app();
  const std::string program = app.get_name();
  const std::vector<std::string> verbs = impl_->VerbNames();
  if (!verbs.empty() && (argc < 2 || argv[1][0] != '-')) {
    const std::string found = argc < 2 ? "" : argv[1];
    if (std::find(verbs.begin(), verbs.end(), found) == verbs.end()) {
      std::fprintf(stderr, "%s: verb: found %s, allowed %s%s\n", program.c_str(),
                   argc < 2 ? "nothing" : Quoted(found).c_str(), QuotedList(verbs).c_str(),
                   DidYouMean(found, verbs).c_str());
      return 2;
    }
  }
  // CLI11 would take the argument after "--log=" as its value.
  for (int i = 1; i < argc; ++i) {
    const std::string found = argv[i];
    if (!found.starts_with("--") || found.find('=') != found.size() - 1) continue;
    std::fprintf(stderr, "%s: %s: found nothing after =, allowed a value\n", program.c_str(),
                 Printable(found.substr(0, found.size() - 1)).c_str());
    return 2;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    std::printf("%s %s\n", program.c_str(), ProgramVersion().c_str());
    return FinishStandardOutput(program, 0);
  } catch (const CLI::Success&) {
    std::fputs(app.help().c_str(), stdout);
    return FinishStandardOutput(program, 0);
  } catch (const CLI::ParseError& error) {
    const std::string verb_name = verb().empty() ? "" : " " + verb();
    std::fprintf(stderr, "%s%s: %s\n", program.c_str(), verb_name.c_str(),
                 Message(error, impl_->Current(), app).c_str());
    return 2;
  }
  return std::nullopt;
}

std::string FileToRecord(const std::string& output, const std::string& log) {
  if (!output.empty() && !log.empty()) {
    throw InputError("--log: found " + Quoted(log) + " beside -o " + Quoted(output) +
                     ", allowed one of them");
  }
  return output.empty() ? log : output;
}

}  // namespace hydro::settings
