#include "scope/live_messages.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "settings/command_line.h"

namespace hydro::scope {
namespace {

using OrderedJson = nlohmann::ordered_json;

std::string Text(const OrderedJson& object) { return JsonText(object); }

const char* KindName(Run::Kind kind) {
  return kind == Run::Kind::kLive ? "live" : (kind == Run::Kind::kPast ? "past" : "log");
}

OrderedJson Described(const ChannelInfo& channel) {
  OrderedJson object{{"id", channel.id},
                     {"label", channel.label},
                     {"group", channel.group},
                     {"unit", channel.unit},
                     {"step", channel.step}};
  if (!channel.si_unit.empty()) object["si"] = {{"unit", channel.si_unit}, {"factor", channel.si_factor}};
  return object;
}

OrderedJson Limits(const Run& run) {
  OrderedJson limits = OrderedJson::object();
  if (run.config == nullptr) return limits;
  const auto& parameters = run.config->model.description.parameters;
  const double voltage = parameters.T_pmax / parameters.k_1;
  if (std::isfinite(voltage)) limits["voltage_V"] = voltage;
  const settings::LimitsSection& given = run.config->limits;
  if (std::isfinite(given.pressure_psi)) limits["pressure"] = given.pressure_psi;
  if (std::isfinite(given.arm_angle_rad)) limits["arm_angle"] = given.arm_angle_rad;
  if (std::isfinite(given.motor_speed_rad_s)) limits["motor_speed"] = given.motor_speed_rad_s;
  limits["return_s"] = given.return_s;
  return limits;
}

OrderedJson Noise(const Run& run) {
  OrderedJson noise = OrderedJson::object();
  if (run.config == nullptr) return noise;
  const settings::NoiseSection& n = run.config->noise;
  noise = {{"p1", n.p1_psi},
           {"p2", n.p2_psi},
           {"motor_angle", n.motor_angle_rad},
           {"motor_speed", n.motor_speed_rad_s},
           {"arm_angle", n.arm_angle_rad},
           {"arm_speed", n.arm_speed_rad_s}};
  return noise;
}

// The units of the run's model, including those of time and angle, in which `limits` and `noise` are given.
std::string Units(const UnitSystem& units) {
  return std::string(units.length) + ", " + std::string(units.force) + ", s, " + units.UnitFor("psi") +
         ", rad";
}

OrderedJson Described(const Run& run) {
  OrderedJson channels = OrderedJson::array();
  for (const ChannelInfo& channel : run.Channels()) channels.push_back(Described(channel));
  OrderedJson object{{"run", run.id},
                     {"name", run.name},
                     {"kind", KindName(run.kind)},
                     {"first", run.first_time()},
                     {"last", run.last_time()},
                     {"rate_hz", run.rate_hz},
                     {"session", std::to_string(run.session)},
                     {"channels", channels},
                     {"limits", Limits(run)},
                     {"noise", Noise(run)}};
  if (run.config != nullptr) object["units"] = Units(run.config->model.description.units);
  // A table that was imported needs no configuration.
  if (!run.config_problem.empty() && !run.description->config_text.empty())
    object["problem"] = run.config_problem;
  return object;
}

OrderedJson Described(const std::vector<const Run*>& runs) {
  OrderedJson list = OrderedJson::array();
  for (const Run* run : runs) list.push_back(Described(*run));
  return list;
}

}  // namespace

std::string RunJson(const Run& run) { return Text(Described(run)); }

std::string NumbersJson(const std::vector<double>& numbers) { return Text(OrderedJson(numbers)); }

std::string TextJson(const std::string& text) { return Text(OrderedJson(text)); }

std::string HelloMessage(const std::vector<const Run*>& runs, bool control) {
  return Text({{"op", "hello"},
               {"program", "hydro-scope " + settings::ProgramVersion()},
               {"control", control},
               {"runs", Described(runs)}});
}

std::string RunsMessage(const std::vector<const Run*>& runs) {
  return Text({{"op", "runs"}, {"runs", Described(runs)}});
}

std::string EventMessage(const Run& run, const Event& event) {
  return Text({{"op", "event"},
               {"run", run.id},
               {"n", event.n},
               {"t", event.t},
               {"kind", event.kind},
               {"source", event.source},
               {"code", event.code},
               {"text", event.text}});
}

std::string ProcessesMessage(const Run& run) {
  OrderedJson list = OrderedJson::array();
  for (const auto& [name, report] : run.processes) {
    list.push_back({{"role", report.role},
                    {"host", report.host},
                    {"state", report.state},
                    {"text", report.text},
                    {"rate_hz", report.rate_hz},
                    {"missed", report.missed},
                    {"latency_p99_us", report.latency_p99_us},
                    {"lost", report.lost},
                    {"fault", report.faults}});
  }
  return Text({{"op", "processes"}, {"run", run.id}, {"list", list}});
}

std::string ClockMessage(const Run& run, double silent_s) {
  constexpr double kSilent = 0.5;  // s without a state after which a run counts as silent
  const bool running = silent_s >= 0 && silent_s < kSilent;
  return Text({{"op", "clock"},
               {"run", run.id},
               {"first", run.first_time()},
               {"last", run.last_time()},
               {"running", running},
               {"silent_s", silent_s < 0 ? OrderedJson(nullptr) : OrderedJson(silent_s)}});
}

std::string DroppedMessage(uint64_t bins, uint64_t frames) {
  return Text({{"op", "dropped"}, {"bins", bins}, {"frames", frames}});
}

std::string TriggerMessage(uint32_t id, double t, const std::string& state) {
  return Text({{"op", "trigger"}, {"id", id}, {"t", t}, {"state", state}});
}

std::string ReplyMessage(uint32_t id, bool ok, const std::string& text, const std::string& data) {
  OrderedJson object{{"op", "reply"}, {"id", id}, {"ok", ok}, {"text", text}};
  if (!data.empty()) object["data"] = OrderedJson::parse(data, nullptr, false);
  return Text(object);
}

}  // namespace hydro::scope
