// What a model is made of, without its shape: by it two models are seen to be the same thing, one of them deformed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/model/model.h"

namespace sterna::surfmesh {

struct EdgeStructure {
  CornerId start, end;
  bool is_degenerate = false;
  Interval range;  ///< of its parameter
  std::string name;
};

struct UseStructure {
  EdgeId edge;
  bool is_reversed = false;
  std::vector<Uv> samples;  ///< (u, v) at even steps of the edge's parameter, both ends included
};

struct FaceStructure {
  ComponentId component;
  std::string name;
  FaceRole role = FaceRole::skin;
  PatchKind kind = PatchKind::wall;
  bool is_reversed = false;
  ParameterBox box;  ///< of its borders' samples
  std::vector<std::vector<UseStructure>> borders;
};

struct SolidStructure {
  std::string name;
  std::vector<FaceId> faces;
  bool is_closed = false;
};

/// Everything but points in space. Corners are counted, as they have nothing else.
struct ModelStructure {
  std::vector<Component> components;
  std::uint64_t n_corners = 0;
  Column<EdgeId, EdgeStructure> edges;
  Column<FaceId, FaceStructure> faces;
  std::vector<SolidStructure> solids;
};

ModelStructure structure_of(const Model& model);

/// Of a face's extent in (u, v): samples of borders that are farther apart are of faces trimmed in another way. Below, vertices on the border go where it is
/// now, and whether the triangles beside it bear that is looked at (carry_mesh.h).
inline constexpr double k_same_border = 0.05;

/// Empty where both models have the same components, edges, faces and solids, by number, names, kinds and borders, and their borders run alike in (u, v)
/// (k_same_border); else the first thing that differs: "face \"wing\" has 2 borders, not 1".
std::string difference_of(const ModelStructure& reference, const ModelStructure& now);

/// A parameter of `from` where it is in `to`: linear, and exactly itself where both are equal.
double carried(double t, const Interval& from, const Interval& to);
Uv carried(Uv at, const ParameterBox& from, const ParameterBox& to);

}  // namespace sterna::surfmesh
