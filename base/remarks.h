// Holds back a program's remarks on its input until it has accepted the input: a program that refuses its
// input prints the refusal alone.
#pragma once

#include <string>

namespace hydro {

// Keeps one line for stderr, "hydro-log: warning: ...". Only the main thread may call it.
void Remark(const std::string& line);

// Prints the lines that were kept. Called before work that takes a while, and at a program's end (RunProgram)
// unless the program has refused its input.
void SayRemarks();

}  // namespace hydro
