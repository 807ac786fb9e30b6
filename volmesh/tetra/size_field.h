// Target edge lengths of tetrahedra: one graded field for all engines, made from boundary edges that grow into the volume and from sources.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "geom/base/run_context.h"
#include "volmesh/case/size_options.h"
#include "volmesh/case/size_sources.h"
#include "volmesh/tetra/size_field_view.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

/// h(x) = min over boundary vertices and sources of (their size + (growth - 1) * distance). Each cell is therefore at most `growth` times as large as its
/// neighbour nearer to the source. The field is stored as an octree with values at the corners of its leaves, whose edges are at most twice the size at their
/// centres. The size of a boundary vertex is the geometric mean of its edges. A value type; reading is thread-safe.
class SizeField {
 public:
  /// Returns the flat buffer of size_field_view.h, which can be passed to another process.
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(words_)); }
  SizeFieldView view() const { return {bytes().data(), bytes().size()}; }
  /// Returns the target edge length in metres. Outside of a cube around the boundary's box, returns the value at the nearest location of the cube.
  double operator()(const Vec3& p) const { return view_(p.x, p.y, p.z); }

  /// Returns the sum over the leaves of volume divided by the cube of the target edge. The number of tetrahedra is proportional to it.
  double volume_over_cubes() const;

  explicit SizeField(std::vector<double> words) : words_(std::move(words)), view_(view()) {}
  SizeField(const SizeField& other) : SizeField(other.words_) {}
  SizeField& operator=(const SizeField& other) { return *this = SizeField(other); }
  SizeField(SizeField&&) = default;  ///< a vector keeps its memory when it is moved
  SizeField& operator=(SizeField&&) = default;

 private:
  std::vector<double> words_;  ///< stored as doubles for their alignment
  SizeFieldView view_;
};

/// Builds a size field. Parallel, bit-identical for any number of threads; about a microsecond per leaf and thread.
/// \pre the points of the boundary are finite
/// \throws Error(bad_argument) for a source that problem_of() rejects, or for a boundary without triangles; Error(overflow) if the sources require more than
/// 2^24 leaves
SizeField build_size_field(const TetraBoundary& boundary, std::span<const SizeSource> sources, const SizeFieldOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
