#include "io/output/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "geom/base/error.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_n_free_letters = 6;  ///< at the end of a name that mkdtemp completes

}  // namespace

ScratchFolder::ScratchFolder(std::string_view purpose) {
  const auto refuse = [](const std::string& problem) {
    throw Error({.code = ErrorCode::write_failed,
                 .attempted = "making a folder for temporary files",
                 .problem = problem,
                 .hint = "set the environment variable TMPDIR to another folder"});
  };
  std::error_code failure;
  const std::filesystem::path above = std::filesystem::temp_directory_path(failure);
  if (failure) refuse(failure.message());
  std::string name = (above / ("sterna-" + std::string(purpose) + "-" + std::string(k_n_free_letters, 'X'))).string();
  if (mkdtemp(name.data()) == nullptr) refuse(name + ": " + std::strerror(errno));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;  // files that cannot be removed are left as temporary files
  if (!is_kept_) std::filesystem::remove_all(path_, ignored);
}

}  // namespace sterna::io
