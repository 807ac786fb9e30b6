// Pictures of surfaces and volume meshes as PNG, without a display: the same bytes for any number of threads, on any machine.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/draw/draw_options.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// A numbered location on the picture, and its text in the legend.
struct DrawMark {
  Point position;
  std::string text;
};

/// Returns the first violation of each kind, then the worst location of each gate with status warning or FAIL.
std::vector<DrawMark> marks_of(const CheckReport& report);

/// Returns the bytes of a PNG file. `name`: name of the mesh for the automatic title; may be empty. Marks are drawn if DrawOptions::places is set.
/// \pre indices in range, finite points
/// \throws Error(bad_argument, unknown_option) for a view, colour, cut, focus or patch that does not exist, listing the existing ones
std::string draw_png(const HybridMesh& mesh, const DrawOptions& options, std::string_view name, std::span<const DrawMark> marks, const RunContext& context);
/// Draws a surface; it has no cells to cut.
std::string draw_png(const TriMesh& surface, const DrawOptions& options, std::string_view name, std::span<const DrawMark> marks, const RunContext& context);

/// Checks the options that do not depend on a mesh, before the work starts. \throws the same errors
void require_draw_options(const DrawOptions& options);

}  // namespace sterna
