// Builds models face by face over shared edges, and verifies that they are closed. Used for components, tunnels and boxes.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "geom/model/frame.h"
#include "geom/model/model.h"

namespace sterna {

/// Returns the curve of a surface's NURBS form along one parameter line: u = at (its parameter is v) or v = at (u).
/// \pre polynomial or rational form, `at` in the domain
CurvePtr line_of_constant_u(const NurbsSurfaceForm& form, double at);
CurvePtr line_of_constant_v(const NurbsSurfaceForm& form, double at);

/// Returns the exact curve S(from + t (to - from)), t in [0, 1]: a spline whose degree is the sum of both degrees.
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
  /// All added faces belong to this component.
  explicit ModelBuilder(Component component);

  CornerId corner(const Point& point);
  EdgeId edge(CurvePtr curve, Interval range, CornerId start, CornerId end, std::string name = {});
  EdgeId straight_edge(CornerId start, CornerId end, std::string name = {});
  /// Cuts a curve into edges. `at` ascends from the start to the end of the edges; corners between the first and the last are created.
  SplitCurve split_curve(CurvePtr curve, std::vector<double> at, CornerId first, CornerId last, const std::string& name = {});
  /// Creates a degenerate edge at a pole of a surface.
  EdgeId pole(CornerId at);

  /// Creates a face on the part `box` of a surface; edges in the order v = from, u = to, v = to, u = from. The directions of the edges are determined from
  /// their points. The edges must follow the sides with proportional parameters (poles: any).
  /// \throws Error(internal) naming the side that an edge does not follow
  FaceId patch(SurfacePtr surface, const ParameterBox& box, const std::array<EdgeId, 4>& sides, FaceRole role, const std::string& name);
  /// One side of a face: an edge that follows the straight line between two points of the parameter plane.
  struct Side {
    EdgeId edge;
    Uv from, to;
  };
  /// Creates a face with straight sides in the parameter plane, in sequence, the face on their left. Directions and errors as for patch.
  FaceId face(SurfacePtr surface, const std::vector<Side>& sides, FaceRole role, const std::string& name);
  /// Creates a face in the plane of its edges, which form its border in sequence.
  /// \throws Error(bad_argument) if the edges are not in one plane, with the location
  FaceId plane(const std::vector<EdgeId>& border, FaceRole role, const std::string& name, const std::vector<EdgeId>& hole = {});

  /// Returns the model: one solid of all faces, oriented outwards.
  /// \throws Error(internal) if an edge is not used twice (in opposite directions) or the volume is not positive
  Model closed_solid(const std::string& name);

  Model& model() { return model_; }

 private:
  EdgeUse use_along(const Surface& surface, EdgeId edge, Uv from, Uv to, const std::string& what);
  Model model_;
  ComponentId component_;
};

/// Flips faces of a solid so that neighbours are consistently oriented and the solid's volume is positive.
/// \throws Error(internal) if an edge does not have two uses or the faces cannot be oriented consistently
void orient_outwards(Model& model, SolidId solid);

/// Reverses every face, which exchanges fluid and body. The OpenCASCADE shape is dropped.
void turn_inside_out(Model& model);

/// Appends `part` with shifted ids. OpenCASCADE shapes are dropped.
void append(Model& model, const Model& part);

}  // namespace sterna
