// What a program has to say of its input before it does its work. A program that refuses its input says that alone, so remarks
// wait until the input has been taken.
#pragma once

#include <string>

namespace hydro {

// Keeps one line for stderr, "hydro-log: warning: ...". Not for threads beside the main one.
void Remark(const std::string& line);

// Prints what has been kept. Called before work that takes a while, and at a program's end (RunProgram) unless it has refused its input.
void SayRemarks();

}  // namespace hydro
