// What an inspection finds: one entry for each kind of trouble, with its worst places and one line of advice.
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
  note,   ///< good to know
  warn,   ///< volume_mesh makes a mesh, but layers are lower than asked for, or cells bad
  error,  ///< volume_mesh refuses the surface
};
std::string_view to_string(Severity severity);

/// In the order of the report. The number is the code in the field "finding" of pictures (0: nothing found there).
enum class FindingKind : std::uint8_t {
  none,
  malformed,     ///< indices or coordinates that mean nothing, or nothing at all
  non_manifold,  ///< edges of more than two triangles, vertices of several fans
  open,          ///< edges of one triangle
  not_orientable,
  crossing,  ///< pairs of triangles that cross or touch
  refused,   ///< what else volume_mesh says
  turned,    ///< triangles whose orientation was repaired on reading
  repaired,  ///< other repairs on reading
  unit,      ///< body length that is no aircraft's
  bodies,    ///< several bodies
  cavity,    ///< a body within another one's solid
  needle,
  fold,
  coarse,
  size_jump,
  short_edge,
  contact,
  hidden,  ///< no direction sees all facets of a vertex
  visibility,
  lowered,     ///< below 0.9 of the target height
  compressed,  ///< lower than the first cells alone
  collapsed,   ///< no layer
  tall_first,  ///< first height above the edges
  thin_top,    ///< last layer thinner than the tetrahedra above it
  thick_top,   ///< thicker
  y_plus,
  thin_base,       ///< blunt base much thinner than the layer on it
  wake,            ///< nothing keeps edges short in what the body leaves behind
  not_looked_at,   ///< what was left out, and why
  many_triangles,  ///< sizes ask for very many triangles of the surface
};
std::string_view to_string(FindingKind kind);

struct FindingPlace {
  Point position;
  std::string patch;
  double value = 0.0;  ///< in the finding's unit
  std::string what;    ///< "triangle 12 crosses triangle 840"
};

inline constexpr double k_no_value = std::numeric_limits<double>::quiet_NaN();

struct Finding {
  FindingKind kind = FindingKind::none;
  Severity severity = Severity::note;
  std::int64_t count = 0;     ///< places in all
  double share = k_no_value;  ///< of the wall's area; NaN: not by area
  double value = k_no_value;  ///< the worst; NaN: none
  double limit = k_no_value;
  std::string unit;                  ///< of value and limit: "m", "deg" or empty
  std::string text;                  ///< one sentence
  std::string advice;                ///< one line; empty where nothing is to be done
  std::vector<FindingPlace> places;  ///< the worst first, at most InspectOptions::max_places
};

/// What will become of the layer, by the first steps of the envelope.
struct LayerPrediction {
  bool is_known = false;                                  ///< false: no first height was given, or the surface is refused
  double coverage = 0.0;                                  ///< share of the wall's area at 0.9 of its target height or more, along the normal
  double compressed = 0.0;                                ///< share of the area below n h0
  double collapsed = 0.0;                                 ///< share of the area without layer
  std::vector<std::pair<std::string, double>> lost_area;  ///< share below 0.9 of the target, by reason, largest first
  struct OfPatch {
    std::string name;
    double area = 0.0, coverage = 0.0, compressed = 0.0, collapsed = 0.0;
  };
  std::vector<OfPatch> patches;
};

struct InspectReport {
  TriMesh mesh;               ///< the surface that was looked at; where it could not be joined, its triangles as they are in the file
  double length = 0.0;        ///< m, longest side of its box
  std::int64_t n_bodies = 0;  ///< connected parts
  bool is_closed = false;
  std::vector<Finding> findings;  ///< errors first, then by kind
  LayerPrediction layer;
  std::vector<TriMeshField> fields;  ///< on `mesh`; "finding" is the kind's number of the most severe finding at a triangle

  std::int64_t count(Severity severity) const;
  bool is_ok() const { return count(Severity::error) == 0; }
  const Finding* find(FindingKind kind) const;
};

}  // namespace sterna::volmesh
