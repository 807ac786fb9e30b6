// Shared parts of the surface writers: sections with a line or record per vertex or triangle, and triangles by patch.
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
  /// Returns the patches with triangles, in order.
  const std::vector<PatchId>& used_patches() const { return used_; }

 private:
  std::vector<TriangleId> triangles_;
  std::vector<std::size_t> first_;
  std::vector<PatchId> used_;
};

/// Returns a section of n items of at most `max_bytes` each; put(i, at) writes item i at `at` and returns its end.
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
inline constexpr std::size_t k_max_id_text = 11;  // a 32-bit number counted from 1, and a blank
/// Writes "x y z".
char* put_point_text(char* at, const Point& p);
/// Writes "a b c", counted from `base`.
char* put_corners_text(char* at, const TriangleVertices& corners, int base);

/// Returns lines "<prefix>x y z\n".
OutputSection point_lines(const TriMesh& mesh, std::string prefix);
/// Returns lines "<prefix>a b c\n", corners counted from `base`.
OutputSection triangle_lines(const TriMesh& mesh, std::string prefix, int base);
/// Returns lines "<number of the triangle's patch, from 1>\n".
OutputSection patch_number_lines(const TriMesh& mesh);

inline std::int64_t patch_number(const TriMesh& mesh, TriangleId t) { return static_cast<std::int64_t>(mesh.triangle_patch[t].value()) + 1; }

/// Throws Error(overflow) for coordinates beyond the range of a 32-bit float; reports how far rounding moves the vertices.
void require_single_precision(const TriMesh& mesh, std::string_view format, const std::string& path, const RunContext& context);

/// Writes the whole file: writes the sections under a temporary name, syncs and renames the file. The bytes do not depend on the number of threads.
void write_file(const std::filesystem::path& path, const std::vector<OutputSection>& sections, const RunContext& context);

/// Logs the names of the patches by number, for a format that stores only numbers.
void report_numbered_patches(const TriMesh& mesh, std::string_view format, const RunContext& context);

}  // namespace sterna::io
