// The surface part of a report or workbench page: triangles with patches, edges and figures, as arrays and the JSON that describes them (docs/report.md).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/mesh/cut.h"
#include "geom/mesh/cut_locations.h"
#include "geom/mesh/gates.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/surface_fields.h"
#include "geom/mesh/tri_mesh.h"
#include "scripting/report/page_arrays.h"
#include "scripting/values/option_json.h"

namespace sterna::scripting {

/// Boundary faces as triangles, with the face of each triangle and its edges on that face.
struct PageTriangles {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> face;  ///< triangles, then quads
  std::vector<std::uint8_t> edges;  ///< bit k: the side from corner k to k + 1 is an edge of the face
  std::vector<std::uint16_t> patch;
  std::vector<std::uint8_t> is_of_body = {};  ///< by patch: shown by default (geom/mesh/body_patches.h); empty: all patches
};
PageTriangles page_triangles(const HybridMesh& mesh);
PageTriangles page_triangles(const TriMesh& mesh);

/// Returns a JSON object of the values of a field and their description.
Json page_field_json(std::string_view name, std::string_view title, std::string_view unit, bool is_log, bool is_low_bad, const GateLimits& limits,
                     const std::vector<float>& values, PageArrays& arrays);

/// Creates the common parts of all pages. The arguments must outlive this object.
class PageMaker {
 public:
  /// \throws Error(overflow) for more than 65 536 patches
  PageMaker(std::span<const Point> points, const PageTriangles& triangles, const Column<PatchId, Patch>& patches, const std::vector<SurfaceField>& fields);
  const Point& origin() const { return origin_; }
  double length() const { return length_; }
  Json frame_json() const;    ///< object with length and origin
  Json patches_json() const;  ///< list with name, kind, area, number of triangles of each
  /// Returns an object with the arrays, positions relative to the origin, decimated to at most `most` triangles.
  Json surface_json(std::size_t most, PageArrays& arrays) const;

 private:
  std::span<const Point> points_;
  const PageTriangles& triangles_;
  const Column<PatchId, Patch>& patches_;
  const std::vector<SurfaceField>& fields_;
  Point origin_{};
  double length_ = 1.0;
};

/// Returns an object with the polygons nearest to the focus of the cut, at most `most`, relative to the focus.
Json page_cut_json(const CutLocation& location, const MeshCut& cut, std::size_t most, PageArrays& arrays);

}  // namespace sterna::scripting
