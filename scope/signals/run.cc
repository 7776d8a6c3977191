#include "scope/signals/run.h"

#include <utility>

#include "base/input_error.h"
#include "runs/recorded/run_config.h"

namespace hydro::scope {

const Event& EventList::Add(Event event) {
  event.n = ++last_;
  events_.push_back(std::move(event));
  if (events_.size() > kMost) events_.pop_front();
  return events_.back();
}

namespace {

std::optional<size_t> IndexOf(const std::vector<ChannelInfo>& channels, const std::string& id) {
  for (size_t i = 0; i < channels.size(); ++i) {
    if (channels[i].id == id) return i;
  }
  return std::nullopt;
}

}  // namespace

Run::Run(uint32_t its_id, std::string its_name, Kind its_kind, uint64_t most_rows)
    : id(its_id),
      name(std::move(its_name)),
      kind(its_kind),
      ticks(kTickColumns, most_rows),
      ghost(kGhostColumns, most_rows),
      tick_channels_(TickChannels(UnitSystem{})),
      ghost_channels_(GhostChannels(UnitSystem{})) {}

void Run::Describe(const run_description_t& given) {
  const bool same = description && description->config_text == given.config_text &&
                    description->model_text == given.model_text && description->session == given.session;
  if (same) return;
  description = given;
  rate_hz = given.rate_hz;
  of_a_limb = of_a_limb || given.program == "hydro-limb";
  config = nullptr;
  config_problem.clear();
  ++revision;
  try {
    const UnitSystem units = runs::ModelUnits(given, name);
    tick_channels_ = TickChannels(units);
    ghost_channels_ = GhostChannels(units);
    if (given.config_text.empty()) throw InputError("it has no configuration, like every imported table");
    config = std::make_shared<const settings::StackConfig>(settings::ParseStackConfig(
        given.config_text, name + " (HYDRO_RUN)", given.model_text, given.model_file));
  } catch (const InputError& error) {
    config_problem = error.what();
  }
}

std::optional<Signal> Run::Find(const std::string& channel_id) const {
  if (const auto column = IndexOf(tick_channels_, channel_id)) {
    // A limb's sample lasts until the next one. A longer time without samples is a gap.
    const bool sampled = sample_ticks > 1 && rate_hz > 0;
    return Signal{&ticks, *column, sampled ? kSampleHold * static_cast<double>(sample_ticks) / rate_hz : 0};
  }
  if (const auto column = IndexOf(ghost_channels_, channel_id)) return Signal{&ghost, *column, 0};
  for (const auto& [role, history] : loops) {
    if (const auto column = IndexOf(LoopChannels(role), channel_id)) {
      return Signal{&history, *column, kLoopHold};
    }
  }
  return std::nullopt;
}

std::vector<ChannelInfo> Run::Channels() const {
  std::vector<ChannelInfo> channels = tick_channels_;
  if (!ghost.empty()) channels.insert(channels.end(), ghost_channels_.begin(), ghost_channels_.end());
  for (const auto& [role, history] : loops) {
    for (ChannelInfo& channel : LoopChannels(role)) channels.push_back(std::move(channel));
  }
  return channels;
}

size_t Run::memory() const {
  size_t bytes = ticks.memory() + ghost.memory() + (messages != nullptr ? messages->memory() : 0);
  for (const auto& [role, history] : loops) bytes += history.memory();
  return bytes;
}

}  // namespace hydro::scope
