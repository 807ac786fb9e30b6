// Figures by name as colours: those of boundary faces and those of cut cells.
#pragma once

#include <string>
#include <vector>

#include "geom/draw/draw_options.h"
#include "geom/draw/scene.h"
#include "geom/mesh/cut.h"

namespace sterna::draw {

/// What `color` stands for.
enum class Coloring { patch, kind, quality, face_figure, cell_figure };
/// \throws Error(unknown_option) with all names; (bad_argument) for figures of cells without a cut
Coloring coloring_of(const std::string& color, bool has_cut);

/// A number per face or cell, NaN where there is none, and its bar; ranges are set by set_range.
struct Figure {
  ColorBar bar;
  std::vector<double> values;
};

/// Of the boundary faces (triangles, then quads). `quality` is the scaled Jacobian of the worst prism where there are layers, else the smallest angle.
/// \throws Error(bad_argument) when no face has such a figure, with those that the mesh has
Figure face_figure(const HybridMesh& mesh, const std::string& name, const RunContext& context);
/// Of the polygons of a cut: quality (CutPolygon::shape), volume, layer.
Figure cell_figure(const MeshCut& cut, const std::string& name);

/// Range of the colours by the values of what is shown.
/// \throws Error(bad_argument) for a range that is empty, or not positive where the scale is logarithmic
void set_range(ColorBar& bar, std::vector<double> shown, const std::string& name, const DrawOptions& options);

}  // namespace sterna::draw
