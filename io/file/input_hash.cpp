#include "io/file/input_hash.h"

#include "geom/base/hash.h"
#include "io/file/format_table.h"

namespace sterna::io {

std::string hash_input(const std::filesystem::path& path) {
  const Format& format = format_of(path);
  return format.files ? hash_files(format.files(path)) : hash_file(path);
}

std::string hash_any_input(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  for (const Format& format : formats())
    if (format.files && !extension.empty() && format.extensions == extension) return hash_files(format.files(path));
  return hash_file(path);
}

}  // namespace sterna::io
