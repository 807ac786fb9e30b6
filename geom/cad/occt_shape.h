// Inside geom/cad only: shapes of OpenCASCADE together with the names that their topology does not carry.
#pragma once

#include <NCollection_DataMap.hxx>
#include <TopTools_ShapeMapHasher.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geom/cad/shape.h"

namespace sterna {

/// Shapes in the order of the Model's columns.
struct CadShape::Content {
  TopoDS_Shape shape;  ///< compound of the solids, shells and loose faces, metres
  std::vector<TopoDS_Face> faces;
  std::vector<TopoDS_Edge> edges;
  std::vector<TopoDS_Shape> solids;  ///< solids and open shells
};

namespace cad {

/// Attributes of a face in a file apart from its geometry.
struct FaceLabel {
  std::string name;
  std::optional<std::array<float, 3>> colour;
  std::string layer;
  std::string component = {};  ///< takes precedence over the component of the part, since sewing may join faces of several components in one part
  bool is_empty() const { return name.empty() && !colour && layer.empty(); }
};

/// One solid, shell, or set of loose faces of a file.
struct ShapePart {
  TopoDS_Shape shape;
  std::string component;  ///< name of the instance it belongs to; may be empty
  std::string name;       ///< its own name; may be empty
  FaceLabel label;        ///< label of all its faces without their own label
};

/// Labels of faces, keyed by identity (IsSame: the same geometry at the same placement).
using FaceLabels = NCollection_DataMap<TopoDS_Shape, FaceLabel, TopTools_ShapeMapHasher>;

struct LabelledShape {
  std::vector<ShapePart> parts;
  FaceLabels labels;
};

/// Converts labelled shapes to a model, with model.shape set. Faces of solids come first, in the order of the parts. Every edge gets its curves in space and in
/// the faces (built if missing, with consistent parameters).
/// \throws Error(geometry_failed) with the location of a face or edge that has no geometry.
Model model_of(const LabelledShape& labelled, const std::string& attempted, const RunContext& context);

/// Returns a point on the shape: the middle of an edge, the parametric centre of a face, the first vertex of other shapes.
Point location_of(const TopoDS_Shape& shape);

/// Returns all parts in one compound.
TopoDS_Shape compound_of(const std::vector<ShapePart>& parts);

/// Returns the longest side of the bounding box, metres; 0 for an empty shape.
double longest_side(const TopoDS_Shape& shape);

}  // namespace cad
}  // namespace sterna
