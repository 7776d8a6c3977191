#include "plant/front_end/connection.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <array>
#include <utility>

#include "plant/front_end/refusals.h"
#include "settings/toml/section_reader.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;

constexpr auto kRequestPeriod = 50ms;  // for requests that are repeated until the answer comes
constexpr auto kOpenPeriod = 100ms;
constexpr auto kKeepAlivePeriod = 100ms;
constexpr auto kFreeAfter = 250ms;  // the device gives up on a session that it has not heard for so long
constexpr size_t kChunk = 4096;
constexpr int kMostChunks = 64;  // in one call: a flood on the link must not stop the loop
// Of the frames that a device can have sent within a time: its clock may be faster, and a second may have
// been on its way.
constexpr double kFaster = 2, kOnTheWay_s = 1;
constexpr auto kAnewAfter = 250ms;  // without a newer frame: a late one is not that late

bool SameSettings(const hydro_settings& a, const hydro_settings& b) {
  std::array<uint8_t, HYDRO_WIRE_MAX> wires[2] = {};
  hydro_frame frame{};
  frame.kind = HYDRO_SETTINGS;
  frame.body.settings = a;
  const size_t bytes = hydro_encode(&frame, wires[0].data());
  frame.body.settings = b;
  return hydro_encode(&frame, wires[1].data()) == bytes && wires[0] == wires[1];
}

// Whether what a device says of itself and what cannot change without a reset is the same.
bool SameDevice(const hydro_identity& a, const hydro_identity& b) {
  return a.boot == b.boot && a.modes == b.modes && a.tick_rate_hz == b.tick_rate_hz &&
         a.analog_inputs == b.analog_inputs && a.counters == b.counters && a.output_min_V == b.output_min_V &&
         a.output_max_V == b.output_max_V && std::equal(a.firmware, a.firmware + 3, b.firmware) &&
         std::equal(a.board, a.board + HYDRO_BOARD_NAME_BYTES, b.board);
}

}  // namespace

Connection::Connection(std::string file, std::unique_ptr<Link> link, uint32_t session,
                       SettingsFor settings_for)
    : file_(std::move(file)),
      link_(std::move(link)),
      session_(session),
      settings_for_(std::move(settings_for)) {
  hydro_frame zero{};
  zero.kind = HYDRO_ZERO;
  zero.session = session_;
  zero_bytes_ = hydro_encode(&zero, zero_frame_.data());
}

void Connection::Poll(TimePoint now) {
  if (!link_->is_open()) Reopen(now);
  const int64_t before = counts_.samples;
  Receive(now);
  if (counts_.samples != before) link_->ForgetOld();
  link_->Flush();
  counts_.damaged = damaged_before_ + receiver_.bad;
  counts_.left_out = link_->frames_left_out();
  if (phase_ == Phase::kHello && Due(now, kRequestPeriod)) Greet();
  if (phase_ == Phase::kSettings && Due(now, kRequestPeriod)) {
    hydro_frame frame{};
    frame.kind = HYDRO_SETTINGS;
    frame.body.settings = settings_;
    Send(&frame);
  }
  // No samples come: the device may have reset itself, and then knows no session until it is greeted.
  if (phase_ == Phase::kUp && now - sampled_at_ > kRequestPeriod && Due(now, kRequestPeriod)) Greet();
}

// What has come from elsewhere since the HELLO before answers it, and tells where the device is.
void Connection::Greet() {
  const std::string from = link_->HeardElsewhere();
  if (greeted_ && !from.empty()) elsewhere_ = from;
  greeted_ = true;
  Send(HYDRO_HELLO);
}

void Connection::Reopen(TimePoint now) {
  if (now < next_open_) return;
  next_open_ = now + kOpenPeriod;
  if (!link_->Open()) return;
  hydro_receive_anew(&receiver_);
  phase_ = Phase::kHello;
  next_request_ = now;
}

void Connection::Receive(TimePoint now) {
  std::array<uint8_t, kChunk> chunk;
  hydro_frame frame{};
  for (int i = 0; i < kMostChunks; ++i) {
    const size_t got = link_->Read(chunk);
    bytes_ += static_cast<int64_t>(got);
    for (size_t at = 0; at < got; ++at) {
      if (hydro_receive(&receiver_, chunk[at], &frame)) Take(frame, now);
    }
    if (got < chunk.size()) return;
  }
}

void Connection::Take(const hydro_frame& frame, TimePoint now) {
  if (frame.kind < HYDRO_IDENTITY) {
    ++echoes_;
    return;
  }
  if (frame.kind == HYDRO_IDENTITY) return OnIdentity(frame, now);
  if (frame.session != session_ || !IsNewer(frame, now)) {
    ++counts_.refused;
    return;
  }
  if (frame.kind == HYDRO_SETTINGS_HELD) OnHeld(frame.body.held);
  if (frame.kind == HYDRO_SAMPLE) OnSample(frame.body.sample, now);
}

