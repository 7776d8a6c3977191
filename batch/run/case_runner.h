// Runs cases one after another, in a folder of its own on this machine's disk.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "batch/run/case_command.h"
#include "batch/run/case_result.h"
#include "batch/store/case_store.h"
#include "batch/study/case_inputs.h"
#include "batch/study/study.h"

namespace hydro::batch {

// Each thread has one.
class CaseRunner {
 public:
  // `inputs` is the absolute path of the folder with the study's files. `scratch` is a new folder, which is
  // made here and removed at the end. Throws StoreError.
  CaseRunner(const Study& study, const CaseInputs& case_inputs, std::string inputs, std::string scratch);
  ~CaseRunner();
  CaseRunner(const CaseRunner&) = delete;
  CaseRunner& operator=(const CaseRunner&) = delete;

  // Runs a case, and again as often as the study allows retries. Returns nothing when the bell rang. Throws
  // StoreError when a disk is full.
  std::optional<CaseResult> Run(int64_t index, const StopBell& bell);

  // The files of the last case that the study keeps.
  std::vector<KeptFile> Kept() const;

 private:
  // Returns the reason of the failure; empty when the case succeeded. Returns nothing when the case was
  // stopped.
  std::optional<std::string> Attempt(int64_t index, const std::vector<Value>& values, const StopBell& bell);
  std::optional<std::string> RunStep(size_t step, int64_t index, const std::vector<Value>& values,
                                     const ChildRequest& timing, const StopBell& bell);
  void Prepare(const std::vector<Value>& values) const;
  void Empty() const;
  // A case that fails because the disk is full has not failed.
  void CheckDisk(const std::string& reason) const;

  const Study& study_;
  const CaseInputs& case_inputs_;
  const std::vector<std::string> keys_;
  const std::string inputs_, scratch_, folder_;
  std::vector<std::string> programs_;  // of the steps, where they do not change between cases
  CaseResult result_;
  std::vector<int> exit_codes_;  // of the steps of the last attempt
};

}  // namespace hydro::batch
