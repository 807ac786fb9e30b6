// What the writers of surfaces share: sections with a line or a record for each vertex or triangle, and triangles by patch.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/mesh/tri_mesh.h"
#include "io/output/section_output.h"

namespace sterna::io {

/// The triangles of each patch, in mesh order.
class TrianglesByPatch {
 public:
  explicit TrianglesByPatch(const TriMesh& mesh);
  std::span<const TriangleId> of(PatchId patch) const { return {triangles_.data() + first_[patch.index()], first_[patch.index() + 1] - first_[patch.index()]}; }
  /// Patches with triangles, in order.
  const std::vector<PatchId>& used_patches() const { return used_; }

 private:
  std::vector<TriangleId> triangles_;
  std::vector<std::size_t> first_;
  std::vector<PatchId> used_;
};

/// n items of at most `max_bytes` each; put(i, at) writes item i at `at` and returns the place behind it.
template <class Put>
OutputSection items_section(std::uint64_t n, std::size_t max_bytes, const Put& put) {
  return {.n_items = n, .format = [max_bytes, put](std::uint64_t begin, std::uint64_t end, ByteBuffer& out) {
            char* at = out.reserve((end - begin) * max_bytes);
            for (std::uint64_t i = begin; i < end; ++i) at = put(i, at);
            out.end_at(at);
          }};
}

char* put_text(char* at, std::string_view text);
inline constexpr std::size_t k_max_point_text = 3 * (k_max_real_text + 1);
inline constexpr std::size_t k_max_id_text = 11;  // 32 bits counted from 1, and a blank
/// "x y z"
char* put_point_text(char* at, const Point& p);
/// "a b c", counted from `base`
char* put_corners_text(char* at, const TriangleVertices& corners, int base);

/// Lines "<prefix>x y z\n".
OutputSection point_lines(const TriMesh& mesh, std::string prefix);
/// Lines "<prefix>a b c\n", corners counted from `base`.
OutputSection triangle_lines(const TriMesh& mesh, std::string prefix, int base);
/// Lines "<number of the triangle's patch, from 1>\n".
OutputSection patch_number_lines(const TriMesh& mesh);

inline std::int64_t patch_number(const TriMesh& mesh, TriangleId t) { return static_cast<std::int64_t>(mesh.triangle_patch[t].value()) + 1; }

/// Throws Error(overflow) for coordinates that a 32-bit float cannot hold; tells how far rounding moves the vertices.
void require_single_precision(const TriMesh& mesh, std::string_view format, const std::string& path, const RunContext& context);

/// Writes the whole file: temporary name, sections, sync, rename. The same bytes for any number of threads.
void write_file(const std::filesystem::path& path, const std::vector<OutputSection>& sections, const RunContext& context);

/// Tells in the log that a format has only numbers for patches, which names they stand for.
void tell_numbered_patches(const TriMesh& mesh, std::string_view format, const RunContext& context);

}  // namespace sterna::io
