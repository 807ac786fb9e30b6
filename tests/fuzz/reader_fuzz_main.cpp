// libFuzzer target for every reader of the table of formats: a reader gives a result or throws sterna::Error, whatever the bytes.
// The environment names the reader: STERNA_FUZZ="<format>:surface" or "<format>:volume". With STERNA_FUZZ=list the program prints the readers, one a line, with their
// extensions, and ends. Built by the preset "fuzz"; run by tests/fuzz/run_fuzzers.
#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>

#include "geom/base/error.h"
#include "io/format_table.h"
#include "io/text_scanner.h"

namespace {

using namespace sterna;

/// The file that readers are given: in memory, with the extension of the format.
class InputFile {
 public:
  explicit InputFile(std::string_view extension) : path_("/dev/shm/sterna_fuzz_" + std::to_string(getpid()) + std::string(extension)) {}
  ~InputFile() { std::remove(path_.c_str()); }
  void fill(const std::uint8_t* bytes, std::size_t n) const {
    std::FILE* const file = std::fopen(path_.c_str(), "wb");
    if (!file || std::fwrite(bytes, 1, n, file) != n || std::fclose(file) != 0) std::abort();
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

struct Target {
  const io::Format* format = nullptr;
  bool is_volume = false;
};

std::string_view first_extension(const io::Format& format) { return format.extensions.substr(0, format.extensions.find(' ')); }

void list_readers() {
  for (const io::Format& format : io::formats())
    for (const bool is_volume : {false, true})
      if (is_volume ? format.read_volume != nullptr : format.read_surface != nullptr)
        std::printf("%s:%s\t%s\n", std::string(format.name).c_str(), is_volume ? "volume" : "surface", std::string(format.extensions).c_str());
}

Target chosen() {
  const char* const text = std::getenv("STERNA_FUZZ");
  const std::string_view choice = text ? text : "list";
  const std::size_t colon = choice.rfind(':');
  for (const io::Format& format : io::formats()) {
    if (colon == std::string_view::npos || !io::equal_ignoring_case(format.name, choice.substr(0, colon))) continue;
    const Target target{&format, choice.substr(colon + 1) == "volume"};
    if (target.is_volume ? format.read_volume != nullptr : format.read_surface != nullptr) return target;
  }
  list_readers();
  std::fflush(stdout);
  std::_Exit(choice == "list" ? 0 : 2);  // std::exit would be a finding to libFuzzer
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t n) {
  static const Target target = chosen();
  static const InputFile file(first_extension(*target.format));
  static const RunContext context({.threads = 1});
  file.fill(bytes, n);
  try {
    if (target.is_volume) target.format->read_volume(file.path(), context);
    else target.format->read_surface(file.path(), context);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::internal) std::abort();  // a refusal has a reason that the user can act on
  }
  return 0;
}
