// UGRID writer. The file has seven counts, nodes, faces (inwards, as in NASA's tools), the patch numbers of the faces, and cells. Text and binary differ in the
// number format.
#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/mesh/computed_volumes.h"
#include "io/grammar/ugrid_source.h"
#include "io/names/name_rules.h"
#include "io/output/cell_sections.h"
#include "io/output/section_output.h"
#include "io/volume/volume_ugrid.h"

namespace sterna::io {
namespace {

constexpr std::array<CellKind, 4> k_ugrid_kinds = {CellKind::tetrahedron, CellKind::pyramid, CellKind::prism, CellKind::hexahedron};
constexpr std::size_t k_max_line = 8 * (k_max_integer_text + 1);  // line of a hexahedron; a node's three coordinates and a binary item are shorter

/// Writes the numbers of one item, as text (one line) or as bytes.
class ItemWriter {
 public:
  ItemWriter(const UgridVariant& variant, char* at) : variant_(variant), at_(at) {}
  void integer(std::int64_t value) {
    if (variant_.is_text) {
      at_ = put_integer_text(at_, value);
      *at_++ = ' ';
    } else if (variant_.is_wide) {
      at_ = put_bytes(at_, value, variant_.order);
    } else {
      at_ = put_bytes(at_, static_cast<std::int32_t>(value), variant_.order);  // the range was checked
    }
  }
  void node(NodeId id) { integer(static_cast<std::int64_t>(id.value()) + 1); }
  void real(double value) {
    if (variant_.is_text) {
      at_ = put_real_text(at_, value);
      *at_++ = ' ';
    } else if (variant_.is_single) {
      at_ = put_bytes(at_, static_cast<float>(value), variant_.order);
    } else {
      at_ = put_bytes(at_, value, variant_.order);
    }
  }
  void end_item() {
    if (variant_.is_text) at_[-1] = '\n';
  }
  char* end() const { return at_; }

