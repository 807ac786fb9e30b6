// Findings of an inspection: one entry for each kind of problem, with its worst locations and one line of advice.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "geom/base/error.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/mesh/tri_mesh_field.h"

namespace sterna::volmesh {

enum class Severity : std::uint8_t {
  note,   ///< information only
  warn,   ///< volume_mesh makes a mesh, but layers are lower than requested, or cells have poor quality
  error,  ///< volume_mesh rejects the surface
};
std::string_view to_string(Severity severity);

/// Kinds of findings, in the order of the report. The number of a kind is its code in the field "finding" of pictures (0: no finding).
enum class FindingKind : std::uint8_t {
  none,
  malformed,     ///< invalid indices or coordinates, or no triangles at all
  non_manifold,  ///< edges of more than two triangles, or vertices of several fans
  open,          ///< edges of one triangle
  not_orientable,
  crossing,  ///< pairs of triangles that intersect or touch
  refused,   ///< other errors of volume_mesh
  turned,    ///< triangles whose orientation was repaired when the file was read
  repaired,  ///< other repairs when the file was read
  unit,      ///< body length outside the range of aircraft
  bodies,    ///< several bodies
  cavity,    ///< a body inside the solid of another body
  needle,
  fold,
  coarse,
  size_jump,
  short_edge,
  contact,
  hidden,  ///< vertices for which there is no direction from which all facets are visible
  visibility,
  lowered,     ///< layer below 0.9 of the target height
  compressed,  ///< layer lower than the sum of its first heights
  collapsed,   ///< no layer
  tall_first,  ///< first height larger than the edges
  thin_top,    ///< last layer thinner than the tetrahedra on top of it
  thick_top,   ///< last layer thicker than the tetrahedra on top of it
  y_plus,
  thin_base,       ///< blunt base that is much thinner than its layer
  wake,            ///< the wake of the body is not refined
  not_looked_at,   ///< checks that were skipped, with the reason
  many_triangles,  ///< sizes that require very many triangles of the surface
};
std::string_view to_string(FindingKind kind);

struct FindingLocation {
  Point position;
  std::string patch;
  double value = 0.0;  ///< value in the unit of the finding
  std::string what;    ///< text such as "triangle 12 crosses triangle 840"
};

inline constexpr double k_no_value = std::numeric_limits<double>::quiet_NaN();

struct Finding {
  FindingKind kind = FindingKind::none;
  Severity severity = Severity::note;
  std::int64_t count = 0;     ///< total number of locations
  double share = k_no_value;  ///< fraction of the wall's area; NaN: the finding has no area
  double value = k_no_value;  ///< the worst value; NaN: the finding has no value
  double limit = k_no_value;
  std::string unit;                        ///< unit of value and limit: "m", "deg" or empty
  std::string text;                        ///< one sentence for the report
  std::string advice;                      ///< one line with a remedy; empty if no action is needed
  std::vector<FindingLocation> locations;  ///< worst locations first, at most InspectOptions::max_places
};

/// Predicted layer, computed by the first steps of the envelope.
struct LayerPrediction {
  bool is_known = false;                                  ///< false: no first height was given, or the surface is rejected
  double coverage = 0.0;                                  ///< fraction of the wall's area with at least 0.9 of the target height, measured along the normal
  double compressed = 0.0;                                ///< fraction of the area with a height below n h0
  double collapsed = 0.0;                                 ///< fraction of the area without a layer
  std::vector<std::pair<std::string, double>> lost_area;  ///< fraction of the area below 0.9 of the target for each reason, largest first
  struct OfPatch {
    std::string name;
    double area = 0.0, coverage = 0.0, compressed = 0.0, collapsed = 0.0;
  };
  std::vector<OfPatch> patches;
};

struct InspectReport {
  TriMesh mesh;               ///< the inspected surface; if its triangles could not be joined, they are as in the file
  double length = 0.0;        ///< m, longest side of the bounding box
  std::int64_t n_bodies = 0;  ///< number of connected parts
  bool is_closed = false;
  std::vector<Finding> findings;  ///< errors first, then by kind
  LayerPrediction layer;
  std::vector<TriMeshField> fields;  ///< fields on `mesh`; "finding" is the number of the kind of the most severe finding at a triangle

  std::int64_t count(Severity severity) const;
  bool is_ok() const { return count(Severity::error) == 0; }
  const Finding* find(FindingKind kind) const;
};

}  // namespace sterna::volmesh
