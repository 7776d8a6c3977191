#include "scope/scope_app.h"

#include <sched.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

#include "base/input_error.h"
#include "base/text_file.h"
#include "process/stack_bus.h"
#include "process/stop_signal.h"
#include "scope/ghost_runner.h"
#include "scope/live_feed.h"
#include "scope/live_tuning.h"
#include "scope/scope_site.h"
#include "scope/signals/log_run.h"
#include "scope/wire/web_server.h"
#include "settings/limb_config.h"
#include "settings/scope_section.h"

namespace hydro::scope {
namespace {

using namespace std::chrono_literals;

constexpr int kNice = 5;  // a scope yields to processes that drive a motor without a real-time priority
constexpr auto kWatchedTurn = 16ms;       // with clients: 60 frames per second
constexpr auto kLoneTurn = 20ms;          // without clients: often enough for the kernel's buffer
constexpr auto kLogTurn = 50ms;           // a log does not change
constexpr double kBytesPerTick = 600;     // of messages, a generous estimate
constexpr size_t kLeastBytes = 16 << 20;  // for a run's messages

std::string FileName(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

bool IsConfig(const std::string& file) { return file.ends_with(".toml"); }

// A token from outside makes tests and scripts possible. A short one would not be secret.
std::string Token() {
  const char* const given = std::getenv("HYDRO_SCOPE_TOKEN");
  if (given == nullptr) return FreshToken();
  std::string token = given;
  const bool right =
      token.size() >= 16 && token.size() <= 128 &&
      std::all_of(token.begin(), token.end(), [](unsigned char c) { return std::isalnum(c) != 0; });
  if (!right) {
    throw InputError("HYDRO_SCOPE_TOKEN: found " + std::to_string(token.size()) +
                     " bytes, allowed are 16 to 128 letters and digits");
  }
  return token;
}

double CpuSeconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

// The argument of sched_setattr(2), for which Debian 12 has no header.
struct SchedulingAttributes {
  uint32_t size = 48;
  uint32_t policy = SCHED_BATCH;
  uint64_t flags = 0;
  int32_t nice = kNice;
  uint32_t priority = 0;
  uint64_t runtime = 100'000'000;  // ns
  uint64_t deadline = 0;
  uint64_t period = 0;
};

// The loops of the stack must not notice that a scope runs beside them. A batch process interrupts no other
// process when it wakes up, and because this one has the longest slice, every process that wakes up
// interrupts it (from Linux 6.12 on; before, sleepers did so anyway). An even lower class (SCHED_IDLE) would
// leave the stop button without a processor on a busy machine.
void GiveWay() {
  const SchedulingAttributes attributes;
  if (syscall(SYS_sched_setattr, 0, &attributes, 0) != 0) {
    std::fprintf(stderr, "hydro-scope: warning: cannot lower its own priority, errno %d\n", errno);
  }
}

class ScopeApp {
 public:
  explicit ScopeApp(const ScopeRequest& request) : page_(request.page) {
    if (IsConfig(request.input)) {
      LoadConfig(request);
      section_ = settings::ScopeSectionOf(config_->text, config_->file);
    } else if (!request.overrides.empty()) {
      throw InputError("--set: found it beside a log, allowed is it beside CONFIG");
    }
    if (request.port) section_.port = *request.port;
    token_ = Token();
    if (config_ != nullptr) {
      Listen();
    } else {
      OpenLog(request.input, {.joint = request.joint});
    }
  }

  int Run() {
    WebServerOptions options;
    options.address = section_.bind;
    options.port = section_.port;
    WebServer server(options);
    const auto post = [&server](std::function<void()> work) { server.Post(std::move(work)); };
    SideWork work(post);
    DiagnoseJobs jobs(work.folder(), post);
    std::map<uint32_t, Tuning*> tunings;
    for (const auto& [run, tuning] : tunings_) tunings[run] = tuning.get();
    OperatorActions actions(config_, section_.control, post, std::move(tunings));
    GhostRunner ghost(&runs_);
    LiveContext context{
        .runs = runs_,
        .actions = actions,
        .ghost = ghost,
        .silent_s = [this](uint32_t run) { return feed_ == nullptr ? -1 : feed_->silent_s(run); },
        .now = [] { return std::chrono::steady_clock::now(); },
        .frames = &frames_,
        .dropped = &dropped_};
    ScopeSite site(page_, context, &work, &jobs, static_cast<int64_t>(section_.upload_mb * 1e6));
    site.more_status = [&] {
      return MoreStatus(server) + ",\"ghost_skipped\":" + std::to_string(ghost.skipped());
    };
    server.Open(Access(token_, server.port(), section_.hosts, section_.origins), &site);
    Announce(server.port());
    server.Run([&] { return Turn(server.conversations(), &ghost); });
    return 0;
  }

 private:
  // Loads a stack, one joint of a limb, or all joints.
  void LoadConfig(const ScopeRequest& request) {
    std::vector<std::string> overrides = request.overrides;
    if (request.joint) overrides.push_back("joint=" + *request.joint);
    if (!request.joint && settings::IsLimbFile(request.input)) {
      limb_ = settings::LoadLimbConfig(request.input, overrides);
      config_ = std::make_shared<const settings::StackConfig>(limb_.common);
    } else {
      config_ =
          std::make_shared<const settings::StackConfig>(settings::LoadStackConfig(request.input, overrides));
    }
  }

  // In real time, a limb sends only some of its states. All joints share the memory for history.
  void StartRun(const std::string& name, std::shared_ptr<const settings::StackConfig> config) {
    double ticks = section_.history_s * config->plant.rate_hz;
    if (!limb_.joints.empty()) {
      const bool sampled = config->time.mode == settings::TimeMode::kRealtime;
      ticks /= static_cast<double>(sampled ? limb_.limb.telemetry_interval_ticks : 1);
    }
    const std::string suffix = config->bus.channel_suffix;
    auto& run = runs_.StartLive(name, suffix, static_cast<uint64_t>(ticks * 1.1) + 10000,
                                static_cast<size_t>(ticks * kBytesPerTick) + kLeastBytes, std::move(config));
    run.of_a_limb = !limb_.joints.empty() || settings::IsLimbFile(config_->file);
    tunings_[run.id] =
        std::make_unique<LiveTuning>(*bus_, clock_, bus::Channels(suffix), run.id, section_.control);
  }

  void Listen() {
    bus_ = process::OpenStackBus(config_->bus);
    const std::string name = FileName(config_->file);
    for (const settings::JointConfig& joint : limb_.joints) {
      StartRun(joint.name + " of " + name, std::make_shared<const settings::StackConfig>(joint.config));
    }
    if (limb_.joints.empty()) StartRun(name, config_);
    feed_ =
        std::make_unique<LiveFeed>(*bus_, clock_, config_->bus.channel_suffix, section_.history_s, &runs_);
    if (const std::string hint = bus_->receive_buffer_hint(); !hint.empty()) {
      std::fprintf(stderr, "hydro-scope: %s\n", hint.c_str());
    }
  }

  void OpenLog(const std::string& file, const runs::StackChoice& choice) {
    std::string problem;
    const std::string name = FileName(file);
    for (auto& run : OpenLogRuns(file, name, &problem, choice)) runs_.Add(std::move(run));
    if (!problem.empty()) std::fprintf(stderr, "hydro-scope: warning: %s\n", Printable(problem).c_str());
    std::fprintf(stderr, "hydro-scope: %s is open, %.0f MB of memory\n", Printable(name).c_str(),
                 static_cast<double>(runs_.memory()) / 1e6);
  }

  void Announce(int port) const {
    const bool any = section_.bind != "127.0.0.1" && section_.bind != "::1" && section_.bind != "localhost";
    if (any) {
      std::fprintf(stderr,
                   "hydro-scope: warning: listening on %s without encryption: whoever reads the network "
                   "reads the token; "
                   "put a server with TLS in front of 127.0.0.1 instead\n",
                   section_.bind.c_str());
    }
    std::printf("hydro-scope: open http://127.0.0.1:%d/#token=%s\n", port, token_.c_str());
    std::fflush(stdout);
  }

  std::chrono::microseconds Turn(int clients, GhostRunner* ghost) {
    if (process::StopSignal() != 0) return std::chrono::microseconds(-1);
    if (feed_ != nullptr) feed_->Poll();
    for (const auto& [run, tuning] : tunings_) tuning->Poll();
    ghost->Poll();
    if (feed_ == nullptr) return clients > 0 ? kWatchedTurn : kLogTurn;
    return clients > 0 ? kWatchedTurn : kLoneTurn;
  }

  std::string MoreStatus(const WebServer& server) const {
    std::string text = "\"clients\":" + std::to_string(server.conversations()) +
                       ",\"connections\":" + std::to_string(server.connections()) +
                       ",\"refused\":" + std::to_string(server.refused()) +
                       ",\"frames\":" + std::to_string(frames_) + ",\"dropped\":" + std::to_string(dropped_) +
                       ",\"cpu_s\":" + std::to_string(CpuSeconds());
    if (feed_ != nullptr) {
      const bus::RefusedMessages& refused = bus_->refused();
      text += ",\"messages\":" + std::to_string(feed_->messages()) +
              ",\"states\":" + std::to_string(feed_->states()) +
              ",\"undecodable\":" + std::to_string(feed_->undecodable()) +
              ",\"foreign_states\":" + std::to_string(feed_->foreign()) +
              ",\"messages_refused\":" + std::to_string(refused.total());
    }
    return text;
  }

  PageFiles page_;
  // Null: a log is shown. For a limb, what its joints have in common.
  std::shared_ptr<const settings::StackConfig> config_;
  settings::LimbConfig limb_;  // without joints: there is only the stack of config_
  settings::ScopeSection section_;
  std::string token_;
  RunTable runs_;
  bus::WallClock clock_;
  std::unique_ptr<bus::UdpmBus> bus_;
  std::unique_ptr<LiveFeed> feed_;
  std::map<uint32_t, std::unique_ptr<LiveTuning>> tunings_;  // by live run
  int64_t frames_ = 0;
  int64_t dropped_ = 0;
};

}  // namespace

int RunScope(const ScopeRequest& request) {
  process::CatchStopSignals();
  std::signal(SIGPIPE, SIG_IGN);
  GiveWay();
  ScopeApp app(request);
  return app.Run();
}

}  // namespace hydro::scope
