// What an effect costs as text over what it costs compiled: the equations' right-hand side with the effect,
// and with its derivatives.
#include <chrono>
#include <cstdio>
#include <string>
#include <vector>

#include "model/actuator.h"
#include "model/response.h"
#include "model/terms/parameter_info.h"
#include "settings/effect_file.h"
#include "tests/table1.h"

namespace hydro {
namespace {

using Effects = std::vector<model::EffectDescription>;

model::ModelDescription ModelWith(const Effects& effects) {
  model::ModelDescription model;
  model.parameters = testing::Table1();
  model.effects = effects;
  return model;
}

double Seconds(const std::chrono::steady_clock::time_point& begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

// s, of a second of simulation in ticks of 1 ms.
double Simulated(const Effects& effects) {
  const auto begin = std::chrono::steady_clock::now();
  model::Actuator actuator(ModelWith(effects), {});
  for (int tick = 1; tick <= 1000; ++tick) actuator.Advance(tick % 200 < 100 ? 3 : -3, 1e-3 * tick);
  return Seconds(begin);
}

// s, of the same as a response with derivatives by eight parameters.
double Differentiated(const Effects& effects) {
  model::Stimulus stimulus;
  for (int tick = 0; tick < 1000; ++tick) {
    stimulus.time.push_back(1e-3 * tick);
    stimulus.voltage.push_back(tick % 200 < 100 ? 3 : -3);
  }
  model::StartState start{};
  start[2] = start[3] = testing::Table1().p_3;
  std::vector<model::Unknown> unknowns;
  for (size_t i = 0; i < 8; ++i) unknowns.push_back({model::Unknown::Kind::kBase, i});
  const auto begin = std::chrono::steady_clock::now();
  model::Respond(ModelWith(effects), stimulus, start, unknowns, {});
  return Seconds(begin);
}

// The least of several runs, the three in turn, so that all see the same machine.
void Compare(const char* what, double (*run)(const Effects&), const Effects& compiled, const Effects& text) {
  double least[3] = {1e9, 1e9, 1e9};
  for (int turn = 0; turn < 15; ++turn) {
    least[0] = std::min(least[0], run({}));
    least[1] = std::min(least[1], run(compiled));
    least[2] = std::min(least[2], run(text));
  }
  std::printf("%-32s %-15s without %6.2f ms, compiled %6.2f ms, text %6.2f ms: text/compiled %.2f\n",
              compiled[0].id.c_str(), what, 1e3 * least[0], 1e3 * least[1], 1e3 * least[2],
              least[2] / least[1]);
}

int Main(const std::string& folder) {
  for (const std::string id :
       {"pump.quadratic_drag", "pump.stribeck", "pump.turbulent_leakage", "fluid.entrained_air",
        "valve.relief", "line.wave", "actuator.seal_friction"}) {
    std::string file = folder + "/" + id + ".toml";
    file[folder.size() + 1 + id.find('.')] = '_';
    const auto formulas = settings::LoadEffectFile(file);
    model::EffectDescription compiled{id, {}, {}}, text{formulas->info().id, {}, {}};
    text.formulas = formulas;
    const std::vector<model::ParameterInfo>& known = model::FindEffect(id)->parameters;
    for (size_t i = 0; i < known.size(); ++i) {
      compiled.parameters[known[i].name] = text.parameters[formulas->info().parameters[i].name] =
          known[i].example;
    }
    Compare("simulation", Simulated, {compiled}, {text});
    Compare("derivatives", Differentiated, {compiled}, {text});
  }
  return 0;
}

}  // namespace
}  // namespace hydro

int main(int argc, char** argv) {
  return hydro::Main(argc > 1 ? argv[1] : std::string(HYDRO_SOURCE_DIR) + "/examples/effects/catalogue");
}
