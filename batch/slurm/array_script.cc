#include "batch/slurm/array_script.h"

#include <cctype>

namespace hydro::batch {

std::string ShellWord(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string PlainName(const std::string& text) {
  constexpr size_t kMost = 40;
  std::string name;
  for (const char c : text.substr(0, kMost)) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-';
    name += plain && static_cast<unsigned char>(c) < 128 ? c : '_';
  }
  return name;
}

std::string ArrayScript(const ScriptRequest& request) {
  return "#!/bin/sh\n"
         "# Written by hydro-batch for sbatch: each job of the array runs the cases of its line in the file "
         "`cases`.\n"
         "program=" +
         ShellWord(request.program) +
         "\n"
         "study=" +
         ShellWord(request.study) +
         "\n"
         "array=" +
         ShellWord(request.array) + R"(
job=$SLURM_ARRAY_TASK_ID
# A full disk must not keep a job from saying so with its exit code.
log=$array/log/$job
if (: >>"$log") 2>/dev/null; then exec >>"$log" 2>&1; fi
cases=$(sed -n "$((job + 1))p" "$array/cases") && [ -n "$cases" ] || exit 3
echo "begin $(date +%s.%N) $(hostname) $SLURM_ARRAY_JOB_ID ${SLURM_RESTART_COUNT:-0}"
"$program" --worker "$study" --cases "$cases" --jobs "${SLURM_CPUS_PER_TASK:-1}"
code=$?
echo "end $(date +%s.%N) $code"
exit $code
)";
}

}  // namespace hydro::batch
