// The conversation with a front end (docs/front_end.md): the device identifies itself and gets its settings;
// then samples go one way and commands the other. Time is passed in; nothing waits.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bus/clock.h"
#include "firmware/frames.h"
#include "plant/front_end/link.h"

namespace hydro::plant {

// Counts what has become of the frames since the start.
struct FrameCounts {
  int64_t samples = 0;         // taken
  int64_t lost = 0;            // of the device's frames, by gaps in their sequence
  int64_t jumps = 0;           // of that sequence, farther than the device can have sent meanwhile
  int64_t damaged = 0;         // that arrived here
  int64_t refused = 0;         // intact, but of another session, old or repeated
  int64_t left_out = 0;        // commands for which the link was too slow
  int64_t device_damaged = 0;  // that the device reports
  int64_t device_refused = 0;  // that the device reports
};

class Connection {
 public:
  using TimePoint = bus::Clock::TimePoint;

  // Returns the settings for a device; throws InputError when it is the wrong device for the configuration.
  using SettingsFor = std::function<hydro_settings(const hydro_identity&)>;

  // `file` is the configuration file, for errors. `session` is a random number other than 0.
  Connection(std::string file, std::unique_ptr<Link> link, uint32_t session, SettingsFor settings_for);

  // Takes everything that has come, and goes on with the handshake where one is due, also after the link was
  // cut or the device has reset itself. Until is_up() was true for the first time, it throws InputError like
  // SettingsFor, or when the device refuses its settings; later, unfit() says so.
  void Poll(TimePoint now);

  // Whether the device holds the settings and has sent a sample since.
  bool is_up() const { return link_->is_open() && phase_ == Phase::kUp && sampled_; }
  bool was_up() const { return was_up_; }
  bool link_is_open() const { return link_->is_open(); }

  // These are meaningful once is_up() was true.
  const hydro_identity& identity() const { return identity_; }
  const hydro_settings& settings() const { return settings_; }
  const hydro_sample& sample() const { return sample_; }
  TimePoint sampled_at() const { return sampled_at_; }  // when the newest sample came

  // How often the device has restarted while this connection was up.
  int64_t resets() const { return resets_; }

  // What the device says of itself since its last restart that it had said differently before; empty:
  // nothing.
  const std::string& change() const { return change_; }

  // In what the device that answers now differs from the one with which the run began, so that it cannot be
  // driven; empty: in nothing. It may still hear AskForZero().
  const std::string& unfit() const { return unfit_; }

  // Of the newest jump of the device's sequence: the number before it and the one after.
  std::pair<uint32_t, uint32_t> jump() const { return jump_; }
  const FrameCounts& counts() const { return counts_; }
  const Link& link() const { return *link_; }

  // Whether a front end answers, but none of this protocol has.
  bool hears_another_protocol() const { return other_protocol_ != 0; }

  // Why there is no connection yet, for a message: what was found and what is allowed.
  LinkTrouble WhyNot() const;

  // From where answers have come, since the device was asked in vain, that are not used: "127.0.0.1:7701".
  // Empty: from nowhere.
  const std::string& elsewhere() const { return elsewhere_; }

  // Asks the device to arm, unless it was asked a moment ago. The device arms only if it has tripped exactly
  // `trips` times.
  void AskToArm(TimePoint now, uint32_t trips);
  // Commands for the computer's tick. The device's samples name them by the sequence that is returned.
  uint32_t CommandVoltage(int64_t host_tick, float voltage);
  uint32_t CommandPressure(int64_t host_tick, float pressure_ref, const hydro_gains& gains);
  // Asks the device to disarm, unless it was asked a moment ago, or its volts are another session's.
  void AskForZero(TimePoint now);
  // Whether the device says that another session is in charge and may be believed. A device that was armed
  // for this one a moment ago may not: no session can take it over so soon.
  bool IsAnothers(TimePoint now) const;
  // Keeps the session in charge while there is nothing to command.
  void KeepAlive(TimePoint now);
  // Asks for zero volts until re-armed. Asks nothing of a device that another session commands where this one
  // was never up: it has no volts there to take back, and would stop the other's run. Async-signal-safe.
  void Zero() const noexcept {
    if (was_up_ || !AnotherIsInCharge()) link_->WriteAtOnce({zero_frame_.data(), zero_bytes_});
  }

 private:
  // Whether the device says so; one that has said nothing yet does not.
  bool AnotherIsInCharge() const noexcept {
    return identity_.session_in_charge != 0 && identity_.session_in_charge != session_;
  }
  enum class Phase { kHello, kSettings, kUp };

  void Reopen(TimePoint now);
  void Greet();
  void Receive(TimePoint now);
  void Take(const hydro_frame& frame, TimePoint now);
  bool IsNewer(const hydro_frame& frame, TimePoint now);
  double MostSentSince(TimePoint before, TimePoint now) const;
  bool BeganAnew(const hydro_frame& frame, TimePoint now);
  void OnIdentity(const hydro_frame& frame, TimePoint now);
  bool TakeSettingsFor(const hydro_identity& identity);
  void OnHeld(const hydro_settings_held& held);
  void OnSample(const hydro_sample& sample, TimePoint now);
  void CountOfDevice(const hydro_sample& sample);
  bool Due(TimePoint now, bus::Clock::Duration period);
  void Send(uint8_t kind);
  void Send(hydro_frame* frame);

  const std::string file_;
  std::unique_ptr<Link> link_;
  const uint32_t session_;
  const SettingsFor settings_for_;
  std::array<uint8_t, HYDRO_WIRE_MAX> zero_frame_{};
  size_t zero_bytes_ = 0;

  Phase phase_ = Phase::kHello;
  bool was_up_ = false;
  TimePoint next_open_{};
  TimePoint next_request_{};  // of HELLO, SETTINGS
  TimePoint next_arm_{};
  TimePoint next_zero_{};
  uint32_t sent_ = 0;  // sequence of the newest frame sent
  hydro_receiver receiver_{};
  int64_t damaged_before_ = 0;   // by receivers before
  bool heard_ = false;           // whether a frame of this device came; the next is judged by its sequence
  uint32_t newest_ = 0;          // its sequence
  TimePoint newest_at_{};        // when that came
  std::optional<uint32_t> old_;  // sequence of an IDENTITY that came later and was not newer
  std::optional<uint32_t>
      far_;  // of a frame that came later, with a number that the device cannot have reached
  std::pair<uint32_t, uint32_t> jump_{};
  int64_t bytes_ = 0;
  int64_t echoes_ = 0;    // our own frames that came back
  bool greeted_ = false;  // since the newest sample
  std::string elsewhere_;
  uint8_t other_protocol_ = 0;  // of the device that answers; 0: it is ours

  hydro_identity identity_{};
  hydro_identity fitting_{};  // the newest for which there are settings
  std::string unfit_, change_;
  bool identified_ = false;
  bool compared_ = false;  // the device has said that it holds the settings of `fingerprint_`
  hydro_settings settings_{};
  uint32_t fingerprint_ = 0;
  hydro_sample sample_{};
  bool sampled_ = false;
  TimePoint sampled_at_{};
  int64_t resets_ = 0;
  FrameCounts counts_;
};

}  // namespace hydro::plant
