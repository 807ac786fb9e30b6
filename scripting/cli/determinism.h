// Gate G22: a script must produce the same files, byte for byte, with any number of threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scripting/command/command_context.h"
#include "scripting/command/command_line.h"

namespace sterna::scripting {

/// Comparison result of a file.
struct ComparedFile {
  std::string name;  ///< relative to the folder of the run
  std::string hash;  ///< XXH3, 128 bits, of the first run; empty if that run has no such file
  std::uint64_t bytes = 0;
  /// The file of a later run that differs.
  struct Difference {
    int threads = 0;
    std::string hash;  ///< empty: the run has no such file
    std::uint64_t bytes = 0;
    std::uint64_t at = 0;  ///< first byte that differs, from 0; the shorter length if one file is the start of the other
  };
  std::vector<Difference> differences;
};

struct DeterminismReport {
  std::string script;
  std::vector<int> threads;
  std::vector<ComparedFile> files;    ///< sorted by name
  std::vector<std::string> left_out;  ///< files that contain times by their nature: pages, measures and logs of cases
  std::filesystem::path kept;         ///< the folder with the runs, if a file differs
  bool is_pass() const;
};

/// Compares the files of a run in `folder` with those of the first run in `first`, and adds the results to the report. For the first run both folders are the
/// same.
/// \throws Error of hash_file
void compare_run(const std::filesystem::path& first, const std::filesystem::path& folder, int threads, DeterminismReport& report);

/// Returns "G22 determinism: pass, 4 files equal for 1, 2 and 7 threads" and the files with their hashes, or FAIL with the position of each difference.
std::string to_text(const DeterminismReport& report);
/// Returns JSON with schema "sterna-determinism-1", described in docs/quality_gates.md.
std::string to_json(const DeterminismReport& report);

/// Runs the script once for each number of threads, each in a separate process and folder, and compares the files. Status 0: all equal, 1: not.
/// \throws Error(script_failed) if a run fails; Error(cancelled) after the run was stopped and the folder removed
int determinism_command(const CommandLine& line, const CommandContext& context);

}  // namespace sterna::scripting
