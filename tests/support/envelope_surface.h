// The envelope as a separate triangle surface, for tests of its intersections.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/envelope/envelope.h"

namespace sterna::test {

/// The envelope as an indexed triangle set: points = wall points, then one envelope point per vertex; corners of collapsed vertices refer to the wall.
struct EnvelopeSurface {
  std::vector<Vec3> points;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};
EnvelopeSurface envelope_surface(const volmesh::LayerBase& base, const volmesh::EnvelopeShape& envelope, const RunContext& context);

}  // namespace sterna::test