 private:
  const UgridVariant& variant_;
  char* at_;
};

/// Returns a section of items; `put(i, writer)` writes the numbers of item i.
template <class Put>
OutputSection items(const UgridVariant& variant, std::uint64_t n, const Put& put) {
  return {.n_items = n, .format = [&variant, put](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            ItemWriter writer(variant, out.reserve((end - begin) * k_max_line));
            for (std::uint64_t i = begin; i < end; ++i) {
              put(i, writer);
              writer.end_item();
            }
            out.end_at(writer.end());
          }};
}

OutputSection cell_section(const UgridVariant& variant, const CellSections& cells, CellKind kind) {
  return {.n_items = cells.count(kind), .format = [&variant, &cells, kind](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            ItemWriter writer(variant, out.reserve((end - begin) * k_max_line));
            cells.for_each(kind, begin, end, [&](std::span<const NodeId> nodes, int) {
              for (std::size_t k = 0; k < nodes.size(); ++k) writer.node(nodes[kind == CellKind::pyramid ? k_ugrid_pyramid[k] : k]);
              writer.end_item();
            });
            out.end_at(writer.end());
          }};
}

std::vector<OutputSection> sections_of(const HybridMesh& mesh, const CellSections& cells, const UgridVariant& variant) {
  std::vector<OutputSection> sections;
  std::array<std::uint64_t, 7> counts = {mesh.points.size(), mesh.boundary_triangles.size(), mesh.boundary_quads.size()};
  for (std::size_t k = 0; k < k_ugrid_kinds.size(); ++k) counts[3 + k] = cells.count(k_ugrid_kinds[k]);
  sections.push_back(items(variant, 1, [counts](std::uint64_t, ItemWriter& out) {
    for (const std::uint64_t n : counts) out.integer(static_cast<std::int64_t>(n));
  }));
  sections.push_back(items(variant, mesh.points.size(), [&mesh](std::uint64_t i, ItemWriter& out) {
    const Point& p = mesh.points.raw()[i];
    if (!is_finite(p)) throw_node_not_finite(i);
    for (std::size_t axis = 0; axis < 3; ++axis) out.real(p[axis]);
  }));
  sections.push_back(items(variant, mesh.boundary_triangles.size(), [&mesh](std::uint64_t i, ItemWriter& out) {
    for (const std::size_t k : {0, 2, 1}) out.node(mesh.boundary_triangles[i].nodes[k]);
  }));
  sections.push_back(items(variant, mesh.boundary_quads.size(), [&mesh](std::uint64_t i, ItemWriter& out) {
    for (const std::size_t k : {0, 3, 2, 1}) out.node(mesh.boundary_quads[i].nodes[k]);
  }));
  sections.push_back(
      items(variant, mesh.boundary_triangles.size(), [&mesh](std::uint64_t i, ItemWriter& out) { out.integer(mesh.boundary_triangles[i].patch.value() + 1); }));
  sections.push_back(
      items(variant, mesh.boundary_quads.size(), [&mesh](std::uint64_t i, ItemWriter& out) { out.integer(mesh.boundary_quads[i].patch.value() + 1); }));
  for (const CellKind kind : k_ugrid_kinds) sections.push_back(cell_section(variant, cells, kind));
  return sections;
}

/// Returns the axis in which the patch is thinnest. FUN3D has one symmetry condition per axis: 6661, 6662, 6663 for the normal x, y, z.
int symmetry_axis(const HybridMesh& mesh, const FacesByPatch& faces, PatchId patch) {
  Box box;
  for (const std::uint32_t f : faces.triangles(patch))
    for (const NodeId node : mesh.boundary_triangles[f].nodes) box.add(mesh.points[node]);
  for (const std::uint32_t f : faces.quads(patch))
    for (const NodeId node : mesh.boundary_quads[f].nodes) box.add(mesh.points[node]);
  const Vec3 size = box.max - box.min;
  int thinnest = 1;  // y, as for aircraft, unless another axis is thinner
  for (const int axis : {0, 2})
    if (size[static_cast<std::size_t>(axis)] < size[static_cast<std::size_t>(thinnest)]) thinnest = axis;
  return thinnest;
}

int condition_of(const HybridMesh& mesh, const FacesByPatch& faces, PatchId patch, const RunContext& context) {
  switch (mesh.patches[patch].kind) {
    case PatchKind::wall: return 4000;
    case PatchKind::slip: return 3000;
    case PatchKind::symmetry: return 6661 + symmetry_axis(mesh, faces, patch);
    case PatchKind::inflow: return 7011;
    case PatchKind::outflow: return 7012;
    case PatchKind::farfield: return 5000;
    case PatchKind::interface: break;
  }
  context.warn("patch \"" + mesh.patches[patch].name + "\" is an interface, for which .mapbc has no condition; it is written as 3000 (slip)");
  return 3000;
}

std::string mapbc_text(const HybridMesh& mesh, const FacesByPatch& faces, const RunContext& context) {
  const std::vector<std::string> names = names_by_rules(mesh.patches, {.format = ".mapbc"}, context);
  std::string lines;
  int n = 0;
  for (const PatchId patch : mesh.patches.ids()) {
    if (faces.count(patch) == 0) continue;
    lines += std::to_string(patch.value() + 1) + " " + std::to_string(condition_of(mesh, faces, patch, context)) + " " + names[patch.index()] + "\n";
    ++n;
  }
  return std::to_string(n) + "\n" + lines;
}

/// Returns the coordinates as read from a single-precision file.
std::vector<Point> in_single_precision(const HybridMesh& mesh, const RunContext& context) {
  const auto rounded = [](double value) { return static_cast<double>(static_cast<float>(value)); };
  std::vector<Point> locations(mesh.points.size());
  parallel_for(context, locations.size(), [&](std::size_t i) {
    const Point& p = mesh.points.raw()[i];
    locations[i] = {rounded(p.x), rounded(p.y), rounded(p.z)};
  });
  return locations;
}

/// Warns about the node displacement caused by single precision.
/// \throws Error mesh_invalid if cells are flat or folded at the coordinates of the file.
void require_single_precision_cells(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const std::vector<Point> locations = in_single_precision(mesh, context);
  const double moved = parallel_reduce(
      context, locations.size(), 0.0,
      [&](std::size_t begin, std::size_t end) {
        double largest = 0.0;
        for (std::size_t i = begin; i < end; ++i) largest = std::max(largest, distance(mesh.points.raw()[i], locations[i]));
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
  if (moved == 0.0) return;
  LostCells lost = cells_lost_by_rounding(mesh, locations, context);
  if (lost.n > 0) {
    throw Error({.code = ErrorCode::mesh_invalid,
                 .attempted = "writing " + path.string(),
                 .problem = "single precision moves nodes by up to " + number_text(moved, 2) + " m, which makes " + std::to_string(lost.n) +
                            (lost.n == 1 ? " cell" : " cells") + " flat or folded",
                 .locations = std::move(lost.locations),
                 .n_locations = lost.n,
                 .hint = "write double precision: .lb8.ugrid, .b8.ugrid, .lb8l.ugrid or .b8l.ugrid"});
  }
  context.warn(path.string() + ": the file is single precision: nodes move by up to " + number_text(moved, 2) +
               " m; .b8.ugrid and .lb8.ugrid are double precision");
}

}  // namespace

void write_volume_ugrid(const HybridMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const UgridVariant variant = ugrid_variant(path);
  const CellSections cells(mesh);
  const FacesByPatch faces(mesh);
  if (!variant.is_text && !variant.is_wide) {
    constexpr std::uint64_t k_limit = std::numeric_limits<std::int32_t>::max();
    const std::string format = "UGRID with 32-bit integers (64-bit: .lb8l.ugrid, .b8l.ugrid)";
    require_count(mesh.points.size(), k_limit, "nodes", format, path.string());
    require_count(std::max(mesh.boundary_triangles.size(), mesh.boundary_quads.size()), k_limit, "boundary faces", format, path.string());
    for (const CellKind kind : k_ugrid_kinds) require_count(cells.count(kind), k_limit, "cells of kind " + std::string(to_string(kind)), format, path.string());
  }
  if (variant.is_single) require_single_precision_cells(mesh, path, context);
  AtomicFile conditions(mapbc_path(path));
  conditions.append(mapbc_text(mesh, faces, context));
  AtomicFile file(path);
  write_sections(file, sections_of(mesh, cells, variant), context);
  const StageTimer timer(context, "sync");
  file.commit();
  conditions.commit();
}

}  // namespace sterna::io
