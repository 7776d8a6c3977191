#include "scope/foxglove_topics.h"

#include <cstring>
#include <hydro/messages.hpp>

#include "bus/messages.h"
#include "scope/signals/decoded.h"

namespace hydro::scope {
namespace {

// Writes fields as OMG's common data representation (version 1): each at a multiple of its size from the header's end.
class CdrWriter {
 public:
  explicit CdrWriter(std::string* bytes) : bytes_(*bytes) { bytes_.assign("\0\1\0\0", kHeader); }

  void Float(const char*, double value) { Put(value); }
  void Whole(const char*, int64_t value) { Put(value); }
  void Small(const char*, int8_t value) { Put(value); }
  void Flag(const char*, bool value) { Put(static_cast<uint8_t>(value ? 1 : 0)); }
  void Text(const char*, const std::string& value) {
    Put(static_cast<uint32_t>(value.size() + 1));
    bytes_.append(value);
    bytes_.push_back('\0');
  }

 private:
  static constexpr size_t kHeader = 4;

  template <class T>
  void Put(T value) {
    while ((bytes_.size() - kHeader) % sizeof value != 0) bytes_.push_back('\0');
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes_.append(raw, sizeof value);
  }

  std::string& bytes_;
};

// Writes the definition of the same fields.
class SchemaWriter {
 public:
  explicit SchemaWriter(std::string* text) : text_(*text) {}
  void Float(const char* name, double) { Line("float64", name); }
  void Whole(const char* name, int64_t) { Line("int64", name); }
  void Small(const char* name, int8_t) { Line("int8", name); }
  void Flag(const char* name, bool) { Line("bool", name); }
  void Text(const char* name, const std::string&) { Line("string", name); }

 private:
  void Line(const char* type, const char* name) { text_ += std::string(type) + " " + name + "\n"; }
  std::string& text_;
};

void Visit(auto& out, const state_t& m) {
  out.Whole("tick", m.tick);
  out.Float("time", m.time);
  out.Float("motor_angle", m.motor_angle);
  out.Float("motor_speed", m.motor_speed);
  out.Float("arm_angle", m.arm_angle);
  out.Float("arm_speed", m.arm_speed);
  out.Float("p1", m.p1);
  out.Float("p2", m.p2);
  out.Float("voltage", m.voltage);
  out.Whole("command_tick", m.command_tick);
  out.Whole("skipped_ticks", m.skipped_ticks);
}

void Visit(auto& out, const motor_command_t& m) {
  out.Whole("tick", m.tick);
  out.Float("voltage", m.voltage);
  out.Float("pressure_ref", m.pressure_ref);
  out.Whole("pressure_command_tick", m.pressure_command_tick);
  out.Flag("saturated", m.saturated != 0);
  out.Small("status", m.status);
}

void Visit(auto& out, const pressure_command_t& m) {
  out.Whole("tick", m.tick);
  out.Float("pressure_ref", m.pressure_ref);
  out.Float("voltage", m.voltage);
  out.Flag("open_loop", m.open_loop != 0);
}

void Visit(auto& out, const arm_reference_t& m) {
  out.Whole("tick", m.tick);
  out.Small("signal", m.signal);
  out.Float("value", m.value);
}

void Visit(auto& out, const fault_t& m) {
  out.Whole("tick", m.tick);
  out.Text("source", m.source);
  out.Text("code", m.code);
  out.Text("text", m.text);
  out.Float("value", m.value);
  out.Float("limit", m.limit);
  out.Flag("latched", m.latched != 0);
  out.Flag("active", m.active != 0);
}

void Visit(auto& out, const loop_statistics_t& m) {
  out.Text("role", m.role);
  out.Text("host", m.host);
  out.Flag("whole_run", m.whole_run != 0);
  out.Float("interval_s", m.interval_s);
  out.Whole("cycles", m.cycles);
  out.Float("period_p50_us", m.period_p50_us);
  out.Float("period_p99_us", m.period_p99_us);
  out.Float("period_max_us", m.period_max_us);
  out.Float("latency_p50_us", m.latency_p50_us);
  out.Float("latency_p99_us", m.latency_p99_us);
  out.Float("latency_max_us", m.latency_max_us);
  out.Whole("missed_deadlines", m.missed_deadlines);
  out.Whole("lost_messages", m.lost_messages);
}

template <bus::StackMessage Message>
FoxgloveTopic Topic(const char* topic, const char* type) {
  FoxgloveTopic described;
  described.topic = topic;
  described.channel = std::string(bus::RowOf<Message>().channel);
  described.schema_name = std::string("hydro_msgs/msg/") + type;
  SchemaWriter schema(&described.schema);
  Visit(schema, Message{});
  described.encode = [](const uint8_t* data, int size, std::string* cdr) {
    thread_local Message message;
    if (!Decoded(&message, data, size)) return false;
    CdrWriter writer(cdr);
    Visit(writer, message);
    return true;
  };
  return described;
}

}  // namespace

const std::vector<FoxgloveTopic>& FoxgloveTopics() {
  static const std::vector<FoxgloveTopic> topics = {
      Topic<state_t>("/hydro/state", "State"),
      Topic<motor_command_t>("/hydro/motor_command", "MotorCommand"),
      Topic<pressure_command_t>("/hydro/pressure_command", "PressureCommand"),
      Topic<arm_reference_t>("/hydro/arm_reference", "ArmReference"),
      Topic<fault_t>("/hydro/fault", "Fault"),
      Topic<loop_statistics_t>("/hydro/loop_statistics", "LoopStatistics")};
  return topics;
}

}  // namespace hydro::scope
