// Geometry model: named faces on exact surfaces, with edges shared between them. Models are built by components, readers and booleans, and used by the surface
// mesher and the writers.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/ids.h"
#include "geom/mesh/tri_mesh.h"
#include "geom/model/curve.h"
#include "geom/model/surface.h"

namespace sterna {

using CornerId = Id<struct CornerTag>;  ///< point where edges end
using EdgeId = Id<struct EdgeTag>;
using FaceId = Id<struct FaceTag>;
using SolidId = Id<struct SolidTag>;
using ComponentId = Id<struct ComponentTag>;

/// Kind of a component; determines default sizes of the surface mesh.
enum class ComponentKind { unknown, body, wing, nacelle, pylon, fairing, boom, sting, box, tunnel };
/// Role of a face within its component; determines bands, caps and boundary conditions.
enum class FaceRole {
  unknown,
  skin,
  upper,
  lower,
  leading_edge,
  trailing_edge,
  tip,
  nose,
  tail,
  inlet_lip,
  fan_face,
  nozzle,
  jet,
  control,
  control_side,
  hinge,
  wall,
  inflow,
  outflow,
  symmetry,
  farfield,
  fillet
};
std::string_view to_string(ComponentKind kind);
std::string_view to_string(FaceRole role);

struct Component {
  std::string name;
  ComponentKind kind = ComponentKind::unknown;
};

struct ModelCorner {
  Point point;
  double tolerance = 0.0;  ///< metres: edges end within this distance
};

struct ModelEdge {
  CurvePtr curve;          ///< in space; empty for a degenerate edge (a pole)
  Interval range;          ///< part of the curve that is the edge
  CornerId start, end;     ///< equal for a closed edge
  double tolerance = 0.0;  ///< metres: the surfaces of its faces pass within this distance
  std::string name;        ///< mostly empty: "leading edge", "hinge"
  bool is_degenerate() const { return curve == nullptr; }
};

/// One use of an edge in the border of a face. The parameter curve has the parameter of the edge (same range, same speed).
struct EdgeUse {
  EdgeId edge;
  bool is_reversed = false;     ///< the border runs from the edge's end to its start
  ParameterCurvePtr parameter;  ///< in the face's (u, v); never empty
};
/// Closed border, in order; the face lies to the left in (u, v) of the outer border, holes run in the opposite sense.
using Border = std::vector<EdgeUse>;

struct ModelFace {
  SurfacePtr surface;
  std::vector<Border> borders;  ///< the outer border first; on periodic surfaces the seam is two uses of one edge, poles are degenerate edges
  bool is_reversed = false;     ///< the outward normal (into the fluid) is -(du x dv)
  ComponentId component;
  FaceRole role = FaceRole::skin;
  std::string name;                            ///< becomes the patch name of meshes; never empty
  std::optional<std::array<float, 3>> colour;  ///< red, green, blue in [0, 1]
  std::string layer;
  double tolerance = 0.0;              ///< metres
  std::optional<PatchKind> kind = {};  ///< kind of its patch in meshes; empty: given by its role
};
/// Returns the boundary kind of a face: its own kind if set, else inflow, outflow, symmetry or farfield if that is its role, else a wall.
PatchKind patch_kind(const ModelFace& face);

struct ModelSolid {
  std::string name;
  std::vector<FaceId> faces;
  bool is_closed = false;  ///< a shell without free edges; `false`: an open shell
};

class CadShape;  ///< geom/cad/shape.h: the same geometry in OpenCASCADE

/// Plain struct of columns; metres. Invariants: indices in range; every face has a border; ends of consecutive uses of a border meet.
struct Model {
  Column<ComponentId, Component> components;
  Column<CornerId, ModelCorner> corners;
  Column<EdgeId, ModelEdge> edges;
  Column<FaceId, ModelFace> faces;
  Column<SolidId, ModelSolid> solids;     ///< every face is in at most one solid; faces in none are loose
  std::string source_unit = "m";          ///< unit of the source file; the model itself is in metres
  std::shared_ptr<const CadShape> shape;  ///< empty until required by a boolean or a writer; see cad::shape_of
};

/// All uses of an edge: (face, border, position in it), in ascending order of faces.
struct EdgeUseLocation {
  FaceId face;
  std::uint32_t border = 0;
  std::uint32_t location = 0;
};
Column<EdgeId, std::vector<EdgeUseLocation>> uses_of_edges(const Model& model);
/// Returns the edges with a single use that are not degenerate: the open boundary of a shell.
std::vector<EdgeId> free_edges(const Model& model);

}  // namespace sterna
