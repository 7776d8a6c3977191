// hydro-plot RUN.csv DIR: draws pictures of a run.
#include <string>

#include "base/new_file.h"
#include "base/output_folder.h"
#include "base/read_files.h"
#include "base/text_file.h"
#include "page/figure_svg.h"
#include "settings/command_line.h"
#include "tools/hydro_plot/run_figures.h"

int main(int argc, char** argv) {
  hydro::settings::CommandLine line("hydro-plot", "Draws a run as DIR/arm.svg and DIR/pressure.svg.");
  line.AddExamples({"hydro-plot run.csv out/run"}, "README.md");
  std::string table;
  std::string folder;
  line.AddPositional("RUN", &table, "FILE a table that hydro-log export wrote (.csv, .mat)");
  line.AddPositional("DIR", &folder, "FOLDER where to write; made if it is not there");
  line.AddForce();
  if (const auto code = line.Parse(argc, argv)) return *code;
  return hydro::settings::RunProgram("hydro-plot", [&] {
    const hydro::tables::Table run = hydro::tables::ReadTableWithoutUnits(table);
    for (const char* picture : {"/arm.svg", "/pressure.svg"}) {
      hydro::CheckKeeps(folder + picture, {table});
      hydro::CheckIsNew(folder + picture);
    }
    const std::string arm = hydro::page::FigureFile(hydro::plot::ArmFigure(run), "arm");
    const std::string pressure = hydro::page::FigureFile(hydro::plot::PressureFigure(run), "pressure");
    const hydro::OutputFolder made(folder, "DIR");
    hydro::WriteWholeFile(folder + "/arm.svg", arm, hydro::Existing::kKept);
    hydro::WriteWholeFile(folder + "/pressure.svg", pressure, hydro::Existing::kKept);
    return 0;
  });
}
