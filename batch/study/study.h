// A study: many cases of one thing, with other values in each. docs/studies.md explains the file.
//
// Case i of a study is a function of the study and i alone, so nothing is kept for each case.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "batch/study/value.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {

// A key and its values, which are combined with those of all other factors.
struct GridFactor {
  std::string key;
  std::vector<Value> values;
};

// Rows of values, each of which is combined with the grid.
struct RowList {
  std::vector<std::string> keys;
  std::vector<std::vector<Value>> rows;
};

// A command that a case runs in its folder.
struct Step {
  std::vector<std::string> argv;      // with placeholders (run/placeholders.h)
  std::vector<int> exit_codes = {0};  // those that do not count as failure
  std::string place = {};             // "file:line", for messages
};

// A number that a case leaves, and its place in a JSON or TOML file.
struct Collected {
  std::string name;
  std::string file;
  std::string pointer;  // JSON pointer
  std::string unit;     // for the page
  bool smaller_is_worse = false;
};

struct ReportWishes {
  std::string worst;  // a collected number that decides which cases the page shows as the worst
  std::vector<std::string> surface;  // two varied keys and a collected number
};

struct Study {
  std::string name;
  int64_t seed = 1;
  std::vector<GridFactor> grid;
  RowList list;
  std::vector<Draw> draws;
  int64_t draw_count = 1;   // draws for each combination of grid and list
  bool same_draws = false;  // every combination gets the same draws
  std::vector<Step> steps;
  std::vector<Collected> collect;
  std::vector<std::string> keep;  // files of a case that are kept beside its result
  int retries = 0;
  double timeout_s = 0;  // of a case; 0: none
  ReportWishes report;
  // The texts of the configuration and the model that cases change; empty: the study has none.
  std::string config_text, model_text;

  // The contents of the study's folder: name in the folder -> text. study.toml is the study, with its paths
  // as they are in the folder.
  std::map<std::string, std::string> files;

  int64_t cases() const;
  // All varied keys, in the order of the table's columns.
  std::vector<std::string> Keys() const;
  // Case `index`'s values, in the order of Keys().
  std::vector<Value> Values(int64_t index) const;
};

// Reads and checks a study, what it names, and the configurations of the first cases. Throws InputError
// naming file, line and key. `asked` receives the keys for which the reader asked.
Study ReadStudy(const std::string& file, std::vector<settings::AskedKey>* asked = nullptr);

inline constexpr int64_t kMostCases = 1'000'000'000;

// Whether two studies are the same.

// The first difference, as "study.toml: grid[0].steps: was 5, is 6"; empty when there is none. What only
// affects the report does not count as a difference.
std::string StudyDifference(const Study& was, const Study& is);

}  // namespace hydro::batch
