#include "scope/operator_desk.h"

#include <utility>

#include "base/text_file.h"
#include "launch/stop_stack.h"
#include "process/stack_bus.h"

namespace hydro::scope {

OperatorDesk::OperatorDesk(std::shared_ptr<const settings::StackConfig> config, bool control,
                           std::function<void(std::function<void()>)> post, Tuning* tuning)
    : config_(std::move(config)), control_(control), post_(std::move(post)), tuning_(tuning) {}

OperatorDesk::~OperatorDesk() {
  for (Errand* errand : {&stop_, &rearm_}) {
    if (errand->thread.joinable()) errand->thread.join();
  }
}

void OperatorDesk::Run(Errand* errand, Done done, std::function<launch::OperatorResult()> work) {
  errand->waiting.push_back(std::move(done));
  if (errand->waiting.size() > 1) return;
  if (errand->thread.joinable()) errand->thread.join();  // it has ended: it posted its result last
  errand->thread = std::thread([this, errand, work = std::move(work)] {
    launch::OperatorResult result;
    try {
      result = work();
    } catch (const std::exception& error) {
      result = {1, error.what()};
    }
    post_([errand, result] {
      const auto waiting = std::exchange(errand->waiting, {});
      for (const Done& one : waiting) one({result.exit_code == 0, Printable(result.text), {}});
    });
  });
}

void OperatorDesk::Stop(Done done) {
  if (config_ == nullptr) return done({false, "there is no stack here: a log is shown", {}});
  Run(&stop_, std::move(done), [config = config_] { return launch::StopStack(*config); });
}

bool OperatorDesk::Refused(const Done& done) const {
  if (config_ == nullptr) {
    done({false, "there is no stack here: a log is shown", {}});
  } else if (!control_) {
    done({false, "this scope is read-only: [scope] control = true in " + config_->file + " allows it", {}});
  } else {
    return false;
  }
  return true;
}

void OperatorDesk::Rearm(Done done) {
  if (Refused(done)) return;
  Run(&rearm_, std::move(done), [config = config_] {
    const auto bus = process::OpenStackBus(config->bus);
    return launch::RearmStack(*bus, bus::WallClock(), *config);
  });
}

void OperatorDesk::Set(const std::vector<std::string>& entries, Done done) {
  if (Refused(done)) return;
  if (tuning_ == nullptr) return done({false, "nothing can be set here", {}});
  tuning_->Set(entries, std::move(done));
}

void OperatorDesk::Undo(Done done) {
  if (Refused(done)) return;
  if (tuning_ == nullptr) return done({false, "nothing can be set here", {}});
  tuning_->Undo(std::move(done));
}

}  // namespace hydro::scope
