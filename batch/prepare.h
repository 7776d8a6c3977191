// A study's folder:
//
//   study.toml, config.toml, model.toml, inputs/   the study, and all that its cases need
//   cases/     the cases (store/case_store.h)
//   times/     when they ran, and how long
//   staging/   cases that are being stored
//   table.csv, table.json, index.html and pictures, once FinishStudy() has run
#pragma once

#include <string>

#include "batch/study/study.h"

namespace hydro::batch {

// Makes the folder, or finds it made for the same study. Throws InputError for the folder of another study, naming the first difference,
// and where something else is in it.
void PrepareStudy(const Study& study, const std::string& folder);

// The study that a folder was made for. Throws InputError when there is none.
Study OpenStudy(const std::string& folder);

}  // namespace hydro::batch
