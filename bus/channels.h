// Names of the channels. A suffix ("_2") lets two stacks share one network.
#pragma once

#include <string>

namespace hydro::bus {

struct Channels {
  explicit Channels(const std::string& suffix = "")
      : state("HYDRO_STATE" + suffix),
        motor_command("HYDRO_MOTOR_COMMAND" + suffix),
        pressure_command("HYDRO_PRESSURE_COMMAND" + suffix),
        arm_reference("HYDRO_ARM_REFERENCE" + suffix),
        run("HYDRO_RUN" + suffix),
        loop_statistics("HYDRO_LOOP_STATISTICS" + suffix),
        loop_histogram("HYDRO_LOOP_HISTOGRAM" + suffix),
        fault("HYDRO_FAULT" + suffix),
        stop("HYDRO_STOP" + suffix),
        rearm("HYDRO_REARM" + suffix),
        process_status("HYDRO_PROCESS_STATUS" + suffix),
        log_progress("HYDRO_LOG_PROGRESS" + suffix),
        introduction("HYDRO_INTRODUCTION" + suffix) {}

  std::string state;             // state_t, from the plant or the driver
  std::string motor_command;     // motor_command_t, from the pressure loop
  std::string pressure_command;  // pressure_command_t, from the position loop
  std::string arm_reference;     // arm_reference_t, from the position loop
  std::string run;               // run_description_t, from the plant
  std::string loop_statistics;   // loop_statistics_t, from every process
  std::string loop_histogram;    // loop_histogram_t, from every process
  std::string fault;             // fault_t, from every process
  std::string stop;              // stop_t
  std::string rearm;             // rearm_t, from hydro-launch --rearm, answered by the plant
  std::string process_status;    // process_status_t, from every process
  std::string log_progress;      // log_progress_t, from the logger
  std::string introduction;      // introduction_t, from the bus of every process of a stack with a key
};

}  // namespace hydro::bus
