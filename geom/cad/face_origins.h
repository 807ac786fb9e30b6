// Inside geom/cad only: which faces of the arguments the faces of a boolean's result are pieces of, and what they keep of them.
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

/// Where a face of the result came from.
struct FaceOrigin {
  std::size_t part = 0;
  FaceId face;
};
using FaceOrigins = NCollection_DataMap<TopoDS_Shape, FaceOrigin, TopTools_ShapeMapHasher>;

/// With shape, volume and area.
/// \throws Error(open_surface) with places unless every solid is closed
BooleanPart boolean_part(const Model& model, const std::string& attempted, const RunContext& context);

/// Faces of the parts' shapes and their pieces after `operation`; faces that coincide belong to the first part.
FaceOrigins origins_of(BRepBuilderAPI_MakeShape& operation, std::span<const BooleanPart> parts);

/// A result with names, colours, layers and components of the parts' faces.
LabelledShape labelled(const TopoDS_Shape& shape, const FaceOrigins& origins, std::span<const BooleanPart> parts);

/// Gives faces of a model made by `labelled` the roles, kinds, components' kinds and, where it is the same, the very surface of what they came from; `of_face`
/// gets the origin of each. \returns what is wrong; empty: nothing
std::string restore_origins(Model& model, const FaceOrigins& origins, std::span<const BooleanPart> parts, std::vector<FaceOrigin>& of_face);

/// Middles of the free edges.
std::vector<ErrorPlace> open_places(const Model& model);

/// Each solid is closed, and there is one.
bool is_closed_model(const Model& model);

}  // namespace sterna::cad