// Frames that are not newer count for nothing, not even as a sign of life. Nor does a single one with a
// number that the device cannot have reached, or nothing would be newer for a long time: only another one
// that goes on from there shows that the device does.
bool Connection::IsNewer(const hydro_frame& frame, TimePoint now) {
  if (heard_ && !hydro_is_newer(frame.sequence, newest_)) return false;
  const uint32_t missing = heard_ ? frame.sequence - newest_ - 1 : 0;
  const double most = MostSentSince(newest_at_, now);
  if (missing > 0 && missing > most) {
    const bool goes_on = far_ && hydro_is_newer(frame.sequence, *far_) && frame.sequence - *far_ - 1 <= most;
    far_ = frame.sequence;
    if (!goes_on) return false;
    ++counts_.jumps;
    jump_ = {newest_, frame.sequence};
  } else {
    counts_.lost += missing;
  }
  heard_ = true;
  newest_ = frame.sequence;
  newest_at_ = now;
  old_.reset();
  far_.reset();
  return true;
}

// Samples, and answers to what is asked.
double Connection::MostSentSince(TimePoint before, TimePoint now) const {
  const double samples_per_s =
      static_cast<double>(identity_.tick_rate_hz) / std::max<int>(settings_.sample_interval_ticks, 1);
  const double answers_per_s = 2 / bus::ToSeconds(kRequestPeriod);
  return (samples_per_s + answers_per_s) * (kFaster * bus::ToSeconds(now - before) + kOnTheWay_s);
}

// Whether the device numbers its frames anew though it says that it is the same: nothing newer comes, and its
// answers rise from a lower number.
bool Connection::BeganAnew(const hydro_frame& frame, TimePoint now) {
  if (!heard_ || hydro_is_newer(frame.sequence, newest_) || now - newest_at_ < kAnewAfter) return false;
  const bool rises = old_ && hydro_is_newer(frame.sequence, *old_);
  old_ = frame.sequence;
  return rises;
}

void Connection::OnIdentity(const hydro_frame& frame, TimePoint now) {
  if (frame.protocol != HYDRO_PROTOCOL) {
    other_protocol_ = frame.protocol;
    return;
  }
  const hydro_identity& identity = frame.body.identity;
  const bool another = !identified_ || !SameDevice(identity, identity_) || BeganAnew(frame, now);
  if (another) heard_ = false;  // the device's sequence begins anew
  if (!IsNewer(frame, now)) {
    ++counts_.refused;
    return;
  }
  other_protocol_ = 0;
  if (another && identified_ && was_up_) {
    ++resets_;
    change_ = DescribeChange(identity_, identity);
  }
  identified_ = true;
  identity_ = identity;
  if (identity.session_in_charge != session_) {
    phase_ = Phase::kHello;
    return;
  }
  if (phase_ == Phase::kUp && !another && identity.fingerprint == fingerprint_) return;
  sampled_ = false;
  if (!TakeSettingsFor(identity)) return;
  // After a cut link the device may still hold the settings, and may even be armed. Those that it kept from
  // another program or another start are compared first, all 192 bytes: a fingerprint is only its word.
  compared_ = compared_ && !another && identity.fingerprint == fingerprint_;
  phase_ = compared_ ? Phase::kUp : Phase::kSettings;
  next_request_ = {};
}

// In the run, a device that does not fit the configuration is no error of the configuration, to which an
// earlier one did fit.
bool Connection::TakeSettingsFor(const hydro_identity& identity) {
  try {
    settings_ = settings_for_(identity);
  } catch (const InputError&) {
    if (!was_up_) throw;
    unfit_ = "is not the one with which the run began: " + DescribeChange(fitting_, identity);
    phase_ = Phase::kHello;
    return false;
  }
  unfit_.clear();
  fitting_ = identity;
  fingerprint_ = hydro_fingerprint(&settings_);
  return true;
}

void Connection::OnHeld(const hydro_settings_held& held) {
  if (phase_ != Phase::kSettings) return;
  if (held.refused != HYDRO_TAKEN && was_up_) {
    unfit_ = "refuses the settings that it had taken when the run began: " + DescribeRefusal(held);
    return;
  }
  if (held.refused != HYDRO_TAKEN) throw RefusalError(file_, held);
  if (held.fingerprint != fingerprint_ || !SameSettings(held.settings, settings_)) {
    const std::string found =
        fmt::format("holds other settings (fingerprint {:08x}) than those that it was sent ({:08x})",
                    held.fingerprint, fingerprint_);
    if (was_up_) {
      unfit_ = found;
      return;
    }
    throw settings::KeyError(file_, "driver.url", "a front end that " + found,
                             "one that keeps them: give it the firmware of this version");
  }
  unfit_.clear();
  compared_ = true;
  phase_ = Phase::kUp;
}

