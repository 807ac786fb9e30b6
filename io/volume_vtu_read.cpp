#include "io/volume_vtu.h"
#include "io/vtu_grid.h"

namespace sterna::io {

HybridMesh read_volume_vtu(const std::filesystem::path& path, const RunContext& context) { return volume_of(read_vtu_grid(path, context), context); }

}  // namespace sterna::io
