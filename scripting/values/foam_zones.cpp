#include "scripting/values/foam_zones.h"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

namespace sterna::scripting {

std::vector<io::FoamZone> zones_of_sources(const HybridMesh& mesh, const std::vector<volmesh::SizeSource>& sources) {
  std::vector<io::FoamZone> zones;
  for (const volmesh::SizeSource& source : sources) {
    if (volmesh::volume_of(source) <= 0.0) continue;
    // With such a steep growth of sizes, the size at a location equals that of the region only inside the region. Everywhere outside it is larger.
    constexpr double k_steep = 1e6;
    io::FoamZone zone{.name = "source_" + std::to_string(zones.size() + 1) + "_" + std::string(to_string(source.kind)), .cells = {}};
    const double largest = std::max(source.size, source.size_end) * (1.0 + 1e-9);
    std::uint32_t number = 0;
    for_each_cell(mesh, [&](const Cell& cell) {
      Vec3 middle;
      for (const NodeId node : cell.span()) middle += mesh.points[node];
      middle = (1.0 / static_cast<double>(cell.span().size())) * middle;
      if (volmesh::size_of(source, middle, k_steep) <= largest) zone.cells.push_back(number);
      ++number;
    });
    zones.push_back(std::move(zone));
  }
  return zones;
}

void write_zoned_foam(const MeshValue& mesh, const std::filesystem::path& path, Numbering numbering, const RunContext& context) {
  const std::vector<volmesh::SizeSource> sources = mesh.origin ? mesh.origin->options.sources : std::vector<volmesh::SizeSource>{};
  // If all cells share one numbering, the format orders them itself, which requires the columns. The order of nodes hardly affects solvers with values in
  // cells.
  const HybridMesh numbered = numbering == Numbering::lines ? mesh.mesh : renumbered(mesh.mesh, Numbering::both, context);
  io::write_numbered_foam(numbered, path, numbering, zones_of_sources(numbered, sources), context);
}

}  // namespace sterna::scripting
