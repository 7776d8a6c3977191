// A study's folder:
//
//   study.toml, config.toml, model.toml, inputs/   the study, and everything that its cases need
//   cases/     the cases (store/case_store.h)
//   times/     when they ran, and for how long
//   staging/   cases that are being stored
//   table.csv, table.json, index.html and pictures, once FinishStudy() has run
#pragma once

#include <string>

#include "batch/report/study_table.h"
#include "batch/study/study.h"

namespace hydro::batch {

// Makes the folder, or finds it already made for the same study. Throws InputError for the folder of another
// study, naming the first difference, for a folder that holds something else, and if FinishStudy() would
// replace a file that the study reads.
void PrepareStudy(const Study& study, const std::string& folder);

// Reads the study for which a folder was made. Throws InputError when there is none, or when hydro-batch has
// not written it.
Study OpenStudy(const std::string& folder);

// The end of a study: table, pictures and page.

// Makes table.csv, table.json, the pictures and index.html in a study's folder from the cases that are there.
// Missing cases are counted and appear in the table as missing. Throws WriteError, StoreError, InputError.
TableCounts FinishStudy(const std::string& folder, int jobs);

}  // namespace hydro::batch
