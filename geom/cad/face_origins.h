// Inside geom/cad only: maps the faces of a boolean's result to the argument faces of which they are pieces, and restores their attributes.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "geom/cad/find_contacts.h"
#include "geom/cad/occt_shape.h"

class BRepBuilderAPI_MakeShape;

namespace sterna::cad {

/// An argument of a boolean.
struct BooleanPart {
  const Model* model = nullptr;
  std::shared_ptr<const CadShape> shape;
  double volume = 0.0;  ///< m^3
  double area = 0.0;    ///< m^2
  PartExposure exposure = {};
  std::string name() const { return part_name(*model); }
};

/// Origin of a face of the result.
struct FaceOrigin {
  std::size_t part = 0;
  FaceId face;
};
using FaceOrigins = NCollection_DataMap<TopoDS_Shape, FaceOrigin, TopTools_ShapeMapHasher>;

/// Returns a part with its shape, volume and area.
/// \throws Error(open_surface) with locations unless every solid is closed
BooleanPart boolean_part(const Model& model, const std::string& attempted, const RunContext& context);

/// Returns the origins of the faces after `operation`: faces of the parts' shapes and their pieces; coincident faces belong to the first part.
FaceOrigins origins_of(BRepBuilderAPI_MakeShape& operation, std::span<const BooleanPart> parts);

/// Returns the result with names, colours, layers and components of the parts' faces.
LabelledShape labelled(const TopoDS_Shape& shape, const FaceOrigins& origins, std::span<const BooleanPart> parts);

/// Restores attributes of a model made by `labelled`: roles, kinds, kinds of components and, if the geometry is the same, the original surface object of the
/// faces. `of_face` receives the origin of each face. Returns a description of the problem, empty if there is none.
std::string restore_origins(Model& model, const FaceOrigins& origins, std::span<const BooleanPart> parts, std::vector<FaceOrigin>& of_face);

/// Returns the midpoints of the free edges.
std::vector<ErrorLocation> open_locations(const Model& model);

/// Returns true if there is at least one solid and all solids are closed.
bool is_closed_model(const Model& model);

}  // namespace sterna::cad
