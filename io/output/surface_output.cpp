#include "io/output/surface_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>

#include "geom/base/error.h"

namespace sterna::io {

TrianglesByPatch::TrianglesByPatch(const TriMesh& mesh) : triangles_(mesh.n_triangles()), first_(mesh.patches.size() + 1, 0) {
  for (const PatchId patch : mesh.triangle_patch) ++first_[patch.index() + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
  for (const TriangleId t : mesh.triangles.ids()) triangles_[next[mesh.triangle_patch[t].index()]++] = t;
  for (const PatchId patch : mesh.patches.ids())
    if (!of(patch).empty()) used_.push_back(patch);
}

char* put_text(char* at, std::string_view text) {
  std::memcpy(at, text.data(), text.size());
  return at + text.size();
}

char* put_point_text(char* at, const Point& p) {
  at = put_real_text(at, p.x);
  *at++ = ' ';
  at = put_real_text(at, p.y);
  *at++ = ' ';
  return put_real_text(at, p.z);
}

char* put_corners_text(char* at, const TriangleVertices& corners, int base) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (k > 0) *at++ = ' ';
    at = put_integer_text(at, static_cast<std::int64_t>(corners[k].value()) + base);
  }
  return at;
}

OutputSection point_lines(const TriMesh& mesh, std::string prefix) {
  const std::size_t max_bytes = prefix.size() + k_max_point_text + 1;
  return items_section(mesh.n_vertices(), max_bytes, [&mesh, prefix = std::move(prefix)](std::uint64_t i, char* at) {
    at = put_point_text(put_text(at, prefix), mesh.points.raw()[i]);
    *at++ = '\n';
    return at;
  });
}

OutputSection triangle_lines(const TriMesh& mesh, std::string prefix, int base) {
  const std::size_t max_bytes = prefix.size() + 3 * k_max_id_text + 1;
  return items_section(mesh.n_triangles(), max_bytes, [&mesh, prefix = std::move(prefix), base](std::uint64_t i, char* at) {
    at = put_corners_text(put_text(at, prefix), mesh.triangles.raw()[i], base);
    *at++ = '\n';
    return at;
  });
}

OutputSection patch_number_lines(const TriMesh& mesh) {
  return items_section(mesh.n_triangles(), k_max_id_text + 1, [&mesh](std::uint64_t i, char* at) {
    at = put_integer_text(at, patch_number(mesh, TriangleId(i)));
    *at++ = '\n';
    return at;
  });
}

void require_single_precision(const TriMesh& mesh, std::string_view format, const std::string& path, const RunContext& context) {
  constexpr double k_limit = static_cast<double>(std::numeric_limits<float>::max());
  for (const Point& p : mesh.points)
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (std::abs(p[axis]) > k_limit)
        throw Error({.code = ErrorCode::overflow,
                     .attempted = "writing " + path,
                     .problem = "a coordinate of " + std::to_string(p[axis]) + ", but the 32-bit floats of " + std::string(format) + " cannot exceed 3.4e38"});
  double moved = 0.0;
  for (const Point& p : mesh.points)
    moved = std::max(moved, distance(p, Point{static_cast<double>(static_cast<float>(p.x)), static_cast<double>(static_cast<float>(p.y)),
                                              static_cast<double>(static_cast<float>(p.z))}));
  if (moved > 0.0) {
    std::array<char, 32> number;
    std::snprintf(number.data(), number.size(), "%.2g", moved);
    context.info(path + ": " + std::string(format) + " is single precision: vertices move by up to " + number.data() + " m");
  }
}

void write_file(const std::filesystem::path& path, const std::vector<OutputSection>& sections, const RunContext& context) {
  AtomicFile file(path);
  write_sections(file, sections, context);
  file.commit();
}

void report_numbered_patches(const TriMesh& mesh, std::string_view format, const RunContext& context) {
  std::string text;
  for (const PatchId patch : mesh.patches.ids())
    if (const std::string number = std::to_string(patch.value() + 1); mesh.patches[patch].name != "patch_" + number)
      text += (text.empty() ? "" : ", ") + number + " = \"" + mesh.patches[patch].name + "\"";
  if (!text.empty()) context.warn(std::string(format) + " stores patch numbers instead of names: " + text);
}

}  // namespace sterna::io
