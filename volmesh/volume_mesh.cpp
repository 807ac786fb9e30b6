#include "volmesh/volume_mesh.h"

#include "geom/base/error.h"
#include "geom/math/intersect.h"
#include "volmesh/assemble.h"
#include "volmesh/envelope/build_envelope.h"
#include "volmesh/envelope/retract.h"
#include "volmesh/layer_report.h"
#include "volmesh/prisms/extrude.h"

namespace sterna::volmesh {
namespace {

constexpr int k_max_clear_rounds = 10;
constexpr std::size_t k_max_places = 10;

void require_sane(const TriMesh& wall, VolumeMeshOptions& options) {
  require_options(options_of(options), "volume_mesh");
  if (wall.n_triangles() == 0)
    throw Error({.code = ErrorCode::empty_surface, .attempted = "volume_mesh", .problem = "the wall has no triangles"});
}

/// Extrusion may lower heights, and lowering may bring surfaces together that were clear before: alternate until neither changes anything.
Extrusion extrude_clear_of_collisions(const LayerBase& base, const VolumeMeshOptions& options, Envelope& envelope, const RunContext& context) {
  for (int round = 0; round < k_max_clear_rounds; ++round) {
    Extrusion extrusion = extrude_prisms(base, options.envelope, options.prisms, envelope, context);
    Collider collider(base, nullptr, context);
    if (!retract_collisions(base, options.envelope, collider, envelope, context)) return extrusion;
  }
  throw Error({.code = ErrorCode::envelope_failed,
               .attempted = "extruding prisms",
               .problem = "prism repair and collision retraction still disturb each other after " + std::to_string(k_max_clear_rounds) + " rounds",
               .hint = "lower max_thickness"});
}

/// The exact test before any engine runs: top of the layer, wall and outer boundary together.
void require_clear_boundaries(const LayerBase& base, const Envelope& envelope, const TriMesh& outer, const RunContext& context) {
  EnvelopeSurface all = envelope_surface(base, envelope, context);
  for (const TriangleVertices& v : base.wall.triangles) {
    if (envelope.is_collapsed(v[0]) && envelope.is_collapsed(v[1]) && envelope.is_collapsed(v[2])) continue;  // it is its own envelope triangle
    all.triangles.push_back({v[0].value(), v[1].value(), v[2].value()});
  }
  const std::uint32_t shift = static_cast<std::uint32_t>(all.points.size());
  all.points.insert(all.points.end(), outer.points.begin(), outer.points.end());
  for (const TriangleVertices& v : outer.triangles) all.triangles.push_back({v[0].value() + shift, v[1].value() + shift, v[2].value() + shift});
  const CrossingPairs crossings = find_crossings(all.points, all.triangles, context);
  if (crossings.total == 0) return;
  ErrorInfo info{.code = ErrorCode::self_intersection,
                 .attempted = "checking envelope, wall and farfield before tetrahedralisation",
                 .problem = std::to_string(crossings.total) + " pairs of triangles intersect",
                 .n_places = crossings.total,
                 .hint = "is the wall itself free of self-intersection, and inside the farfield?"};
  for (std::size_t i = 0; i < std::min(crossings.pairs.size(), k_max_places); ++i) {
    const auto& first = all.triangles[crossings.pairs[i][0]];
    info.places.push_back({(all.points[first[0]] + all.points[first[1]] + all.points[first[2]]) / 3.0,
                           "triangles " + std::to_string(crossings.pairs[i][0]) + " and " + std::to_string(crossings.pairs[i][1])});
  }
  for (const auto& pair : crossings.pairs) {
    for (const std::uint32_t item : pair) {
      const std::uint32_t next = static_cast<std::uint32_t>(info.geometry.points.size());
      for (const std::uint32_t p : all.triangles[item]) info.geometry.points.push_back(all.points[p]);
      info.geometry.triangles.push_back({next, next + 1, next + 2});
    }
  }
  throw Error(std::move(info));
}

void require_valid(const CheckReport& report) {
  if (report.is_valid()) return;
  ErrorInfo info{.code = ErrorCode::mesh_invalid, .attempted = "checking the finished mesh", .hint = "report this surface"};
  for (const auto& [violation, count] : report.counts) {
    info.problem += (info.problem.empty() ? "" : ", ") + std::to_string(count) + " x " + std::string(to_string(violation));
    info.n_places += count;
  }
  for (const Finding& finding : report.findings) info.places.push_back({finding.position, finding.what});
  throw Error(std::move(info));
}

}  // namespace

VolumeMeshResult volume_mesh(const TriMesh& wall, const VolumeMeshOptions& user_options, const RunContext& context) {
  VolumeMeshOptions options = user_options;
  require_sane(wall, options);
  VolumeMeshResult result;

  const TriMesh outer = farfield_sphere(wall, options.farfield, context);
  Envelope envelope;
  Extrusion extrusion;
  const LayerBase base = [&] {
    const StageTimer timer(context, "topology");
    return LayerBase(wall, context);
  }();
  {
    const StageTimer timer(context, "envelope");
    envelope = build_envelope(base, options.envelope, context.part("envelope", 0.0, 0.15));
  }
  {
    const StageTimer timer(context, "prisms");
    extrusion = extrude_clear_of_collisions(base, options, envelope, context.part("prisms", 0.15, 0.25));
  }
  {
    const StageTimer timer(context, "preflight");
    require_clear_boundaries(base, envelope, outer, context);
  }
  result.layer = report_layer(base, options.envelope, envelope);

  const FillBoundary boundary = fill_boundary(base, extrusion, outer);
  TetraResult tets;
  {
    const StageTimer timer(context, "tetrahedra");
    const std::vector<Point> holes = find_cavity_points(wall, context);
    tets = fill({boundary.points, boundary.triangles, holes}, options.tetrahedra, context.part("tetrahedra", 0.25, 0.9));
  }
  result.tetra_engine_seconds = tets.engine_seconds;
  result.tetra_engine_peak_bytes = tets.engine_peak_bytes;
  {
    const StageTimer timer(context, "assemble");
    result.mesh = assemble(base, std::move(extrusion), outer, boundary, std::move(tets), context);
  }
  {
    const StageTimer timer(context, "check");
    result.check = check(result.mesh, {}, context.part("check", 0.9, 1.0));
  }
  require_valid(result.check);
  return result;
}

}  // namespace sterna::volmesh
