// Pictures of surfaces and volume meshes, as PNG, without a display: the same bytes for any number of threads, on any machine.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/draw/draw_options.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"

namespace sterna {

/// A place with a number on the picture, and what the legend says of it.
struct DrawMark {
  Point position;
  std::string text;
};

/// The worst place of each gate that warns or FAILs, the first of each kind of violation before them.
std::vector<DrawMark> marks_of(const CheckReport& report);

/// A PNG file's bytes. `name`: of the mesh, for the automatic title; may be empty. Marks are drawn where DrawOptions::places is set.
/// \pre indices in range, finite points
/// \throws Error(bad_argument, unknown_option) for a view, colour, cut, focus or patch that is not there, with those that are
std::string draw_png(const HybridMesh& mesh, const DrawOptions& options, std::string_view name, std::span<const DrawMark> marks, const RunContext& context);
/// Of a surface; it has no cells to cut.
std::string draw_png(const TriMesh& surface, const DrawOptions& options, std::string_view name, std::span<const DrawMark> marks, const RunContext& context);

/// \throws the same errors of the texts that can be judged without a mesh; before the work
void require_draw_options(const DrawOptions& options);

}  // namespace sterna
