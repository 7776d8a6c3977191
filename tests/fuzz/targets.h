// What is fuzzed: every decoder and reader of the stack, each behind a function that takes any bytes.
//
// A target may refuse its input with InputError on one line; anything else (a crash, another exception, a
// broken promise) ends the process. Runs under libFuzzer (fuzz_main.cc, scripts/fuzz) and over the committed
// corpus in every build (run_corpus.cc, ctest).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hydro::fuzz {

struct Target {
  const char* name;  // also that of its folder in corpus/
  void (*run)(const uint8_t* data, size_t size);
};

// Null when there is none of that name.
const Target* FindTarget(std::string_view name);

void Packets(const uint8_t* data, size_t size);    // LCM's packets as they come from the network
void Messages(const uint8_t* data, size_t size);   // messages as they come from the network
void Processes(const uint8_t* data, size_t size);  // what controllers and the launch do with them
void Plant(const uint8_t* data, size_t size);      // what the plant and its voltage guard do with them
void Recorder(const uint8_t* data, size_t size);   // what the logger does with them
void FrontEnd(const uint8_t* data,
              size_t size);                  // what a front end's firmware makes of a link and its converters
void Log(const uint8_t* data, size_t size);  // all that hydro-log does with a log
void Table(const uint8_t* data, size_t size);        // hydro-log import
void Mat(const uint8_t* data, size_t size);          // a MAT file as a table
void MeasuredRun(const uint8_t* data, size_t size);  // a CSV with its sidecar
void Points(const uint8_t* data, size_t size);       // the CSV of a trajectory
void StackToml(const uint8_t* data, size_t size);
void ModelToml(const uint8_t* data, size_t size);
void Effect(const uint8_t* data, size_t size);       // a file of an effect as text, and a model that has it
void Overrides(const uint8_t* data, size_t size);    // --set
void Url(const uint8_t* data, size_t size);          // bus.url
void Key(const uint8_t* data, size_t size);          // bus.key_file
void ForeignText(const uint8_t* data, size_t size);  // text of messages, logs, files, other programs
void Scope(const uint8_t* data, size_t size);        // what a browser sends to hydro-scope

}  // namespace hydro::fuzz
