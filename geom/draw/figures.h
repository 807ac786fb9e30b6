// Converts named quantities to colours, on boundary faces and on cut cells.
#pragma once

#include <string>
#include <vector>

#include "geom/draw/draw_options.h"
#include "geom/draw/scene.h"
#include "geom/mesh/cut.h"

namespace sterna::draw {

/// Meaning of `color`.
enum class Coloring { patch, kind, quality, face_figure, cell_figure };
/// \throws Error(unknown_option) with all names; (bad_argument) for cell quantities without a cut
Coloring coloring_of(const std::string& color, bool has_cut);

/// One number per face or cell, NaN where undefined, and its colour bar; ranges are set by set_range.
struct Figure {
  ColorBar bar;
  std::vector<double> values;
};

/// Returns a quantity of the boundary faces (triangles, then quads). `quality` is the scaled Jacobian of the worst prism if there are layers, else the smallest
/// angle.
/// \throws Error(bad_argument) if no face has this quantity, listing those of the mesh
Figure face_figure(const HybridMesh& mesh, const std::string& name, const RunContext& context);
/// Returns a quantity of the polygons of a cut: quality (CutPolygon::shape), volume, layer.
Figure cell_figure(const MeshCut& cut, const std::string& name);

/// Sets the range of the colours from the values shown.
/// \throws Error(bad_argument) for an empty range, or a range that is not positive with a logarithmic scale
void set_range(ColorBar& bar, std::vector<double> shown, const std::string& name, const DrawOptions& options);

}  // namespace sterna::draw
