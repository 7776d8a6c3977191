#include "model/arm/arm_description.h"

#include <cmath>
#include <sstream>
#include <string>

#include "model/terms/model_error.h"

namespace hydro::model {
namespace {

[[noreturn]] void Refuse(const std::string& name, double value, const std::string& allowed) {
  std::ostringstream text;
  text.precision(6);
  text << name << " = " << value << "; allowed is " << allowed;
  throw ModelError(text.str());
}

void CheckLink(const ArmLink& link, const std::string& name) {
  if (!(link.mass > 0 && std::isfinite(link.mass))) Refuse(name + "mass", link.mass, "above 0");
  if (!(link.length > 0 && std::isfinite(link.length))) Refuse(name + "length", link.length, "above 0");
  if (!std::isfinite(link.centre)) Refuse(name + "centre", link.centre, "a finite number");
  if (!(link.inertia >= 0 && std::isfinite(link.inertia))) Refuse(name + "inertia", link.inertia, "from 0");
  if (!std::isfinite(link.angle)) Refuse(name + "angle", link.angle, "a finite number");
  if (!(link.inertia + link.mass * link.centre * link.centre > 0)) {  // the mass matrix would be singular
    Refuse(name + "inertia", link.inertia, "above 0 where centre = 0");
  }
}

}  // namespace

void ArmDescription::Check() const {
  if (!std::isfinite(gravity)) Refuse("arm: gravity", gravity, "a finite number");
  if (!(payload >= 0 && std::isfinite(payload))) Refuse("arm: payload", payload, "from 0");
  if (links.empty() || links.size() > kMostLinks) {
    Refuse("arm: number of links", static_cast<double>(links.size()), "1 to " + std::to_string(kMostLinks));
  }
  for (size_t i = 0; i < links.size(); ++i) CheckLink(links[i], "arm.link " + std::to_string(i + 1) + ": ");
}

}  // namespace hydro::model
