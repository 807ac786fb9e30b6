// Decoded contents of the VTK formats (legacy, VTU, VTP), and conversion to a surface or a volume mesh (docs/method/formats.md, "VTK family").
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

/// Cell arrays that identify boundaries, in order of preference.
inline constexpr std::array<std::string_view, 5> k_vtk_marker_names = {"marker", "boundary", "CellEntityIds", "gmsh:physical", "ids"};
/// Prefix of single numbers "patch:<kind>:<name>", which sterna writes to map markers to patches.
inline constexpr std::string_view k_vtk_patch_prefix = "patch:";
std::string vtk_patch_key(const Patch& patch);

/// Cells whose nodes are stored consecutively.
struct VtkCells {
  std::optional<VtuValues> connectivity;
  std::optional<VtuValues> ends;   ///< end of each cell's nodes in `connectivity`; integers
  std::optional<VtuValues> types;  ///< absent: all cells have type `type`
  int type = 0;
  std::size_t size() const { return ends ? ends->size() : 0; }
};

struct VtkPiece {
  std::string where;          ///< for messages: "piece at byte 400"
  std::vector<Point> points;  ///< coordinates may not be finite
  std::vector<VtkCells> cells;
  std::optional<VtuValues> markers;  ///< one marker per cell, over all of `cells`
  std::string marker_name;           ///< name of that array
};

struct VtkGrid {
  std::string source;
  bool is_surface = false;  ///< PolyData: never has volume cells
  std::vector<VtkPiece> pieces;
  std::map<std::uint64_t, Patch> patches;  ///< by marker
  bool single_precision = false;

  /// Parses "patch:<kind>:<name>"; other field data are ignored.
  void add_patch(std::string_view field_name, std::uint64_t marker);
};

/// Returns the faces as a surface: triangles, quads, polygons, pixels, strips, and corners of second-order faces; for a volume mesh its boundary faces. Points
/// that no face uses are left out of a volume mesh; a mesh without faces gives no triangles.
/// \throws Error file_malformed (indices out of range, sizes that disagree), overflow, cancelled.
SurfaceSoup surface_of(const VtkGrid& grid, const RunContext& context);

/// Returns a volume mesh with cells in the explicit arrays and windings repaired.
/// \throws Error file_malformed, unsupported_format (other cells), overflow, cancelled.
HybridMesh volume_of(const VtkGrid& grid, const RunContext& context);

}  // namespace sterna::io
