// Tests the volumes by the divergence theorem. The volume of the layer cells must equal the flux of x/3 through wall and envelope (and other boundary faces of
// layer cells). The volume of the tets must equal the flux through envelope and outer boundary. The flux is summed in extended precision about the centre of
// the walls: the volume of a layer of thickness h about a body of length L is the difference of fluxes that are L/h times larger, and must still be accurate to
// 1e-11.
#include <cmath>
#include <cstdio>

#include "geom/mesh/check_parts.h"

namespace sterna::check_parts {
namespace {

/// Largest relative difference of the two volumes, a project requirement; rounding of a 30-layer mesh is about 1e-14.
constexpr double k_volume_tolerance = 1e-11;

struct WideVec {
  long double x, y, z;
};

/// Returns six times the flux of x/3 about the origin through a triangle, that is det(a, b, c).
long double determinant(const WideVec& a, const WideVec& b, const WideVec& c) {
  return a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
}

class Flux {
 public:
  Flux(const HybridMesh& mesh, const FaceSlots& slots, const Point& origin) : mesh_(mesh), slots_(slots), origin_(origin) {}

  void add(std::uint32_t slot, bool is_reversed, CompensatedSum& sum) const {
    const Face face = slots_.face(slot);
    std::array<WideVec, 4> p{};
    for (std::size_t k = 0; k < face.size; ++k) {
      const Point& x = mesh_.points[face.nodes[k]];
      p[k] = {static_cast<long double>(x.x) - origin_.x, static_cast<long double>(x.y) - origin_.y, static_cast<long double>(x.z) - origin_.z};
    }
    // The flux through a bilinear quad is the mean over its two triangulations.
    long double flux =
        face.size == 3
            ? determinant(p[0], p[1], p[2]) / 6.0L
            : (determinant(p[0], p[1], p[2]) + determinant(p[0], p[2], p[3]) + determinant(p[0], p[1], p[3]) + determinant(p[1], p[2], p[3])) / 12.0L;
    if (is_reversed) flux = -flux;
    const auto leading = static_cast<double>(flux);
    sum.add(leading);
    sum.add(static_cast<double>(flux - leading));
  }

 private:
  const HybridMesh& mesh_;
  const FaceSlots& slots_;
  Point origin_;
};

struct PartFluxes {
  CompensatedSum layer, tets;
};

PartFluxes merge(PartFluxes all, const PartFluxes& more) {
  all.layer.add(more.layer);
  all.tets.add(more.tets);
  return all;
}

/// Returns the centre of the box of all walls, or of all boundaries if there are no walls.
Point flux_origin(const HybridMesh& mesh) {
  Box walls, all;
  const auto look_at = [&](const auto& faces) {
    for (const auto& face : faces) {
      const bool is_wall = face.patch.index() < mesh.patches.size() && mesh.patches[face.patch].kind == PatchKind::wall;
      for (const NodeId node : face.nodes) (is_wall ? walls : all).add(mesh.points[node]);
    }
  };
  look_at(mesh.boundary_triangles);
  look_at(mesh.boundary_quads);
  return !walls.empty() ? walls.center() : !all.empty() ? all.center() : Point{};
}

/// Returns the relative difference of cells and flux; 0 if the part is empty.
double relative_error(double cells, double flux) {
  if (cells == 0.0 && flux == 0.0) return 0.0;
  return std::abs(cells - flux) / std::max(std::abs(cells), std::abs(flux));
}

}  // namespace

void check_volumes(const HybridMesh& mesh, const FaceSlots& slots, const FaceMatch& match, const CellScan& scan, const RunContext& context, CheckReport& report,
                   Findings& findings) {
  const Point origin = flux_origin(mesh);
  const Flux flux(mesh, slots, origin);
  PartFluxes fluxes = parallel_reduce(
      context, match.outer.size(), PartFluxes{},
      [&](std::size_t begin, std::size_t end) {
        PartFluxes part;
        for (std::size_t i = begin; i < end; ++i) flux.add(match.outer[i], false, slots.is_layer(match.outer[i]) ? part.layer : part.tets);
        return part;
      },
      merge);
  fluxes = parallel_reduce(
      context, match.interface.size(), fluxes,
      [&](std::size_t begin, std::size_t end) {
        PartFluxes part;
        for (std::size_t i = begin; i < end; ++i) {
          flux.add(match.interface[i], false, part.layer);
          flux.add(match.interface[i], true, part.tets);
        }
        return part;
      },
      merge);

  const auto compare = [&](const char* part, double cells, double surface) {
    const double error = relative_error(cells, surface);
    if (error <= k_volume_tolerance) return error;
    findings.add(Violation::volume_mismatch, [&] {
      char text[200];
      std::snprintf(text, sizeof text,
                    "%s: the cells' volumes sum to %.15g m^3, the surface around them encloses %.15g m^3; relative difference %.3g, limit %.3g", part, cells,
                    surface, error, k_volume_tolerance);
      return std::pair(origin, std::string(text));
    });
    return error;
  };
  report.layer_volume = scan.layer_volume.value();
  report.tet_volume = scan.tet_volume.value();
  report.layer_volume_error = compare("layer", report.layer_volume, fluxes.layer.value());
  report.tet_volume_error = compare("tetrahedra", report.tet_volume, fluxes.tets.value());
  report.total_volume = report.layer_volume + report.tet_volume;
}

}  // namespace sterna::check_parts
