// The plant's side of a change of values while the stack runs. It holds the values in force, and decides on
// changes. A request is checked (tune/live/change_check.h) and proposed to the controllers; when each of them
// can act by it, the change is decided for one tick. Otherwise nothing changes.
//
//   asked -> checked -> proposed -> decided -> in force
//              |            |
//              v            v
//           refused     withdrawn (a controller cannot, or does not answer)
#pragma once

#include <cstdint>
#include <functional>
#include <hydro/process_status_t.hpp>
#include <hydro/tuned_settings_t.hpp>
#include <hydro/tuning_answer_t.hpp>
#include <hydro/tuning_request_t.hpp>
#include <hydro/tuning_status_t.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "plant/change_preparation.h"
#include "process/participant.h"
#include "settings/stack_config.h"
#include "tune/live/change_check.h"
#include "tune/live/tuned_values.h"

namespace hydro::plant {

class TuningServer {
 public:
  // `apply` is what the plant itself does with new values. `held` returns whether the voltage is held at zero
  // until a re-arm.
  struct Hooks {
    std::function<void(const tuning::TunedValues&)> apply;
    std::function<bool()> held;
  };

  // Subscribes; `participant` must outlive this object and the bus.
  TuningServer(process::Participant& participant, const settings::StackConfig& config, bool simulated_rig,
               Hooks hooks);

  // Repeats changes that were decided in another run (from its log): they take effect at the same ticks.
  // `decided` is in the order of ticks.
  void Follow(std::vector<tuned_settings_t> decided);

  // Puts into effect what is decided for `tick`. Call it before the state of that tick is published. Cheap
  // when nothing is decided.
  void OnTick(int64_t tick) {
    if (pending_ || !followed_.empty() || !begun_) OnTickWithWork(tick);
  }

  // Checks, proposes, decides, and reports what is due. Cheap when nothing is due.
  void Poll(bus::Clock::TimePoint now) {
    if (IsDue(now)) PollDue(now);
  }
  bool IsDue(bus::Clock::TimePoint now) const {
    return pending_ || now >= next_report_ || preparation_.busy();
  }

  // Whether a change is being made. Until it is in force or refused, nothing is re-armed: the change may
  // loosen a limit because the output is held.
  bool changing() const { return pending_.has_value(); }

 private:
  // Values, and the configuration from which they come.
  struct Version {
    std::shared_ptr<const settings::StackConfig> config;
    tuned_settings_t message;
  };
  // The change that is being made.
  struct Pending {
    tuning_request_t request;
    std::optional<Version> version;  // proposed; decided once its acts_at is not -1
    std::string text;
    bus::Clock::TimePoint deadline;
    bus::Clock::TimePoint next_repeat;
  };
  struct Controller {
    int64_t ready_for = -1;
    int64_t in_force = -1;
    int64_t refused = -1;
    std::string text;
    bus::Clock::TimePoint heard;
  };

  void OnTickWithWork(int64_t tick);
  void PollDue(bus::Clock::TimePoint now);
  void OnRequest(const tuning_request_t& request);
  void OnStatus(const tuning_status_t& status);
  void Begin(const tuning_request_t& request);
  std::string WhyNot(const tuning_request_t& request) const;
  bool IsYoung() const;
  std::string WhoIsMissing(const tuning_request_t& request) const;
  void Propose(tuning::PreparedChange change);
  void AwaitControllers();
  std::string NotReady(bool* impossible) const;
  void Decide();
  void Refuse(const std::string& why);
  void Accept(const tuned_settings_t& settings, const std::string& text);
  void Answer(bool accepted, int64_t version, int64_t acts_at, const std::string& text);
  void TakeEffect(Version version);
  void FollowAt(int64_t tick);
  void Publish(tuned_settings_t* settings, int8_t stage);
  int64_t TickOfEffect() const;

  process::Participant& participant_;
  const std::shared_ptr<const settings::StackConfig> configured_;
  const bool simulated_rig_;
  const Hooks hooks_;
  ChangePreparation preparation_;
  tuning::TunedValues values_;  // in force
  Version in_force_;
  std::vector<Version> before_;  // earlier versions, newest last, for UNDO
  int64_t newest_version_ = 0;   // newest version ever proposed
  std::optional<Pending> pending_;
  std::map<std::pair<std::string, int64_t>, Controller>
      controllers_;                             // by role and session; those heard lately
  std::map<int64_t, tuning_answer_t> answers_;  // the last answer to each session that asked
  std::vector<int64_t> asked_;                  // the sessions that asked, oldest first
  std::vector<tuned_settings_t> followed_;      // reversed: the next one last
  bus::Clock::TimePoint next_report_;
  std::optional<bus::Clock::TimePoint> begun_;  // the first tick
};

}  // namespace hydro::plant
