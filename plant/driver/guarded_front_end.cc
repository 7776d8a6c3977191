#include "plant/driver/guarded_front_end.h"

#include <memory>

#include "plant/driver/zero_guardian.h"
#include "pressure_ctrl/pressure_app.h"

namespace hydro::plant {

GuardedFrontEnd::GuardedFrontEnd(const settings::StackConfig& config, const bus::Clock& clock)
    : FrontEndRig(config, clock) {
  Connect();
  ArmZero(zero_, 0);
}

GuardedFrontEnd::~GuardedFrontEnd() {
  ZeroAtOnce();
  DisarmZero();
}

double GuardedFrontEnd::Drive(double voltage) {
  if (guardian_) guardian_->Require();
  return FrontEndRig::Drive(voltage);
}

// A guardian that held a cut link open would keep its port from being opened again. Until the device is up
// there are no volts of this driver's, and what a guardian took away would be those of another, for whose
// device this one waits.
void GuardedFrontEnd::OnLink(int descriptor) {
  const int now = connection().was_up() ? descriptor : -1;
  if (now == guarded_) return;
  guardian_.reset();
  if (now >= 0) guardian_ = std::make_unique<ZeroGuardian>(guardians_zero_, std::vector{now}, 0);
  guarded_ = now;
}

std::function<void()> LeadLoopOnDevice(bus::Bus& bus, bus::Clock& clock, const settings::StackConfig& config,
                                       Rig& rig) {
  const settings::DriverSection& driver = *config.driver;
  const bool leads = driver.kind == settings::DriverKind::kFrontEnd &&
                     driver.front_end.mode == settings::FrontEndMode::kLoopOnDevice;
  auto* const front_end = dynamic_cast<FrontEndRig*>(&rig);
  if (!leads || front_end == nullptr) return {};
  const auto app = std::make_shared<pressure_ctrl::PressureApp>(bus, clock, config, *front_end);
  front_end->set_beside([app] { app->Poll(); });
  return [app, front_end] {
    front_end->set_beside({});
    app->Finish();
  };
}

}  // namespace hydro::plant
