#include "scope/diagnose_jobs.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/interruption.h"
#include "base/new_file.h"
#include "base/text_file.h"
#include "scope/live_messages.h"
#include "scope/wire/access.h"

namespace hydro::scope {
namespace {

using namespace std::chrono_literals;

constexpr auto kTimeLimit = 300s;  // the program's own limit is 60 s of search
constexpr char kReports[] = "/api/reports/";
constexpr size_t kMostJobs = 8;  // that are kept
constexpr size_t kLongestLine = 500;

// All programs are installed in one folder, so hydro-diagnose is beside this one.
std::string Program() {
  std::error_code error;
  const auto self = std::filesystem::read_symlink("/proc/self/exe", error);
  return (self.parent_path() / "hydro-diagnose").string();
}

// Starts hydro-diagnose on the window in the folder. Its output can be read from ends[0].
pid_t StartProgram(const std::string& folder, int ends[2]) {
  if (pipe2(ends, O_CLOEXEC) != 0) throw InputError("no pipe: errno " + std::to_string(errno));
  std::vector<std::string> arguments = {
      "nice",  "-n",  "10", Program(), folder + "/window.lcmlog", "--model", folder + "/model_before.toml",
      "--out", folder};
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
  posix_spawn_file_actions_adddup2(&actions, ends[1], 2);
  pid_t pid = -1;
  const int failed = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (failed != 0) {
    close(ends[0]);
    throw InputError("cannot start " + Program() + ": errno " + std::to_string(failed));
  }
  return pid;
}

}  // namespace

DiagnoseJobs::DiagnoseJobs(std::string folder, std::function<void(std::function<void()>)> post)
    : folder_(std::move(folder)), post_(std::move(post)) {}

DiagnoseJobs::~DiagnoseJobs() {
  end_ = true;
  if (thread_.joinable()) thread_.join();
}

int DiagnoseJobs::Start(const CutSource& source, const std::string& model_text, double t0, double t1) {
  if (busy_) throw InputError("a window is being diagnosed already; wait for its end");
  if (model_text.empty()) throw InputError("the run has not described its model: no HYDRO_RUN");
  if (!std::filesystem::exists(Program())) {
    throw InputError(Program() + ": found nothing, it comes with hydro-scope (scripts/build programs)");
  }
  if (thread_.joinable()) thread_.join();  // the thread has posted its end
  if (jobs_.size() >= kMostJobs) {
    std::error_code ignored;
    std::filesystem::remove_all(jobs_.begin()->second.folder, ignored);
    jobs_.erase(jobs_.begin());
  }
  const int number = ++last_;
  Job& job = jobs_[number];
  job.folder = folder_ + "/diagnose" + std::to_string(number);
  job.report = kReports + FreshToken();
  busy_ = true;
  thread_ = std::thread([this, number, source, model_text, t0, t1, folder = job.folder] {
    Work(number, source, model_text, t0, t1, folder);
  });
  return number;
}

void DiagnoseJobs::Work(int job, const CutSource& source, const std::string& model_text, double t0, double t1,
                        const std::string& folder) {
  const Interruption interruption(&end_);
  std::string last_line;
  int exit_code = 2;
  try {
    std::filesystem::create_directories(folder);
    CutLog(source, t0, t1, folder + "/window.lcmlog");
    WriteWholeFile(folder + "/model_before.toml", model_text);
    exit_code = Follow(job, folder, &last_line);
  } catch (const std::exception& error) {
    last_line = Printable(error.what());
  }
  post_([this, job, exit_code, last_line] { Finish(job, exit_code, last_line); });
}

int DiagnoseJobs::Follow(int job, const std::string& folder, std::string* last_line) {
  int ends[2];
  const pid_t pid = StartProgram(folder, ends);
  const auto started = std::chrono::steady_clock::now();
  std::string line;
  while (true) {
    if (end_ || std::chrono::steady_clock::now() - started > kTimeLimit) {
      kill(pid, SIGKILL);
      *last_line = "ended after " + std::to_string(kTimeLimit.count()) + " s without a result";
      break;
    }
    pollfd waiting{ends[0], POLLIN, 0};
    if (poll(&waiting, 1, 200) <= 0) continue;
    char buffer[4096];
    const ssize_t bytes = read(ends[0], buffer, sizeof buffer);
    if (bytes <= 0) break;
    for (const char c : std::string_view(buffer, static_cast<size_t>(bytes))) {
      if (c != '\n' && line.size() < kLongestLine) line += c;
      if (c != '\n' || line.empty()) continue;
      *last_line = Printable(std::exchange(line, {}));
      post_([this, job, text = *last_line] { jobs_[job].text = text; });
    }
  }
  close(ends[0]);
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 2;
}

void DiagnoseJobs::Finish(int number, int exit_code, const std::string& last_line) {
  busy_ = false;
  Job& job = jobs_[number];
  job.state = "failed";
  job.text = last_line;
  if (exit_code > 1 || !std::filesystem::exists(job.folder + "/report.json")) return;
  try {
    const auto report = nlohmann::json::parse(ReadTextFile(job.folder + "/report.json"), nullptr, false);
    if (!report.is_object()) return;
    job.verdict = report.value("verdict", "");
    job.sentence = report.value("sentence", "");
    job.state = "done";
  } catch (const std::exception& error) {
    job.text = Printable(error.what());
  }
}

std::string DiagnoseJobs::Status(int number) const {
  const auto found = jobs_.find(number);
  if (found == jobs_.end()) return {};
  const Job& job = found->second;
  std::string text = "{\"job\":" + std::to_string(number) + ",\"state\":" + TextJson(job.state) +
                     ",\"text\":" + TextJson(job.text);
  if (job.state == "done") {
    text += ",\"sentence\":" + TextJson(job.sentence) + ",\"verdict\":" + TextJson(job.verdict) +
            ",\"report\":" + TextJson(job.report);
  }
  return text + "}\n";
}

bool DiagnoseJobs::IsReport(const std::string& path) { return path.starts_with(kReports); }

Response DiagnoseJobs::Report(const std::string& path) const {
  for (const auto& [number, job] : jobs_) {
    if (job.report != path || job.state != "done") continue;
    Response response;
    response.type = "text/html; charset=utf-8";
    response.body = ReadTextFile(job.folder + "/report.html");
    response.headers = {{"Content-Security-Policy",
                         "sandbox allow-scripts; default-src 'none'; style-src 'unsafe-inline'; script-src "
                         "'unsafe-inline'; img-src data:; frame-ancestors 'self'"}};
    return response;
  }
  return ErrorResponse(404, "no report there; GET /api/jobs/NUMBER names its path");
}

}  // namespace hydro::scope
