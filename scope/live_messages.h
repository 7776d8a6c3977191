// The messages from the server to a page, as JSON (docs/developers/scope_protocol.md).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "scope/signals/run.h"
#include "settings/stack_config.h"

namespace hydro::scope {

std::string HelloMessage(const std::vector<const Run*>& runs, bool control);
std::string RunsMessage(const std::vector<const Run*>& runs);
std::string EventMessage(const Run& run, const Event& event);
std::string ProcessesMessage(const Run& run);
// `silent_s` is the wall time since the last state; negative: none has come.
std::string ClockMessage(const Run& run, double silent_s);
std::string DroppedMessage(uint64_t bins, uint64_t frames);
std::string TriggerMessage(uint32_t id, double t, const std::string& state);
// `data`: JSON; empty: none.
std::string ReplyMessage(uint32_t id, bool ok, const std::string& text, const std::string& data = {});

// A run as "hello", "runs" and /api/status describe it, and a list of runs.
std::string RunJson(const Run& run);

// A list of numbers, exact, with null for missing values.
std::string NumbersJson(const std::vector<double>& numbers);
// A text as JSON.
std::string TextJson(const std::string& text);

}  // namespace hydro::scope
