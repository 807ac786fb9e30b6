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
  warn,   ///< volume_mesh makes a mesh, but layers are lower than requested, or cells are bad
  error,  ///< volume_mesh rejects the surface
};
std::string_view to_string(Severity severity);

/// Kinds in the order of the report. The number is the code in the field "finding" of pictures (0: no finding).
enum class FindingKind : std::uint8_t {
  none,
  malformed,     ///< invalid indices or coordinates, or no triangles at all
  non_manifold,  ///< edges of more than two triangles, vertices of several fans
  open,          ///< edges of one triangle
  not_orientable,
  crossing,  ///< pairs of triangles that intersect or touch
  refused,   ///< other errors of volume_mesh
  turned,    ///< triangles whose orientation was repaired during reading
  repaired,  ///< other repairs during reading
  unit,      ///< body length outside the range of aircraft
  bodies,    ///< several bodies
  cavity,    ///< a body inside the solid of another body
  needle,
  fold,
  coarse,
  size_jump,
  short_edge,
  contact,
  hidden,  ///< no direction in which all facets of a vertex are visible
  visibility,
  lowered,     ///< below 0.9 of the target height
  compressed,  ///< lower than the first cells alone
  collapsed,   ///< no layer
  tall_first,  ///< first height above the edges
  thin_top,    ///< last layer thinner than the tetrahedra on it
  thick_top,   ///< last layer thicker than the tetrahedra on it
  y_plus,
  thin_base,       ///< blunt base much thinner than its layer
  wake,            ///< the wake of the body is not refined
  not_looked_at,   ///< skipped checks, and the reason
  many_triangles,  ///< the sizes require very many triangles of the surface
};
std::string_view to_string(FindingKind kind);

struct FindingPlace {
  Point position;
  std::string patch;
  double value = 0.0;  ///< in the unit of the finding
  std::string what;    ///< "triangle 12 crosses triangle 840"
};

inline constexpr double k_no_value = std::numeric_limits<double>::quiet_NaN();

struct Finding {
  FindingKind kind = FindingKind::none;
  Severity severity = Severity::note;
  std::int64_t count = 0;     ///< total number of locations
  double share = k_no_value;  ///< share of the wall's area; NaN: not by area
  double value = k_no_value;  ///< the worst value; NaN: none
  double limit = k_no_value;
  std::string unit;                  ///< unit of value and limit: "m", "deg" or empty
  std::string text;                  ///< one sentence
  std::string advice;                ///< one line; empty if no action is needed
  std::vector<FindingPlace> places;  ///< the worst first, at most InspectOptions::max_places
};

/// Predicted layer, from the first steps of the envelope.
struct LayerPrediction {
  bool is_known = false;                                  ///< false: no first height was given, or the surface is rejected
  double coverage = 0.0;                                  ///< share of the wall's area with at least 0.9 of the target height, along the normal
  double compressed = 0.0;                                ///< share of the area below n h0
  double collapsed = 0.0;                                 ///< share of the area without a layer
  std::vector<std::pair<std::string, double>> lost_area;  ///< share of the area below 0.9 of the target, by reason, largest first
  struct OfPatch {
    std::string name;
    double area = 0.0, coverage = 0.0, compressed = 0.0, collapsed = 0.0;
  };
  std::vector<OfPatch> patches;
};

struct InspectReport {
  TriMesh mesh;               ///< the inspected surface; if it could not be joined, its triangles as in the file
  double length = 0.0;        ///< m, longest side of the bounding box
  std::int64_t n_bodies = 0;  ///< connected parts
  bool is_closed = false;
  std::vector<Finding> findings;  ///< errors first, then by kind
  LayerPrediction layer;
  std::vector<TriMeshField> fields;  ///< fields on `mesh`; "finding" is the kind's number of the most severe finding at a triangle

  std::int64_t count(Severity severity) const;
  bool is_ok() const { return count(Severity::error) == 0; }
  const Finding* find(FindingKind kind) const;
};

}  // namespace sterna::volmesh
