#include "io/grammar/vtu_grid.h"
#include "io/volume/volume_vtu.h"

namespace sterna::io {

HybridMesh read_volume_vtu(const std::filesystem::path& path, const RunContext& context) { return volume_of(read_vtu_grid(path, context), context); }

}  // namespace sterna::io
