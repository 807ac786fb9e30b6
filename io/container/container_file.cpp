#include "io/container/container_file.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>

#include "geom/base/helper_process.h"
#include "geom/base/schema.h"
#include "io/input/file_buffer.h"

namespace sterna::io {
namespace {

static_assert(wire::k_file_fd == k_helper_request_fd && wire::k_image_fd == k_helper_reply_fd);

constexpr std::size_t k_probed_head_bytes = 512;

HelperTask task_of(const std::string& source) {
  return {.helper = "the reader of container files",
          .attempted = "reading " + source,
          .else_try = {},
          .missing = ErrorCode::unsupported_format,
          .failed = ErrorCode::file_not_found};
}

/// An input file as a descriptor that the helper can inherit.
class SourceFile {
 public:
  SourceFile(const std::filesystem::path& path, const HelperTask& task, const RunContext& context) {
    const std::string raw = raw_head(path);
    if (!raw.empty() && !is_gzip(raw)) {
      const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
      if (descriptor >= 0) {
        descriptor_ = above_helper_descriptors(descriptor, task);
        head_ = raw;
        return;
      }
    }
    const FileBuffer buffer = load_file(path, context);  // unpacks the file, or reports the problem with the path
    head_ = buffer.text().substr(0, k_probed_head_bytes);
    block_ = std::make_unique<SharedBlock>("sterna unpacked file", 0, task);
    block_->append(std::as_bytes(std::span(buffer.bytes)));
  }
  ~SourceFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  SourceFile(const SourceFile&) = delete;
  SourceFile& operator=(const SourceFile&) = delete;

  int descriptor() const { return block_ ? block_->descriptor() : descriptor_; }
  const std::string& head() const { return head_; }

 private:
  static bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

  /// Returns the first bytes of a regular file without unpacking; empty if they cannot be read.
  static std::string raw_head(const std::filesystem::path& path) {
    std::error_code status;
    if (!std::filesystem::is_regular_file(path, status)) return {};
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return {};
    std::string bytes(k_probed_head_bytes, '\0');
    const ssize_t n = ::read(descriptor, bytes.data(), bytes.size());
    ::close(descriptor);
    bytes.resize(n > 0 ? static_cast<std::size_t>(n) : 0);
    return bytes;
  }

  std::string head_;
  int descriptor_ = -1;
  std::unique_ptr<SharedBlock> block_;
};

/// Returns the library for a file with this head.
std::string library_for(ContainerFormat format, const std::string& head, const std::string& source) {
  if (format == ContainerFormat::netcdf && is_netcdf(head)) return "netcdf";
  if (format != ContainerFormat::netcdf && is_hdf5(head)) return "hdf5";
  if (format == ContainerFormat::cgns && is_adf(head)) return "adf";
  constexpr const char* k_names[] = {"an HDF5", "a NetCDF", "an HDF5 or ADF"};
  throw_malformed(
      source, "byte 0",
      "found " + quoted_excerpt(std::string_view(head).substr(0, 8)) + ", expected the beginning of " + k_names[static_cast<std::size_t>(format)] + " file");
}

/// Reports why the helper left no image.
[[noreturn]] void throw_death(const HelperExit& exit, const std::string& library, const std::string& source) {
  constexpr std::string_view k_hint = "the file may be damaged: copy or write it again";
  const std::string name = library == "hdf5" ? "HDF5" : library == "netcdf" ? "NetCDF" : "CGNS";
  if (WIFSIGNALED(exit.wait_status)) {
    const int signal = WTERMSIG(exit.wait_status);
    if (signal == SIGXCPU || signal == SIGKILL)
      throw_malformed(source, "the file", "the " + name + " library did not finish reading the file within its limits of time and memory" + last_words(exit),
                      k_hint);
    throw_malformed(
        source, "the file",
        "the " + name + " library crashed while reading the file: signal " + std::to_string(signal) + " (" + strsignal(signal) + ")" + last_words(exit),
        k_hint);
  }
  throw_malformed(source, "the file",
                  "the " + name + " library failed to read the file: exit status " + std::to_string(WEXITSTATUS(exit.wait_status)) + last_words(exit), k_hint);
}

}  // namespace

bool is_hdf5(std::string_view bytes) { return bytes.starts_with("\x89HDF\r\n\x1a\n"); }
bool is_adf(std::string_view bytes) { return bytes.substr(0, 32).find("ADF Database Version ") == 4; }
bool is_netcdf(std::string_view bytes) { return bytes.starts_with("CDF") || is_hdf5(bytes); }

ContainerImage read_container(const std::filesystem::path& path, ContainerFormat format, const std::vector<std::string>& left_out, const RunContext& context,
                              const std::string& helper_folder) {
  const std::string source = path.string();
  const HelperTask task = task_of(source);
  const SourceFile file(path, task, context);
  const std::string library = library_for(format, file.head(), source);
  std::vector<std::string> arguments = {library};
  arguments.insert(arguments.end(), left_out.begin(), left_out.end());
  const auto image = std::make_shared<SharedBlock>("sterna container", 0, task);
  const HelperStart start{.task = task,
                          .path = find_helper("sterna-read-container", helper_folder, task),
                          .arguments = std::move(arguments),
                          .late = {},
                          .time_limit = k_automatic};
  const HelperExit exit = run_helper(start, file.descriptor(), image->descriptor(), context);
  if (!exit.output.empty()) context.debug("sterna-read-container: " + exit.output);
  if (!exit.is_success()) throw_death(exit, library, source);
  const std::byte* const bytes = image->map();
  return {image, {bytes, image->size()}, source};
}

}  // namespace sterna::io
