// libFuzzer target for every reader of the table of formats and of model files. For any bytes, a reader returns a sound mesh or throws sterna::Error with
// location and reason. The environment variable STERNA_FUZZ names the target ("UGRID:volume:.lb8.ugrid"). In addition to libFuzzer's options:
//   reader_fuzz --list                          prints the targets, one per line
//   reader_fuzz --seeds FOLDER SAMPLES...       fills FOLDER with inputs of the target from our own writers and from the folders SAMPLES
// Built by the preset "fuzz"; run by tests/fuzz/run_fuzzers.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "geom/base/error.h"
#include "tests/fuzz/container_input.h"
#include "tests/fuzz/fuzz_input.h"
#include "tests/fuzz/seeds.h"
#include "tests/support/reader_checks.h"

namespace {

using namespace sterna;

constexpr std::size_t k_largest_seed = 65536;  // bytes: small inputs run a thousand times as often

[[noreturn]] void report(const std::string& what) {
  std::fprintf(stderr, "FINDING: %s\n", what.c_str());
  std::abort();
}

fuzz::Target chosen_target() {
  const char* const name = std::getenv("STERNA_FUZZ");
  for (const fuzz::Target& target : fuzz::all_targets())
    if (name && target.name() == name) return target;
  std::fprintf(stderr, "STERNA_FUZZ names no target; --list prints them\n");
  std::_Exit(2);  // libFuzzer would report std::exit as a finding
}

/// Checks that a refusal states a reason that the user can act on.
void check(const Error& error, const fuzz::Target& target) {
  const std::string text = error.what();
  switch (error.code()) {
    case ErrorCode::file_malformed:
      if (!test::says_where(error, fuzz::is_container(target))) report("no place in: " + text);
      break;
    case ErrorCode::unsupported_format:
    case ErrorCode::overflow: break;
    case ErrorCode::file_not_found:
      if (!target.is_folder() && text.find("x.node") == std::string::npos) report("a file that is not needed: " + text);
      break;
    default: report("code " + std::string(to_string(error.code())) + ": " + text);
  }
}

/// \param mesh a HybridMesh or a SurfaceSoup
template <class Mesh>
void check(const Mesh& mesh) {
  const std::string flaw = test::flaw_of(mesh);
  if (!flaw.empty()) report(flaw);
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* n_arguments, char*** arguments) {
  const std::vector<std::string> words(*arguments + 1, *arguments + *n_arguments);
  if (words.empty() || !words[0].starts_with("--")) return 0;
  if (words[0] == "--list") {
    for (const fuzz::Target& target : fuzz::all_targets()) std::printf("%s\n", target.name().c_str());
  } else if (words[0] == "--seeds" && words.size() >= 2) {
    const std::vector<std::filesystem::path> samples(words.begin() + 2, words.end());
    std::printf("%d\n", fuzz::write_seeds(chosen_target(), words[1], samples, k_largest_seed));
  }
  std::fflush(stdout);
  std::_Exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n) {
  static const fuzz::Target target = chosen_target();
  static const fuzz::InputFiles files(target);
  static const RunContext context({.threads = 1});
  files.fill({reinterpret_cast<const char*>(bytes), n});
  try {
    if (target.model) {
      const std::string flaw = target.model->read(files.path(), context);
      if (!flaw.empty()) report(flaw);
    } else if (target.is_volume) {
      check(target.format->read_volume(files.path(), context));
    } else {
      check(target.format->read_surface(files.path(), context));
    }
  } catch (const Error& error) {
    check(error, target);
  }
  return 0;
}
