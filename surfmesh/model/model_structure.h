// Structure of a model without its shape. It is used to recognise that one model is a deformation of another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/model/model.h"

namespace sterna::surfmesh {

struct EdgeStructure {
  CornerId start, end;
  bool is_degenerate = false;
  Interval range;  ///< range of the edge's parameter
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
  ParameterBox box;  ///< bounding box of the samples of its borders
  std::vector<std::vector<UseStructure>> borders;
};

struct SolidStructure {
  std::string name;
  std::vector<FaceId> faces;
  bool is_closed = false;
};

/// All data of a model except points in space. Corners are only counted, because they have no other data.
struct ModelStructure {
  std::vector<Component> components;
  std::uint64_t n_corners = 0;
  Column<EdgeId, EdgeStructure> edges;
  Column<FaceId, FaceStructure> faces;
  std::vector<SolidStructure> solids;
};

ModelStructure structure_of(const Model& model);

/// Limit for the distance of border samples, as a fraction of a face's extent in (u, v). If samples are farther apart, the faces are trimmed differently. If
/// they are closer, vertices on the border move to the new border, and carry_mesh.h checks that the adjacent triangles remain valid.
inline constexpr double k_same_border = 0.05;

/// Returns an empty string if both models have the same components, edges, faces and solids (numbers, names, kinds and borders), and if their borders agree in
/// (u, v) within k_same_border. Otherwise returns the first difference, such as "face \"wing\" has 2 borders, not 1".
std::string difference_of(const ModelStructure& reference, const ModelStructure& now);

/// Maps a parameter from the range `from` to the range `to`. The map is linear; if both ranges are equal, the parameter stays exactly the same.
double carried(double t, const Interval& from, const Interval& to);
Uv carried(Uv at, const ParameterBox& from, const ParameterBox& to);

}  // namespace sterna::surfmesh
