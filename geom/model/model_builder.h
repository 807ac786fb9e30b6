// Makes models face by face over shared edges, and proves them closed. What components, tunnels and boxes are built with.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geom/model/frame.h"
#include "geom/model/model.h"

namespace sterna {

/// The curve of a surface's NURBS form along one parameter line: u = at (its parameter is v) or v = at (u).
/// \pre polynomial or rational form, `at` in the domain
CurvePtr line_of_constant_u(const NurbsSurfaceForm& form, double at);
CurvePtr line_of_constant_v(const NurbsSurfaceForm& form, double at);

/// The curve S(from + t (to - from)), t in [0, 1], exactly: a spline of the sum of both degrees.
/// \pre polynomial form, both points in its domain
CurvePtr line_on_surface(const NurbsSurfaceForm& form, Uv from, Uv to);

/// A curve cut into edges: edges[i] runs from corners[i] to corners[i + 1], over the parameters at[i] .. at[i + 1].
struct SplitCurve {
  CurvePtr curve;
  std::vector<double> at;
  std::vector<CornerId> corners;
  std::vector<EdgeId> edges;
};

class ModelBuilder {
 public:
  /// All faces that are added belong to this component.
  explicit ModelBuilder(Component component);

  CornerId corner(const Point& point);
  EdgeId edge(CurvePtr curve, Interval range, CornerId start, CornerId end, std::string name = {});
  EdgeId straight_edge(CornerId start, CornerId end, std::string name = {});
  /// `at` ascends from the start to the end of the edges; corners between the first and the last are made.
  SplitCurve split_curve(CurvePtr curve, std::vector<double> at, CornerId first, CornerId last, const std::string& name = {});
  /// A pole of a surface.
  EdgeId pole(CornerId at);

  /// Face on the part `box` of a surface; edges in the order v = from, u = to, v = to, u = from. The edges' directions are found from their points; they must
  /// run over the sides with proportional parameters (poles: any).
  /// \throws Error(internal) naming the side that an edge does not follow
  FaceId patch(SurfacePtr surface, const ParameterBox& box, const std::array<EdgeId, 4>& sides, FaceRole role, const std::string& name);
  /// One side of a face: an edge that follows the straight line between two places of the parameter plane.
  struct Side {
    EdgeId edge;
    Uv from, to;
  };
  /// Face with straight sides in the parameter plane, one after the other, the face on their left. Directions and errors as for patch.
  FaceId face(SurfacePtr surface, const std::vector<Side>& sides, FaceRole role, const std::string& name);
  /// Face in the plane of its edges, which follow each other around it.
  /// \throws Error(bad_argument) when they do not lie in a plane, with the place
  FaceId plane(const std::vector<EdgeId>& border, FaceRole role, const std::string& name, const std::vector<EdgeId>& hole = {});

  /// The model: one solid of all faces, oriented outwards.
  /// \throws Error(internal) when an edge is not used twice (in opposite directions) or the volume is not positive
  Model closed_solid(const std::string& name);

  Model& model() { return model_; }

 private:
  EdgeUse use_along(const Surface& surface, EdgeId edge, Uv from, Uv to, const std::string& what);
  Model model_;
  ComponentId component_;
};

/// Turns faces of a solid so that neighbours agree and the solid's volume is positive.
/// \throws Error(internal) where an edge has not two uses or faces cannot agree
void orient_outwards(Model& model, SolidId solid);

/// Turns every face, and so what is fluid and what is body. The shape of OpenCASCADE is dropped.
void turn_inside_out(Model& model);

/// Appends `part`, with its ids shifted. Shapes of OpenCASCADE are dropped.
void append(Model& model, const Model& part);

}  // namespace sterna
