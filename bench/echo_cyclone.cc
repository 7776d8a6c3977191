// Cyclone DDS: reliable topics that keep the last value, with a waitset at each end.
#include <dds/dds.h>

#include <stdexcept>

#include "bench/echo_peers.h"
#include "echo_messages.h"

namespace hydro {
namespace {

dds_entity_t Check(dds_return_t result) {
  if (result < 0) throw std::runtime_error(std::string("Cyclone DDS: ") + dds_strretcode(-result));
  return result;
}

// One end: writes one topic and waits for the other.
class End {
 public:
  End(const dds_topic_descriptor_t* writes, const char* writes_name, const dds_topic_descriptor_t* reads,
      const char* reads_name) {
    participant_ = Check(dds_create_participant(DDS_DOMAIN_DEFAULT, nullptr, nullptr));
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 1);
    writer_ = Check(dds_create_writer(
        participant_, Check(dds_create_topic(participant_, writes, writes_name, nullptr, nullptr)), qos,
        nullptr));
    reader_ = Check(dds_create_reader(
        participant_, Check(dds_create_topic(participant_, reads, reads_name, nullptr, nullptr)), qos,
        nullptr));
    dds_delete_qos(qos);
    waitset_ = Check(dds_create_waitset(participant_));
    const dds_entity_t condition = Check(dds_create_readcondition(reader_, DDS_ANY_STATE));
    Check(dds_waitset_attach(waitset_, condition, 0));
  }
  ~End() { dds_delete(participant_); }
  End(const End&) = delete;
  End& operator=(const End&) = delete;

  void Write(const void* message) { Check(dds_write(writer_, message)); }

  // Waits for a message; false if none came within a second.
  template <class Message>
  bool Read(Message* message) {
    while (true) {
      void* sample = message;
      dds_sample_info_t info;
      const dds_return_t taken = dds_take(reader_, &sample, &info, 1, 1);
      if (taken > 0 && info.valid_data) return true;
      if (taken > 0) continue;
      if (dds_waitset_wait(waitset_, nullptr, 0, DDS_SECS(1)) <= 0) return false;
    }
  }

 private:
  dds_entity_t participant_ = 0, writer_ = 0, reader_ = 0, waitset_ = 0;
};

class CyclonePinger : public Pinger {
 public:
  bool Trip(int64_t number) override {
    hydro_bench_State state{};
    state.number = number;
    end_.Write(&state);
    hydro_bench_Command command{};
    command.number = -1;
    while (command.number != number) {
      if (!end_.Read(&command)) return false;
    }
    return true;
  }

 private:
  End end_{&hydro_bench_State_desc, "hydro_bench_state", &hydro_bench_Command_desc, "hydro_bench_command"};
};

void Echo() {
  End end(&hydro_bench_Command_desc, "hydro_bench_command", &hydro_bench_State_desc, "hydro_bench_state");
  hydro_bench_State state{};
  hydro_bench_Command command{};
  while (true) {
    if (!end.Read(&state)) continue;
    command.number = state.number;
    end.Write(&command);
  }
}

}  // namespace

Peer CyclonePeer() {
  return {"Cyclone DDS", [] { Echo(); }, [] { return std::make_unique<CyclonePinger>(); }};
}

}  // namespace hydro
