#include "scope/operator_actions.h"

#include <utility>

#include "base/text_file.h"
#include "launch/rearm_json.h"
#include "launch/stop_stack.h"
#include "process/stack_bus.h"

namespace hydro::scope {

OperatorActions::OperatorActions(std::shared_ptr<const settings::StackConfig> config, bool control,
                                 std::function<void(std::function<void()>)> post,
                                 std::map<uint32_t, Tuning*> tunings)
    : config_(std::move(config)), control_(control), post_(std::move(post)), tunings_(std::move(tunings)) {}

OperatorActions::~OperatorActions() {
  for (Errand* errand : {&stop_, &rearm_, &forecast_}) {
    if (errand->thread.joinable()) errand->thread.join();
  }
}

void OperatorActions::Run(Errand* errand, Done done, std::function<launch::OperatorResult()> work) {
  errand->waiting.push_back(std::move(done));
  if (errand->waiting.size() > 1) return;
  if (errand->thread.joinable()) errand->thread.join();  // the thread has ended: it posted its result last
  errand->thread = std::thread([this, errand, work = std::move(work)] {
    launch::OperatorResult result;
    try {
      result = work();
    } catch (const std::exception& error) {
      result = {1, error.what()};
    }
    post_([errand, result] {
      const auto waiting = std::exchange(errand->waiting, {});
      const std::string data = result.forecasts.empty() ? "" : launch::ForecastsJson(result);
      for (const Done& one : waiting) one({result.exit_code == 0, Printable(result.text), data});
    });
  });
}

void OperatorActions::Stop(Done done) {
  if (config_ == nullptr) return done({false, "there is no stack here: a log is shown", {}});
  Run(&stop_, std::move(done), [config = config_] { return launch::StopStack(*config, launch::kScopePage); });
}

bool OperatorActions::Refused(const Done& done) const {
  if (config_ == nullptr) {
    done({false, "there is no stack here: a log is shown", {}});
  } else if (!control_) {
    done({false, "this scope is read-only: [scope] control = true in " + config_->file + " allows it", {}});
  } else {
    return false;
  }
  return true;
}

void OperatorActions::Rearm(Done done) {
  if (Refused(done)) return;
  Run(&rearm_, std::move(done), [config = config_] {
    const auto bus = process::OpenStackBus(config->bus);
    return launch::RearmStack(*bus, bus::WallClock(), *config, {}, launch::kScopePage);
  });
}

void OperatorActions::ForecastRearm(Done done) {
  if (Refused(done)) return;
  Run(&forecast_, std::move(done), [config = config_] {
    const auto bus = process::OpenStackBus(config->bus);
    return launch::ForecastRearm(*bus, bus::WallClock(), *config);
  });
}

Tuning* OperatorActions::TuningOf(uint32_t run, const Done& done) const {
  if (Refused(done)) return nullptr;
  const auto tuning = tunings_.find(run);
  if (tuning != tunings_.end()) return tuning->second;
  done({false, "nothing can be set here", {}});
  return nullptr;
}

void OperatorActions::Set(uint32_t run, const std::vector<std::string>& entries, Done done) {
  if (Tuning* const tuning = TuningOf(run, done)) tuning->Set(entries, std::move(done));
}

void OperatorActions::Undo(uint32_t run, Done done) {
  if (Tuning* const tuning = TuningOf(run, done)) tuning->Undo(std::move(done));
}

}  // namespace hydro::scope
