// The fuzzers link the read_container() of this file: io/container/container_file.cpp is compiled with another name for its own.
#include "tests/fuzz/container_input.h"

#include <fcntl.h>

#include <fstream>

#include "geom/base/helper_process.h"
#include "io/container/container_file.h"
#include "io/input/file_buffer.h"

namespace sterna::io {

ContainerImage read_container(const std::filesystem::path& path, ContainerFormat, const std::vector<std::string>&, const RunContext& context,
                              const std::string&) {
  const auto buffer = std::make_shared<FileBuffer>(load_file(path, context));
  return {buffer, std::as_bytes(std::span(buffer->bytes)), buffer->source};
}

}  // namespace sterna::io

namespace sterna::fuzz {
namespace {

constexpr std::size_t k_head_bytes = 32;
constexpr double k_longest_seconds = 60.0;  // for samples of a few kB, on a machine under load

}  // namespace

bool is_container(const Target& target) {
  return target.format && (target.format->name == "CGNS" || target.format->name == "TAU" || target.format->name == "VTKHDF");
}

std::string image_of(const Target& target, const std::filesystem::path& path) {
  const HelperTask task{
      .helper = "the reader of container files", .attempted = "making seeds", .else_try = {}, .missing = ErrorCode::internal, .failed = ErrorCode::internal};
  std::string head(k_head_bytes, '\0');
  std::ifstream(path, std::ios::binary).read(head.data(), k_head_bytes);
  const std::string library = target.format->name == "TAU" ? "netcdf" : io::is_adf(head) ? "adf" : "hdf5";
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return {};
  SharedBlock image("sterna container", 0, task);
  const HelperStart start{
      .task = task, .path = find_helper("sterna-read-container", {}, task), .arguments = {library}, .late = {}, .time_limit = k_longest_seconds};
  if (!run_helper(start, above_helper_descriptors(file, task), image.descriptor(), RunContext({.threads = 1})).is_success()) return {};
  const std::byte* const bytes = image.map();
  return {reinterpret_cast<const char*>(bytes), image.size()};
}

}  // namespace sterna::fuzz
