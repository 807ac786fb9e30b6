// What the VTK formats (legacy, VTU, VTP) hold once their arrays are decoded, and what becomes of it: a surface or a volume mesh (docs/method/formats.md, "VTK
// family").
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_soup.h"
#include "io/grammar/vtu_arrays.h"

namespace sterna::io {

/// Cell arrays that number boundaries, in order of preference.
inline constexpr std::array<std::string_view, 5> k_vtk_marker_names = {"marker", "boundary", "CellEntityIds", "gmsh:physical", "ids"};
/// Single numbers of this name, "patch:<kind>:<name>", say which marker means which patch; written by us.
inline constexpr std::string_view k_vtk_patch_prefix = "patch:";
std::string vtk_patch_key(const Patch& patch);

/// Cells whose nodes stand one after the other.
struct VtkCells {
  std::optional<VtuValues> connectivity;
  std::optional<VtuValues> ends;   ///< of each cell's nodes in `connectivity`; integers
  std::optional<VtuValues> types;  ///< absent: all of `type`
  int type = 0;
  std::size_t size() const { return ends ? ends->size() : 0; }
};

struct VtkPiece {
  std::string where;          ///< for messages: "piece at byte 400"
  std::vector<Point> points;  ///< perhaps with coordinates that are not finite
  std::vector<VtkCells> cells;
  std::optional<VtuValues> markers;  ///< per cell, over all of `cells`
  std::string marker_name;           ///< of that array
};

struct VtkGrid {
  std::string source;
  bool is_surface = false;  ///< PolyData: its cells never are volumes
  std::vector<VtkPiece> pieces;
  std::map<std::uint64_t, Patch> patches;  ///< by marker
  bool single_precision = false;

  /// Takes "patch:<kind>:<name>"; other names of field data are not ours.
  void add_patch(std::string_view field_name, std::uint64_t marker);
};

/// Triangles, quads, polygons, pixels, strips, corners of faces of second order; of a volume mesh its boundary faces. Points that no face uses are left out of
/// a volume mesh; one without faces gives no triangles.
/// \throws Error file_malformed (indices out of range, sizes that disagree), overflow, cancelled.
SurfaceSoup surface_of(const VtkGrid& grid, const RunContext& context);

/// Cells in the explicit arrays, windings repaired.
/// \throws Error file_malformed, unsupported_format (other cells), overflow, cancelled.
HybridMesh volume_of(const VtkGrid& grid, const RunContext& context);

}  // namespace sterna::io
