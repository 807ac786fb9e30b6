// Inside geom/cad only: shapes of OpenCASCADE together with the names that its topology does not carry.
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

/// What a file says about a face beside its geometry.
struct FaceLabel {
  std::string name;
  std::optional<std::array<float, 3>> colour;
  std::string layer;
  std::string component = {};  ///< overrules that of the part: sewing joins faces of several
  bool is_empty() const { return name.empty() && !colour && layer.empty(); }
};

/// One solid, shell, or set of loose faces of a file.
struct ShapePart {
  TopoDS_Shape shape;
  std::string component;  ///< name of the instance it belongs to; may be empty
  std::string name;       ///< its own name; may be empty
  FaceLabel label;        ///< of all its faces that have none of their own
};

/// Faces by their identity (IsSame: the same geometry at the same placement).
using FaceLabels = NCollection_DataMap<TopoDS_Shape, FaceLabel, TopTools_ShapeMapHasher>;

struct LabelledShape {
  std::vector<ShapePart> parts;
  FaceLabels labels;
};

/// The model of labelled shapes, with model.shape set. Faces of solids come first, in the order of the parts. Every edge gets its curves in space and in the
/// faces (built where missing, made to agree in parameter).
/// \throws Error(geometry_failed) with the place of a face or edge that has no geometry.
Model model_of(const LabelledShape& labelled, const std::string& attempted, const RunContext& context);

/// A point on the shape: of an edge half way along it, of a face its centre in the parameters, of others their first vertex.
Point place_of(const TopoDS_Shape& shape);

/// All parts in one compound.
TopoDS_Shape compound_of(const std::vector<ShapePart>& parts);

/// Longest side of the bounding box, metres; 0 for an empty shape.
double longest_side(const TopoDS_Shape& shape);

}  // namespace cad
}  // namespace sterna
