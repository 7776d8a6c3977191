#include "tools/hydro_set/set_request.h"

#include <spdlog/fmt/fmt.h>

#include <filesystem>
#include <map>
#include <optional>

#include "base/input_error.h"
#include "base/standard_output.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "bus/channels.h"
#include "runs/recorded/tuning_history.h"
#include "tune/live/change_check.h"
#include "tune/live/rearm_forecast.h"
#include "tune/live/saved_config.h"
#include "tune/live/tunable_keys.h"
#include "tune/live/tuning_client.h"

namespace hydro::hydro_set {
namespace {

using namespace std::chrono_literals;

constexpr auto kPresence = 2500ms;  // once a second, a plant sends the values in force
constexpr auto kTakeEffect = 2s;
constexpr auto kTurn = 20ms;

void Print(std::FILE* to, const std::string& text) { std::fputs((Printable(text) + "\n").c_str(), to); }

class Setter {
 public:
  Setter(bus::Bus& bus, const bus::Clock& clock, const settings::BusSection& section,
         const SetRequest& request, const SetOutput& output)
      : bus_(bus),
        clock_(clock),
        url_(section.url),
        request_(request),
        output_(output),
        said_(OutputBeside({request.save}, output.out, output.err)),
        client_(bus, clock, bus::Channels(section.channel_suffix), "hydro-set") {}

  int Run() {
    RequireTunable();
    if (!FindStack()) return 1;
    if ((!request_.changes.empty() || request_.undo) && !Change()) return 1;
    if (request_.list) List();
    if (!request_.save.empty()) Save();
    if (request_.watch) Watch();
    return 0;
  }

 private:
  template <class Until>
  bool Wait(bus::Clock::Duration longest, Until until) {
    const auto deadline = clock_.Now() + longest;
    while (!until()) {
      if (clock_.Now() >= deadline || output_.interrupted() || !client_.ending().empty()) return false;
      bus_.HandleUntil(clock_.Now() + kTurn);
      client_.Poll();
    }
    return true;
  }

  // Checks the keys before this waits for a stack. Throws InputError.
  void RequireTunable() const {
    for (const std::string& change : request_.changes) {
      const std::string key = Trimmed(change.substr(0, change.find('=')));
      if (tuning::FindTunable(key) == nullptr) throw InputError(tuning::WhyNotTunable(key));
    }
  }

  bool FindStack() {
    const bool found = Wait(kPresence, [&] {
      const bool described = client_.in_force() && client_.run();
      return described && !client_.plants().empty() && client_.ending().empty();
    });
    if (!client_.ending().empty()) {
      Print(output_.err,
            fmt::format("hydro-set: the stack on {} stops ({}) and takes no values any more; set them in its "
                        "configuration, or start it again with hydro-launch and repeat this",
                        url_, client_.ending()));
      return false;
    }
    if (client_.plants().size() > 1) {
      Print(output_.err,
            fmt::format("hydro-set: heard {} plants on {}, allowed is one", client_.plants().size(), url_));
      return false;
    }
    if (found) return true;
    Print(
        output_.err,
        client_.plants().empty()
            ? fmt::format("hydro-set: no running stack is heard on {}; start one with hydro-launch, or name "
                          "its configuration: "
                          "hydro-set CONFIG ...",
                          url_)
            : fmt::format("hydro-set: the plant on {} does not say which values are in force; does it stand "
                          "still, or is it of "
                          "another version?",
                          url_));
    return false;
  }

  bool Change() {
    if (request_.undo) {
      client_.Undo();
    } else {
      client_.Set(fmt::format("{}", fmt::join(request_.changes, "\n")));
    }
    std::optional<tuning_answer_t> answer;
    Wait(kPresence * 2, [&] { return (answer = client_.TakeAnswer()).has_value(); });
    if (!answer || !answer->accepted) {
      Print(output_.err, "hydro-set: refused: " + (answer ? answer->text : std::string("interrupted")));
      return false;
    }
    Print(said_, fmt::format("version {}: {}", answer->version, answer->text));
    const bool acts = Wait(kTakeEffect, [&] { return client_.ActBy(answer->version); });
    std::string who;
    for (const auto& [role, status] : client_.controllers()) {
      who += fmt::format("{}{} {}", who.empty() ? "" : ", ", role,
                         status.in_force == answer->version ? fmt::format("since tick {}", status.since)
                                                            : std::string("has not said so"));
    }
    if (!acts && !client_.ending().empty()) {
      Print(output_.err,
            fmt::format("hydro-set: the stack stops ({}); version {} was to act from tick {} on, and may not "
                        "have",
                        client_.ending(), answer->version, answer->acts_at));
      return false;
    }
    Print(acts ? said_ : output_.err,
          fmt::format("acts from tick {} on ({:.3f} s): {}", answer->acts_at,
                      static_cast<double>(answer->acts_at) / client_.run()->rate_hz, who));
    return acts;
  }

