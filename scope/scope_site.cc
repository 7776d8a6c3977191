#include "scope/scope_site.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "base/input_error.h"
#include "base/json_text.h"
#include "base/number_text.h"
#include "base/tables/table.h"
#include "base/text_file.h"
#include "runs/recorded/run_table.h"
#include "scope/cut_out.h"
#include "scope/foxglove_conversation.h"
#include "scope/live_messages.h"
#include "scope/signals/log_run.h"
#include "settings/command_line.h"

namespace hydro::scope {
namespace {

using nlohmann::json;

constexpr int64_t kMostJson = 65536;
constexpr size_t kMostRuns = 16;
constexpr char kJobs[] = "/api/jobs/";

InputError Wrong(const std::string& what) { return InputError(what); }

json BodyOf(const Request& request) {
  json body = json::parse(request.body.empty() ? "{}" : request.body, nullptr, false);
  if (!body.is_object()) throw Wrong("found no JSON object as the request's body, allowed is {...}");
  return body;
}

double NumberOf(const json& body, const char* key) {
  const auto field = body.find(key);
  if (field == body.end() || !field->is_number() || !std::isfinite(field->get<double>())) {
    throw Wrong(std::string(key) + ": found " + (field == body.end() ? "nothing" : JsonText(*field)) +
                ", allowed is a number");
  }
  return field->get<double>();
}

uint32_t RunIdOf(const json& body) {
  const double id = body.contains("run") ? NumberOf(body, "run") : 0;
  if (!(id >= 0 && id <= 4294967295.0))
    throw Wrong("run: found " + JsonText(body["run"]) + ", allowed is a run's number");
  return static_cast<uint32_t>(id);
}

// A file name that a browser can save or show: no path, no quotes.
std::string PlainName(const std::string& name) {
  std::string plain;
  for (const char c : name.substr(name.find_last_of('/') + 1).substr(0, 100)) {
    const auto byte = static_cast<unsigned char>(c);
    plain += std::isalnum(byte) != 0 || c == '.' || c == '-' || c == '_' ? c : '_';
  }
  return plain.empty() ? "run" : plain;
}

std::string Stem(const std::string& name) { return name.substr(0, name.find_last_of('.')); }

}  // namespace

ScopeSite::ScopeSite(PageFiles page, LiveContext context, SideWork* work, DiagnoseJobs* jobs,
                     int64_t upload_bytes)
    : page_(std::move(page)),
      context_(std::move(context)),
      work_(*work),
      jobs_(*jobs),
      upload_bytes_(upload_bytes) {}

bool ScopeSite::IsPublic(const std::string& path) const {
  return PageFiles::Has(path) || DiagnoseJobs::IsReport(path);
}

int64_t ScopeSite::BodyLimit(const Request& head) const {
  if (!head.path.starts_with("/api/")) return 0;
  return head.path == "/api/open" ? upload_bytes_ : kMostJson;
}

std::string ScopeSite::BodyFile(const Request& head) {
  if (head.path != "/api/open") return {};
  const auto name = head.query.find("name");
  const bool table = name != head.query.end() && name->second.ends_with(".csv");
  return work_.FreshFile(table ? ".csv" : ".lcmlog");
}

std::unique_ptr<Conversation> ScopeSite::Converse(const std::string& path,
                                                  const std::vector<std::string>& offered,
                                                  std::string* chosen) {
  for (const std::string& subprotocol : offered) {
    if (!FoxgloveConversation::Speaks(subprotocol)) continue;
    *chosen = subprotocol;
    return std::make_unique<FoxgloveConversation>(&context_.runs);
  }
  constexpr char kOurs[] = "hydro.scope.v1";
  const bool ours = std::find(offered.begin(), offered.end(), kOurs) != offered.end();
  if (path != "/live" || (!offered.empty() && !ours)) return nullptr;
  if (ours) *chosen = kOurs;
  return std::make_unique<LiveConversation>(context_);
}

void ScopeSite::Answer(Request request, std::function<void(Response)> reply) {
  try {
    const bool post = request.method == "POST";
    if (DiagnoseJobs::IsReport(request.path) && !post) return reply(jobs_.Report(request.path));
    if (IsPublic(request.path) && !post) return reply(page_.Answer(request.path));
    if (request.path == "/api/status" && !post) {
      Response response;
      response.body = Status();
      return reply(std::move(response));
    }
    if (request.path == "/api/open" && post) return Open(request, reply);
    if (request.path == "/api/close" && post) return Close(request, reply);
    if (request.path == "/api/cut" && post) return Cut(request, reply);
    if (request.path == "/api/diagnose" && post) return Diagnose(request, reply);
    if (request.path.starts_with(kJobs) && !post) {
      const auto number = ParseInteger(request.path.substr(sizeof kJobs - 1));
      Response response;
      response.body =
          number && *number > 0 && *number < 1000000 ? jobs_.Status(static_cast<int>(*number)) : "";
      return reply(response.body.empty() ? ErrorResponse(404, "there is no such job") : response);
    }
    reply(ErrorResponse(404, "found " + request.method + " " + Printable(request.path.substr(0, 100)) +
                                 "; docs/developers/scope_protocol.md lists what there is"));
  } catch (const std::exception& error) {
    reply(ErrorResponse(400, Printable(error.what())));
  }
}

std::string ScopeSite::Status() const {
  std::string runs;
  for (const Run* run : context_.runs.All()) runs += (runs.empty() ? "" : ",") + RunJson(*run);
  return "{\"program\":" + TextJson("hydro-scope " + settings::ProgramVersion()) +
         ",\"control\":" + (context_.actions.control() ? "true" : "false") + ",\"runs\":[" + runs +
         "],\"memory_bytes\":" + std::to_string(context_.runs.memory()) +
         (more_status ? "," + more_status() : std::string()) + "}\n";
}

void ScopeSite::Open(const Request& request, const Reply& reply) {
  const auto given = request.query.find("name");
  const std::string name = PlainName(given == request.query.end() ? "run.lcmlog" : given->second);
  const std::string file = request.body_file;
  std::set<std::string> files;  // a limb's log is one file with a run for each joint
  for (const Run* run : context_.runs.All()) files.insert(run->log_file);
  if (files.size() >= kMostRuns) {
    std::remove(file.c_str());
    return reply(ErrorResponse(409, "16 runs are open already; close one"));
  }
  const bool taken = work_.Do([this, name, file, reply]() -> std::function<void()> {
    try {
      std::string log_file = file;
      if (tables::IsTable(file)) {
        log_file = work_.FreshFile(".lcmlog");
        runs::ImportRun(tables::ReadTableWithoutUnits(file), settings::ProgramVersion(), log_file);
        std::remove(file.c_str());
      }
      std::string problem;
      auto opened =
          std::make_shared<std::vector<std::unique_ptr<Run>>>(OpenLogRuns(log_file, name, &problem));
      return [this, opened, name, problem, reply] {
        uint32_t first = 0;
        for (size_t i = 0; i < opened->size(); ++i) {
          const uint32_t id = context_.runs.Add(std::move((*opened)[i]));
          if (i == 0) first = id;
        }
        Response response;
        response.body = "{\"run\":" + std::to_string(first) + ",\"name\":" + TextJson(name) +
                        ",\"problem\":" + TextJson(problem) + "}\n";
        reply(std::move(response));
      };
    } catch (const std::exception& error) {
      std::remove(file.c_str());
      // The name that the server gave the file means nothing to the user.
      std::string text = error.what();
      for (size_t at = text.find(file); at != std::string::npos; at = text.find(file, at + name.size())) {
        text.replace(at, file.size(), name);
      }
      return [text, reply] { reply(ErrorResponse(400, Printable(text))); };
    }
  });
  if (!taken) {
    std::remove(file.c_str());
    reply(ErrorResponse(503, "too much is being opened at once; try again"));
  }
}

void ScopeSite::Close(const Request& request, const Reply& reply) {
  const uint32_t id = RunIdOf(BodyOf(request));
  const Run* const run = context_.runs.Find(id);
  const std::string file = run != nullptr && run->log_file.starts_with(work_.folder()) ? run->log_file : "";
  if (!context_.runs.Close(id))
    throw Wrong("run: found " + std::to_string(id) + ", allowed is a log that is open");
  if (!file.empty()) std::remove(file.c_str());
  Response response;
  response.body = "{}\n";
  reply(std::move(response));
}

void ScopeSite::Cut(const Request& request, const Reply& reply) {
  const json body = BodyOf(request);
  const Run* const run = context_.runs.Find(RunIdOf(body));
  if (run == nullptr)
    throw Wrong("run: found " + JsonText(body.value("run", json(0))) + ", allowed is one that is open");
  const double t0 = NumberOf(body, "t0");
  const double t1 = NumberOf(body, "t1");
  const std::string format =
      body.contains("format") && body["format"].is_string() ? body["format"].get<std::string>() : "";
  if (format != "lcmlog" && format != "csv")
    throw Wrong("format: found " + Quoted(format) + ", allowed is \"lcmlog\" or \"csv\"");
  const bool si = body.contains("si") && body["si"] == true;
  const std::string log_file = work_.FreshFile(".lcmlog");
  const std::string table_file = work_.FreshFile(".csv");
  const std::string saved = Stem(PlainName(run->name)) + "_cut." + format;
  const bool taken = work_.Do([=, source = CutSourceOf(*run)]() -> std::function<void()> {
    Response response;
    try {
      const bool csv = format == "csv";
      csv ? CutTable(source, t0, t1, si, log_file, table_file) : CutLog(source, t0, t1, log_file);
      response.type = csv ? "text/csv; charset=utf-8" : "application/octet-stream";
      response.file = csv ? table_file : log_file;
      response.headers = {{"Content-Disposition", "attachment; filename=\"" + saved + "\""}};
      if (csv) std::remove(log_file.c_str());
    } catch (const std::exception& error) {
      std::remove(log_file.c_str());
      response = ErrorResponse(400, Printable(error.what()));
    }
    return [reply, response] { reply(response); };
  });
  if (!taken) reply(ErrorResponse(503, "too much is being cut out at once; try again"));
}

void ScopeSite::Diagnose(const Request& request, const Reply& reply) {
  const json body = BodyOf(request);
  const Run* const run = context_.runs.Find(RunIdOf(body));
  if (run == nullptr)
    throw Wrong("run: found " + JsonText(body.value("run", json(0))) + ", allowed is one that is open");
  const std::string model = run->description ? run->description->model_text : std::string();
  const int job = jobs_.Start(CutSourceOf(*run), model, NumberOf(body, "t0"), NumberOf(body, "t1"));
  Response response;
  response.body = "{\"job\":" + std::to_string(job) + "}\n";
  reply(std::move(response));
}

}  // namespace hydro::scope
