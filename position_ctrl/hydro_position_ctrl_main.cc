// hydro-position-ctrl CONFIG: the sampled PD loop, eq. (17).
#include "position_ctrl/position_app.h"
#include "process/process_main.h"

int main(int argc, char** argv) {
  return hydro::process::AppMain<hydro::position_ctrl::PositionApp>(
      "hydro-position-ctrl",
      "The sampled PD position loop, eq. (17), and the references that it or the pressure loop follows.",
      argc, argv);
}
