#include "runs/stack_choice.h"

namespace hydro::runs {

void AddStackChoice(settings::CommandLine* verb, StackChoice* choice) {
  verb->AddOption("--suffix", &choice->suffix, "TEXT suffix of the channels, where a log has several");
  verb->AddOption("--joint", &choice->joint, "NAME read this joint of a limb, where a log has several");
}

}  // namespace hydro::runs
