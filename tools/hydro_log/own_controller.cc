#include "tools/hydro_log/own_controller.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>
#include <wordexp.h>

#include <cstdlib>
#include <filesystem>
#include <hydro/stop_t.hpp>

#include "base/input_error.h"
#include "base/new_file.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "bus/channels.h"
#include "bus/session.h"
#include "bus/udpm/udpm_bus.h"
#include "process/own_program.h"
#include "process/spawn.h"
#include "process/stack_bus.h"
#include "process/status.h"
#include "process/stop_signal.h"
#include "settings/overrides.h"
#include "settings/process_sections.h"

namespace hydro::hydro_log {
namespace {

using namespace std::chrono_literals;
namespace fs = std::filesystem;

constexpr auto kLook = 20ms;    // interval between checks for the child's end
constexpr auto kAgain = 100ms;  // after which messages that may be lost are sent again

}  // namespace

// A folder with the files that the controller reads. It exists as long as this object.
class OwnController::Folder {
 public:
  Folder() : path_((fs::temp_directory_path() / "hydro-replay.XXXXXX").string()) {
    if (mkdtemp(path_.data()) != nullptr) return;
    throw InputError("cannot make a folder " + path_ +
                     " for the controller's configuration; TMPDIR names another place");
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string File(const std::string& name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

std::vector<std::string> CommandWords(const std::string& text) {
  wordexp_t found{};
  const int wrong = wordexp(text.c_str(), &found, WRDE_NOCMD | WRDE_UNDEF);
  if (wrong != 0 || found.we_wordc == 0) {
    if (wrong == 0) wordfree(&found);
    throw InputError("--controller: found " + Quoted(text) +
                     ", allowed are pressure, position, both, or a command, e.g. \"./pid.py\"");
  }
  std::vector<std::string> words(found.we_wordv, found.we_wordv + found.we_wordc);
  wordfree(&found);
  return words;
}

OwnController::OwnController(const settings::StackConfig& recorded, const run_description_t& description,
                             const std::vector<std::string>& command, const std::string& role)
    : name_(command.front()),
      role_(role),
      folder_(std::make_unique<Folder>()),
      port_(std::make_unique<bus::ReservedPort>()) {
  process::SpawnRequest request;
  request.argv = command;
  request.argv.front() =
      process::FindOwnProgram(command.front(), fs::current_path().string(), "--controller");
  WriteConfiguration(recorded, description);
  bus_ = process::OpenStackBus(config_.bus);
  bus_->Subscribe<process_status_t>(bus::Channels().Of<process_status_t>(),
                                    [this](const process_status_t& status) {
                                      if (status.role == role_) {
                                        status_ = status;
                                      } else if (pid_ > 0 && status.pid == pid_) {
                                        other_role_ = status.role;
                                      }
                                    });
  request.environment =
      process::OwnEnvironment(config_, {role, folder_->File("stack.toml"), {}}, process::OwnFolder());
  request.out = STDERR_FILENO;
  pid_ = process::Spawn(request).pid;
}

OwnController::~OwnController() {
  if (pid_ > 0 && !end_) {
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

void OwnController::WriteConfiguration(const settings::StackConfig& recorded,
                                       const run_description_t& description) {
  settings::TomlNode stack = settings::ParseToml(recorded.text, recorded.file);
  settings::ApplyOverrides({"bus.url=" + settings::TomlString(port_->Url()), "bus.channel_suffix=''",
                            // The controller receives what was heard, in the order of that time, and may not
                            // wait for more.
                            "time.mode='realtime'", "model.file='model.toml'"},
                           &stack);
  stack.Find("bus")->Erase("key_file");
  WriteWholeFile(folder_->File("model.toml"), description.model_text);
  WriteWholeFile(folder_->File("stack.toml"), settings::FormatToml(stack));
  config_ = settings::LoadStackConfig(folder_->File("stack.toml"));
}

bool OwnController::Ended() {
  if (end_) return true;
  siginfo_t info = {};
  if (waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != pid_)
    return false;
  kill(-pid_, SIGKILL);  // its own children; the group exists until the child is reaped
  int status = 0;
  waitpid(pid_, &status, 0);
  end_ = process::EndOf(status);
  return true;
}

std::optional<std::string> OwnController::Await(const std::function<bool()>& done,
                                                const std::function<void()>& again, Duration limit,
                                                const std::string& what) {
  const auto begin = clock_.Now();
  auto repeat = begin + kAgain, look = begin + kLook;
  while (!done()) {
    const auto now = clock_.Now();
    if (now >= look) {  // not for each message, because most answers come at once
      look = now + kLook;
      if (process::StopSignal() != 0) return "stopped by a signal";
      if (Ended()) return DescribeEnd(name_, *end_) + " before it could " + what;
      if (now >= begin + limit) {
        return name_ + " did not " + what + " within " + ShortNumber(bus::ToSeconds(limit)) + " s";
      }
    }
    if (now >= repeat) {
      repeat = now + kAgain;
      again();
    }
    bus_->HandleUntil(std::min({repeat, look, begin + limit}));
  }
  return std::nullopt;
}

std::optional<std::string> OwnController::AwaitReady(Duration limit) {
  std::optional<std::string> wrong = Await([this] { return status_ && process::IsThere(*status_); }, [] {},
                                           limit, "say that it is ready (HYDRO_PROCESS_STATUS)");
  if (wrong && !other_role_.empty()) {
    return name_ + " takes part as " + other_role_ + ", and " + role_ + " is replayed; --role " +
           other_role_ + " replays that";
  }
  return wrong;
}

std::optional<std::string> OwnController::End(int64_t plant_session, Duration limit) {
  stop_t stop;
  stop.utime = clock_.Utime();
  stop.tick = -1;
  stop.session = bus::SessionOn(clock_);
  stop.addressee = plant_session;
  stop.source = "replay";
  stop.reason = "the replay is complete";
  stop.exit_code = 0;
  const auto say = [&] { bus_->Publish(bus::Channels().Of<stop_t>(), stop); };
  say();
  if (auto wrong = Await([this] { return Ended(); }, say, limit, "end at HYDRO_STOP")) return wrong;
  if (end_->signal != 0 || end_->exit_code != 0) return DescribeEnd(name_, *end_) + " at the end of the run";
  return std::nullopt;
}

}  // namespace hydro::hydro_log
