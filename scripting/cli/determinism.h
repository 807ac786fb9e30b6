// Gate G22: a script gives the same files, byte for byte, on any number of threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scripting/cli/commands.h"

namespace sterna::scripting {

struct DeterminismCommand {
  std::filesystem::path script;
  OptionOverrides overrides;             ///< --set
  OptionOverrides arguments;             ///< NAME=VALUE
  std::vector<int> threads = {1, 2, 7};  ///< of each run; a number given twice compares two equal runs
  bool is_json = false;
};

/// How a file came out.
struct ComparedFile {
  std::string name;  ///< relative to the folder of the run
  std::string hash;  ///< XXH3, 128 bits, of the first run; empty where that has no such file
  std::uint64_t bytes = 0;
  /// Of a later run that differs.
  struct Difference {
    int threads = 0;
    std::string hash;  ///< empty: it has no such file
    std::uint64_t bytes = 0;
    std::uint64_t at = 0;  ///< first byte that differs, from 0; the shorter length where one file is the start of the other
  };
  std::vector<Difference> differences;
};

struct DeterminismReport {
  std::string script;
  std::vector<int> threads;
  std::vector<ComparedFile> files;    ///< by name
  std::vector<std::string> left_out;  ///< files that hold times by what they are: pages, measures and logs of cases
  std::filesystem::path kept;         ///< the folder with the runs, where something differs
  bool is_pass() const;
};

/// Adds what a run has written in `folder` to the report, against the first run in `first` (the same folder for the first run itself).
/// \throws Error of hash_file
void compare_run(const std::filesystem::path& first, const std::filesystem::path& folder, int threads, DeterminismReport& report);

/// "G22 determinism: pass, 4 files equal for 1, 2 and 7 threads" and the files with their hashes, or FAIL with what differs where.
std::string to_text(const DeterminismReport& report);
/// JSON with schema "sterna-determinism-1", described in docs/quality_gates.md.
std::string to_json(const DeterminismReport& report);

/// Runs the script once for each number of threads, each in a process and a folder of its own, and compares the files. Status 0: all equal, 1: not.
/// \throws Error(script_failed) where a run fails; Error(cancelled) after the run was stopped and the folder removed
int execute(const DeterminismCommand& command, const CommandContext& context);

}  // namespace sterna::scripting