  void List() const {
    const auto values = tuning::ValuesInForce(*client_.run(), *client_.in_force(),
                                              [](double value) { return fmt::format("{:g}", value); });
    const settings::StackConfig config = tuning::ConfigInForce(*client_.run(), *client_.in_force());
    constexpr const char* kRow = "{:<34} {:<22} {:<22} {:<41} {:<14} {}";
    Print(said_, fmt::format(fmt::runtime(kRow), "key", "value in force", "unit", "allowed", "acts in",
                             "what it does"));
    for (const tuning::TunableKey& row : tuning::TunableKeys()) {
      const auto value = values.find(std::string(row.key));
      Print(said_,
            fmt::format(fmt::runtime(kRow), row.key, value == values.end() ? "(default)" : value->second,
                        tuning::UnitOf(row, config), row.range, row.acts_in, row.what));
    }
    Print(said_, "in force: " + runs::DescribeInForce(*client_.in_force()));
  }

  void Save() const {
    const std::string text = tuning::SavedText(request_.config_file, request_.joint, request_.save,
                                               *client_.run(), *client_.in_force());
    WriteTextFile(request_.save, text, output_.out);
    if (request_.save == kStandardOutput) return;
    Print(said_,
          fmt::format("{}: the configuration with version {}", request_.save, client_.in_force()->version));
  }

  void Watch() {
    std::optional<tuned_settings_t> shown;
    std::map<std::string, int64_t> acting;
    std::string ending;
    while (!output_.interrupted()) {
      const tuned_settings_t& in_force = *client_.in_force();
      if (!shown) Print(said_, "in force: " + runs::DescribeInForce(in_force));
      if (shown && shown->version != in_force.version)
        Print(said_, runs::DescribeTuning(runs::StepTo(in_force, &*shown)));
      shown = in_force;
      for (const auto& [role, status] : client_.controllers()) {
        const auto known = acting.find(role);
        if (known == acting.end() || known->second != status.in_force) {
          Print(said_, fmt::format("{} acts by version {}{}", role, status.in_force,
                                   status.since >= 0 ? fmt::format(" since tick {}", status.since) : ""));
          acting[role] = status.in_force;
        }
      }
      if (client_.ending() != ending && !client_.ending().empty())
        Print(said_, fmt::format("the stack ends ({}); Ctrl-C ends this, too", client_.ending()));
      ending = client_.ending();
      std::fflush(said_);
      bus_.HandleUntil(clock_.Now() + kTurn);
    }
  }

  bus::Bus& bus_;
  const bus::Clock& clock_;
  const std::string url_;
  const SetRequest& request_;
  const SetOutput& output_;
  std::FILE* const said_;  // receives what was asked for, never mixed with a saved file
  tuning::TuningClient client_;
};

}  // namespace

void CheckRequest(const SetRequest& request) {
  if (!request.changes.empty()) tuning::ParseChanges(fmt::format("{}", fmt::join(request.changes, "\n")));
  if (request.undo && !request.changes.empty()) {
    throw InputError("--undo: found " + Quoted(request.changes.front()) +
                     " beside it, allowed is one of the two");
  }
  if (request.changes.empty() && !request.undo && !request.list && !request.watch && request.save.empty()) {
    throw InputError(
        "found nothing to do, allowed KEY=VALUE..., --undo, --list, --watch or --save FILE; see --help");
  }
  if (request.save.empty()) return;
  std::error_code none;
  if (!request.config_file.empty() && std::filesystem::equivalent(request.save, request.config_file, none)) {
    throw InputError("--save: found " + Quoted(request.save) +
                     ", which is CONFIG; give another file, so that nothing is lost");
  }
  CheckCanBeWritten(request.save);
}

int RunSet(bus::Bus& bus, const bus::Clock& clock, const settings::BusSection& section,
           const SetRequest& request, const SetOutput& output) {
  return Setter(bus, clock, section, request, output).Run();
}

}  // namespace hydro::hydro_set
