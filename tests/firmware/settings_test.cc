#include "firmware/settings.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/firmware/device_bench.h"

namespace hydro::firmware {
namespace {

using testing::BenchFacts;
using testing::BenchSettings;
using testing::kInfinity;

hydro_refusal Check(const hydro_settings& settings, uint8_t* part = nullptr) {
  const hydro_board_facts facts = BenchFacts();
  uint8_t unused = 0;
  return hydro_check_settings(&settings, &facts, part ? part : &unused);
}

// Tests that settings are taken whose limits are at their ends.
TEST(SettingsTest, Taken) {
  EXPECT_EQ(Check(BenchSettings(HYDRO_REMOTE_IO)), HYDRO_TAKEN);
  hydro_settings settings = BenchSettings(HYDRO_LOOP_ON_DEVICE);
  settings.watchdog_ticks = 1;
  settings.sample_interval_ticks = 1000;
  settings.pressure_limit = settings.motor_speed_limit = settings.arm_angle_limit = kInfinity;
  settings.sensors[HYDRO_MOTOR_ANGLE].counter_bits = 32;
  settings.sensors[HYDRO_ARM_ANGLE] = settings.sensors[HYDRO_ARM_SPEED] = {};
  EXPECT_EQ(Check(settings), HYDRO_TAKEN);
}

// Tests each reason for a refusal, and which sensor it names.
TEST(SettingsTest, Refused) {
  struct Case {
    const char* what;
    hydro_refusal refusal;
    std::function<void(hydro_settings&)> change;
  };
  const std::vector<Case> cases = {
      {"mode 0", HYDRO_REFUSED_MODE, [](auto& s) { s.mode = 0; }},
      {"mode 3", HYDRO_REFUSED_MODE, [](auto& s) { s.mode = 3; }},
      {"no interval", HYDRO_REFUSED_INTERVAL, [](auto& s) { s.sample_interval_ticks = 0; }},
      {"long interval", HYDRO_REFUSED_INTERVAL, [](auto& s) { s.sample_interval_ticks = 1001; }},
      {"no watchdog", HYDRO_REFUSED_WATCHDOG, [](auto& s) { s.watchdog_ticks = 0; }},
      {"long watchdog", HYDRO_REFUSED_WATCHDOG, [](auto& s) { s.watchdog_ticks = 1001; }},
      {"voltage", HYDRO_REFUSED_LIMIT, [](auto& s) { s.voltage_limit = 0; }},
      {"pressure", HYDRO_REFUSED_LIMIT, [](auto& s) { s.pressure_limit = -1; }},
      {"speed", HYDRO_REFUSED_LIMIT, [](auto& s) { s.motor_speed_limit = NAN; }},
      {"angle", HYDRO_REFUSED_LIMIT, [](auto& s) { s.arm_angle_limit = -kInfinity; }},
      {"reference", HYDRO_REFUSED_LIMIT, [](auto& s) { s.reference_limit = NAN; }},
      {"scale 0", HYDRO_REFUSED_OUTPUT, [](auto& s) { s.output_scale = 0; }},
      {"scale", HYDRO_REFUSED_OUTPUT, [](auto& s) { s.output_scale = kInfinity; }},
      {"offset", HYDRO_REFUSED_OUTPUT, [](auto& s) { s.output_offset = NAN; }},
      {"tolerance", HYDRO_REFUSED_OUTPUT, [](auto& s) { s.read_back_tolerance = -1; }},
      {"no zero", HYDRO_REFUSED_ZERO, [](auto& s) { s.output_offset = 20.5F; }},
      {"kind", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[0].kind = 4; }},
      {"channel", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[1].channel = 4; }},
      {"scale", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[1].scale = NAN; }},
      {"no share", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[1].low_pass_share = 0; }},
      {"share", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[3].low_pass_share = 1.1F; }},
      {"ends", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[1].minimum_V = 5, s.sensors[1].maximum_V = 4; }},
      {"end", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[1].minimum_V = NAN; }},
      {"few bits", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[2].counter_bits = 7; }},
      {"many bits", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[2].counter_bits = 33; }},
      {"counter", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[2].channel = 2; }},
      {"counted p1", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[0] = s.sensors[2]; }},
      {"rate of nothing", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[4] = {}; }},
      {"rate of p1", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[1] = s.sensors[3]; }},
      {"angle as rate", HYDRO_REFUSED_SENSOR, [](auto& s) { s.sensors[2] = s.sensors[3]; }},
      {"no p2", HYDRO_REFUSED_MISSING, [](auto& s) { s.sensors[1] = {}; }},
      {"no speed", HYDRO_REFUSED_MISSING, [](auto& s) { s.sensors[3] = {}; }},
      {"no arm", HYDRO_REFUSED_MISSING, [](auto& s) { s.sensors[4] = s.sensors[5] = {}; }},
  };
  for (const Case& each : cases) {
    hydro_settings settings = BenchSettings();
    each.change(settings);
    EXPECT_EQ(Check(settings), each.refusal) << each.what;
  }
  hydro_settings settings = BenchSettings();
  settings.sensors[HYDRO_ARM_SPEED].low_pass_share = NAN;
  uint8_t part = 0;
  EXPECT_EQ(Check(settings, &part), HYDRO_REFUSED_SENSOR);
  EXPECT_EQ(part, HYDRO_ARM_SPEED);
}

// Tests that remote I/O without limits needs no sensors, and the loop on the device those of eq. (16).
TEST(SettingsTest, WhatAModeNeeds) {
  hydro_settings settings = BenchSettings();
  settings.pressure_limit = settings.motor_speed_limit = settings.arm_angle_limit = kInfinity;
  for (hydro_sensor_settings& sensor : settings.sensors) sensor = {};
  EXPECT_EQ(Check(settings), HYDRO_TAKEN);
  settings.mode = HYDRO_LOOP_ON_DEVICE;
  EXPECT_EQ(Check(settings), HYDRO_REFUSED_MISSING);
}

// Tests the voltages that an inverting amplifier with an offset reaches, and the limit within them.
TEST(SettingsTest, VoltageRange) {
  hydro_settings settings = BenchSettings();  // -2 V per V, 0.5 V: -19.5 to 20.5 V
  const hydro_board_facts facts = BenchFacts();
  settings.voltage_limit = 20;
  hydro_voltage_range range = hydro_reachable_voltages(&settings, &facts);
  EXPECT_FLOAT_EQ(range.low, -19.5);
  EXPECT_FLOAT_EQ(range.high, 20);
  settings.voltage_limit = kInfinity;
  range = hydro_reachable_voltages(&settings, &facts);
  EXPECT_FLOAT_EQ(range.high, 20.5);
}

}  // namespace
}  // namespace hydro::firmware
