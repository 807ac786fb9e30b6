#include "scripting/lua/series_session.h"

#include "io/file/input_hash.h"

namespace sterna::scripting {

std::string hash_of_input(const std::filesystem::path& path) {
  std::error_code failure;  // the script cannot access the path either; the reader reports the reason
  if (!std::filesystem::is_regular_file(path, failure)) return k_absent;
  return io::hash_any_input(path);
}

void note_input(SeriesSession& session, const std::filesystem::path& path) {
  if (!session.settings.worker) return;
  const std::string name = path.lexically_normal().string();
  if (!session.inputs.contains(name)) session.inputs[name] = hash_of_input(path);
}

}  // namespace sterna::scripting
