// Structure of a model without its shape, used to recognise that one model is a deformation of another.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/model/model.h"

namespace sterna::surfmesh {

struct EdgeStructure {
  CornerId start, end;
  bool is_degenerate = false;
  Interval range;  ///< range of its parameter
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
  ParameterBox box;  ///< box of its borders' samples
  std::vector<std::vector<UseStructure>> borders;
};

struct SolidStructure {
  std::string name;
  std::vector<FaceId> faces;
  bool is_closed = false;
};

/// All data except points in space. Corners are only counted, as they have no other data.
struct ModelStructure {
  std::vector<Component> components;
  std::uint64_t n_corners = 0;
  Column<EdgeId, EdgeStructure> edges;
  Column<FaceId, FaceStructure> faces;
  std::vector<SolidStructure> solids;
};

ModelStructure structure_of(const Model& model);

/// Fraction of a face's extent in (u, v). If samples of borders are farther apart, the faces are trimmed differently. If they are closer, vertices on the
/// border move to the new border, and carry_mesh.h checks that the adjacent triangles remain valid.
inline constexpr double k_same_border = 0.05;

/// Returns an empty string if both models have the same components, edges, faces and solids (numbers, names, kinds and borders), and their borders agree in
/// (u, v) (k_same_border); else the first difference: "face \"wing\" has 2 borders, not 1".
std::string difference_of(const ModelStructure& reference, const ModelStructure& now);

/// Maps a parameter of `from` to `to`: linear, and exactly the same value if both ranges are equal.
double carried(double t, const Interval& from, const Interval& to);
Uv carried(Uv at, const ParameterBox& from, const ParameterBox& to);

}  // namespace sterna::surfmesh
