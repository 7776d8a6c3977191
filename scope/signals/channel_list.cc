#include "scope/signals/channel_list.h"

#include "base/units.h"

namespace hydro::scope {
namespace {

struct Row {
  const char* id;
  const char* label;
  const char* group;
  const char* unit;  // in the paper
  int arm = 0;       // UnitSystem::UnitFor
  bool step = false;
};

constexpr std::array<Row, kTickColumns> kTickRows{{
    {"dp", "pressure difference p2 - p1", "pressure", "psi"},
    {"dp_ref", "reference of the pressure difference", "pressure", "psi", 0, true},
    {"pressure_error", "dp_ref - dp", "pressure", "psi"},
    {"p1", "pressure of side 1", "pressure", "psi"},
    {"p2", "pressure of side 2", "pressure", "psi"},
    {"arm_angle", "arm angle", "arm", "rad", 1},
    {"arm_ref", "reference of the arm angle", "arm", "rad", 1, true},
    {"arm_speed", "arm speed", "arm", "rad/s", 1},
    {"motor_speed", "motor speed", "motor", "rad/s"},
    {"motor_angle", "motor angle", "motor", "rad"},
    {"voltage", "voltage that acted until this tick", "voltage", "V", 0, true},
    {"voltage_asked", "voltage that the pressure loop asked for at this tick", "voltage", "V", 0, true},
    {"saturated", "the law asked for more than the motor can do", "voltage", "", 0, true},
    {"latency_us", "from a state's arrival here to that of the command for it", "timing", "us"},
    {"period_us", "between the arrivals of two states here", "timing", "us"},
    {"skipped_ticks", "ticks without a state before this one", "timing", "", 0, true},
}};

constexpr std::array<Row, kGhostColumns> kGhostRows{{
    {"ghost.p1", "model: pressure of side 1", "pressure", "psi"},
    {"ghost.p2", "model: pressure of side 2", "pressure", "psi"},
    {"ghost.dp", "model: pressure difference", "pressure", "psi"},
    {"ghost.motor_speed", "model: motor speed", "motor", "rad/s"},
    {"ghost.arm_angle", "model: arm angle", "arm", "rad", 1},
    {"residual.p1", "measured - model, side 1", "residual", "sigma"},
    {"residual.p2", "measured - model, side 2", "residual", "sigma"},
    {"residual.motor_speed", "measured - model, motor speed", "residual", "sigma"},
}};

template <class Rows>
std::vector<ChannelInfo> Described(const Rows& rows, const UnitSystem& units) {
  std::vector<ChannelInfo> channels;
  channels.reserve(rows.size());
  for (const Row& row : rows) {
    ChannelInfo info{.id = row.id,
                     .label = row.label,
                     .group = row.group,
                     .unit = row.unit,
                     .step = row.step,
                     .si_unit = {}};
    const std::string paper = row.unit;
    if (!paper.empty() && paper != "us" && paper != "sigma" && paper != "V") {
      info.unit = units.UnitFor(paper, row.arm);
      if (const auto si = FindSiUnit(info.unit, paper == "psi" ? 1000 : 1)) {
        info.si_unit = si->to;
        info.si_factor = si->factor;
      }
    }
    channels.push_back(std::move(info));
  }
  return channels;
}

}  // namespace

std::vector<ChannelInfo> TickChannels(const UnitSystem& units) { return Described(kTickRows, units); }

std::vector<ChannelInfo> GhostChannels(const UnitSystem& units) { return Described(kGhostRows, units); }

std::vector<ChannelInfo> LoopChannels(const std::string& role) {
  const std::array<Row, kLoopColumns> rows{{
      {"", "latency of the loop, 99th percentile of a second", "timing", "us", 0, true},
      {"", "deadlines missed in a second", "timing", "", 0, true},
  }};
  std::vector<ChannelInfo> channels = Described(rows, UnitSystem{});
  channels[0].id = "loop." + role + ".latency_p99_us";
  channels[1].id = "loop." + role + ".missed";
  for (ChannelInfo& channel : channels) channel.label = role + ": " + channel.label;
  return channels;
}

}  // namespace hydro::scope
