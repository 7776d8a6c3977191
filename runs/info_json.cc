#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "runs/info.h"

namespace hydro::runs {
namespace {

using Json = nlohmann::ordered_json;

Json ChannelJson(const ChannelInfo& channel) {
  Json json = {{"messages", channel.summary.events},
               {"bytes", channel.summary.bytes},
               {"rate_hz", channel.rate_hz},
               {"undecodable", channel.summary.undecodable}};
  if (channel.numbered) {
    json["senders"] = channel.senders;
    json["missing"] = channel.missing;
    json["repeated"] = channel.repeated;
    json["before_first"] = channel.before_first;
  }
  return json;
}

Json SignalJson(const SignalInfo& signal) {
  Json json = {{"unit", signal.unit}, {"count", signal.count}};
  if (signal.count > 0) {
    json["min"] = signal.min;
    json["max"] = signal.max;
    json["last"] = signal.last;
  }
  return json;
}

Json LoopJson(const LoopInfo& loop) {
  const loop_statistics_t& last = loop.last;
  return {{"role", last.role},
          {"host", last.host},
          {"cycles", loop.cycles},
          {"missed_deadlines", loop.missed_deadlines},
          {"lost_messages", loop.lost_messages},
          {"last",
           {{"interval_s", last.interval_s},
            {"cycles", last.cycles},
            {"period_us",
             {{"p50", last.period_p50_us},
              {"p99", last.period_p99_us},
              {"p999", last.period_p999_us},
              {"max", last.period_max_us}}},
            {"latency_us",
             {{"p50", last.latency_p50_us},
              {"p99", last.latency_p99_us},
              {"p999", last.latency_p999_us},
              {"max", last.latency_max_us}}},
            {"missed_deadlines", last.missed_deadlines},
            {"lost_messages", last.lost_messages},
            {"queue_depth", last.queue_depth}}}};
}

// Writes the list `items` as JSON, each item by `json_of`.
template <class Items, class JsonOf>
Json ListJson(const Items& items, JsonOf json_of) {
  Json json = Json::array();
  for (const auto& item : items) json.push_back(json_of(item));
  return json;
}

Json RunJson(const run_description_t& description) {
  return {{"program", description.program},
          {"version", description.version},
          {"host", description.host},
          {"config_file", description.config_file},
          {"model_file", description.model_file},
          {"rate_hz", description.rate_hz},
          {"seed", description.seed}};
}

Json ProgramJson(const ProgramInfo& program) {
  return {{"role", program.role}, {"host", program.host}, {"version", program.version}};
}

Json TicksJson(const TickInfo& ticks) {
  return {{"states", ticks.states},
          {"first", ticks.first},
          {"last", ticks.last},
          {"first_time_s", ticks.first_time_s},
          {"last_time_s", ticks.last_time_s},
          {"rate_hz", ticks.rate_hz},
          {"ticks_to_next_state", ticks.sampled},
          {"gaps", ticks.gaps},
          {"missing", ticks.missing},
          {"skipped_by_plant", ticks.announced},
          {"missing_from_log", ticks.missing - ticks.announced}};
}

Json SignalsJson(const std::vector<SignalInfo>& signals) {
  Json json = Json::object();
  for (const SignalInfo& signal : signals) json[signal.name] = SignalJson(signal);
  return json;
}

Json SenderJson(const SenderInfo& sender) {
  return {{"session", sender.session},
          {"description", sender.description},
          {"ticks", TicksJson(sender.ticks)},
          {"signals", SignalsJson(sender.signals)}};
}

Json FaultJson(const fault_t& fault) {
  return {{"tick", fault.tick},
          {"source", fault.source},
          {"code", fault.code},
          {"text", fault.text},
          {"value", fault.value},
          {"limit", fault.limit},
          {"latched", fault.latched != 0},
          {"active", fault.active != 0}};
}

Json StopJson(const stop_t& stop) {
  return {
      {"tick", stop.tick}, {"source", stop.source}, {"reason", stop.reason}, {"exit_code", stop.exit_code}};
}

Json OutputLeftJson(const output_left_t& left) {
  return {
      {"tick", left.tick}, {"role", left.role}, {"accepted", left.accepted != 0}, {"voltage", left.voltage}};
}

}  // namespace

std::string InfoJson(const LogInfo& info) {
  Json json;
  json["file"] = info.file;
  json["log"] = {{"verdict", NameOf(info.verdict.completeness)},
                 {"where", info.verdict.where},
                 {"readable_bytes", info.verdict.readable_end},
                 {"unchecked_messages", info.verdict.unchecked_messages},
                 {"note", info.verdict.note},
                 {"remarks", info.verdict.remarks},
                 {"ending", info.verdict.ending}};
  json["suffix"] = info.suffix;
  json["joint"] = info.joint;
  json["other_suffixes"] = info.other_suffixes;
  json["bytes"] = info.bytes;
  json["messages"] = info.events;
  json["duration_s"] = info.duration_s;
  json["runs"] = ListJson(info.descriptions, RunJson);
  if (!info.description_fault.empty()) json["description_fault"] = info.description_fault;
  json["model_name"] = info.model_name;
  json["config"] = Json::object();
  for (const auto& [key, value] : info.config) json["config"][key] = value;
  json["processes"] = ListJson(info.programs, ProgramJson);
  json["channels"] = Json::object();
  for (const ChannelInfo& channel : info.channels)
    json["channels"][channel.summary.channel] = ChannelJson(channel);
  json["first_undecodable"] = info.first_undecodable;
  json["clock_steps"] = ListJson(info.clock_steps, [](const ClockStep& step) {
    return Json{{"at_time_s", step.at_time_s}, {"seconds", step.seconds}, {"joined", step.joined}};
  });
  json["several_runs"] = info.several_runs;
  if (info.several_runs) {
    json["senders"] = ListJson(info.senders, SenderJson);
  } else {
    json["ticks"] = TicksJson(info.ticks);
    json["signals"] = SignalsJson(info.signals);
  }
  json["loops"] = ListJson(info.loops, LoopJson);
  json["faults"] = ListJson(info.faults, FaultJson);
  json["stops"] = ListJson(info.stops, StopJson);
  json["outputs_left"] = ListJson(info.outputs_left, OutputLeftJson);
  return JsonText(json, 2) + "\n";
}

}  // namespace hydro::runs
