// How long the edges of tetrahedra are to be: boundary edges grown into the volume, sources, one graded field for all engines.
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

/// h(x) = min over boundary vertices and sources of (their size + (growth - 1) * distance), so that each cell is at most `growth` times its neighbour nearer to
/// the source; kept as an octree with values at the corners of its leaves, whose edges are at most twice the size at their centres. The size of a boundary
/// vertex is the geometric mean of its edges. A value; reading it is thread-safe.
class SizeField {
 public:
  /// The flat buffer of size_field_view.h, for another process.
  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(words_)); }
  SizeFieldView view() const { return {bytes().data(), bytes().size()}; }
  /// Wanted edge length in metres; outside of the boundary's box that of the nearest place of a cube around it.
  double operator()(const Vec3& p) const { return view_(p.x, p.y, p.z); }

  /// Volume over the cube of the wanted edge, summed over the leaves: how many tetrahedra fit is in proportion to it.
  double volume_over_cubes() const;

  explicit SizeField(std::vector<double> words) : words_(std::move(words)), view_(view()) {}
  SizeField(const SizeField& other) : SizeField(other.words_) {}
  SizeField& operator=(const SizeField& other) { return *this = SizeField(other); }
  SizeField(SizeField&&) = default;  ///< a vector keeps its memory when it is moved
  SizeField& operator=(SizeField&&) = default;

 private:
  std::vector<double> words_;  ///< doubles for their alignment
  SizeFieldView view_;
};

/// Parallel, same bytes for any number of threads; about a microsecond per leaf and thread.
/// \pre points of the boundary finite.
/// \throws Error(bad_argument) for a source that problem_of() objects to, for a boundary without triangles; Error(overflow) when the sources ask for more than
/// 2^24 leaves.
SizeField build_size_field(const TetraBoundary& boundary, std::span<const SizeSource> sources, const SizeFieldOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
