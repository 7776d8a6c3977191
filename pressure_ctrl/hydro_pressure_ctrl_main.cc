// hydro-pressure-ctrl CONFIG: the fast pressure loop, eq. (16).
#include "pressure_ctrl/pressure_app.h"
#include "process/process_main.h"

int main(int argc, char** argv) {
  return hydro::process::AppMain<hydro::pressure_ctrl::PressureApp>(
      "hydro-pressure-ctrl", "The fast pressure loop: a motor command for each plant tick, eq. (16).", argc,
      argv);
}