void Connection::OnSample(const hydro_sample& sample, TimePoint now) {
  if (phase_ != Phase::kUp) return;
  CountOfDevice(sample);
  sample_ = sample;
  sampled_ = true;
  sampled_at_ = now;
  was_up_ = true;
  greeted_ = false;
  elsewhere_.clear();
  ++counts_.samples;
}

// The device's counts wrap at 2^16.
void Connection::CountOfDevice(const hydro_sample& sample) {
  if (!sampled_) return;
  counts_.device_damaged += static_cast<uint16_t>(sample.frames_bad - sample_.frames_bad);
  counts_.device_refused += static_cast<uint16_t>(sample.frames_refused - sample_.frames_refused);
}

bool Connection::Due(TimePoint now, bus::Clock::Duration period) {
  if (now < next_request_) return false;
  next_request_ = now + period;
  return true;
}

void Connection::Send(uint8_t kind) {
  hydro_frame frame{};
  frame.kind = kind;
  Send(&frame);
}

void Connection::Send(hydro_frame* frame) {
  frame->session = session_;
  frame->sequence = ++sent_;
  std::array<uint8_t, HYDRO_WIRE_MAX> wire;
  const size_t bytes = hydro_encode(frame, wire.data());
  const bool each_tick = frame->kind == HYDRO_VOLTAGE || frame->kind == HYDRO_PRESSURE;
  link_->Write({wire.data(), bytes}, !each_tick);
}

void Connection::AskToArm(TimePoint now, uint32_t trips) {
  if (now < next_arm_) return;
  next_arm_ = now + kRequestPeriod;
  hydro_frame frame{};
  frame.kind = HYDRO_ARM;
  frame.body.arm = {.fingerprint = fingerprint_, .trips = trips};
  Send(&frame);
}

uint32_t Connection::CommandVoltage(int64_t host_tick, float voltage) {
  hydro_frame frame{};
  frame.kind = HYDRO_VOLTAGE;
  frame.body.command.fingerprint = fingerprint_;
  frame.body.command.host_tick = host_tick;
  frame.body.command.voltage = voltage;
  Send(&frame);
  return sent_;
}

uint32_t Connection::CommandPressure(int64_t host_tick, float pressure_ref, const hydro_gains& gains) {
  hydro_frame frame{};
  frame.kind = HYDRO_PRESSURE;
  frame.body.command.fingerprint = fingerprint_;
  frame.body.command.host_tick = host_tick;
  frame.body.command.pressure_ref = pressure_ref;
  frame.body.command.gains = gains;
  Send(&frame);
  return sent_;
}

void Connection::AskForZero(TimePoint now) {
  if (now < next_zero_ || IsAnothers(now)) return;
  next_zero_ = now + kRequestPeriod;
  Send(HYDRO_ZERO);
}

bool Connection::IsAnothers(TimePoint now) const {
  return AnotherIsInCharge() && (!was_up_ || sample_.state != HYDRO_ARMED || now - sampled_at_ >= kFreeAfter);
}

void Connection::KeepAlive(TimePoint now) {
  if (phase_ == Phase::kUp && Due(now, kKeepAlivePeriod)) Send(HYDRO_HELLO);
}

LinkTrouble Connection::WhyNot() const {
  if (!link_->is_open()) {
    if (!link_->trouble().found.empty()) return link_->trouble();
    return {"a link that was cut", "one that stays: is the device powered, the cable whole?"};
  }
  if (other_protocol_ != 0) {
    return {fmt::format("a front end that speaks protocol {}", other_protocol_),
            fmt::format("protocol {}: give it the firmware of this version (docs/front_end.md)",
                        int{HYDRO_PROTOCOL})};
  }
  if (identified_ && identity_.session_in_charge == 0) {
    return {"a front end that no session commands, and that does not take this one",
            "one whose firmware takes the session of a HELLO (docs/front_end.md)"};
  }
  if (identified_ && AnotherIsInCharge()) {
    return {fmt::format("a front end that another program commands (its session is {:08x})",
                        identity_.session_in_charge),
            "one that nobody else commands: end that program, or cut the device's power for a moment"};
  }
  if (identified_) {
    return {"a front end that says who it is, but sends no samples",
            "one whose firmware runs (docs/front_end.md)"};
  }
  if (echoes_ > 0) {
    return {"only what this computer itself had sent",
            "a front end, and not a cable that leads back or a terminal that echoes"};
  }
  if (!elsewhere_.empty()) {
    return {
        "answers from " + elsewhere_ + ", which are not used, and no others",
        "a front end that answers from the address that it is asked at: give its own in driver.url, or let "
        "its firmware answer from the port that it listens on"};
  }
  if (bytes_ > 0) {
    return {fmt::format("{} bytes that are no frames", bytes_),
            "a front end (docs/front_end.md): is it another device, or another baud rate?"};
  }
  return {
      "nothing that answers",
      "a front end (docs/front_end.md): is it powered, does its firmware run, is the address its own, and "
      "does no other program have it?"};
}

}  // namespace hydro::plant
