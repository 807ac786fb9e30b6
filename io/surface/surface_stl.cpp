// Text and binary STL are distinguished by the file size first, because binary files whose header begins with "solid" are common.
#include "io/surface/surface_stl.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "io/input/byte_reader.h"
#include "io/input/file_buffer.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/names/name_rules.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_header_bytes = 80;
constexpr std::size_t k_first_facet = 84;
constexpr std::size_t k_facet_bytes = 50;
/// Bytes of a facet in text at least; used to reserve memory.
constexpr std::size_t k_text_facet_bytes = 150;
/// Text has no NUL byte; a binary file has one in its header or in the first few facets.
constexpr std::size_t k_probed_bytes = 1024;

bool looks_like_text(const FileBuffer& buffer) {
  TextScanner scanner(buffer);
  return equal_ignoring_case(scanner.peek().substr(0, 5), "solid") && buffer.text().substr(0, k_probed_bytes).find('\0') == std::string_view::npos;
}

SurfaceSoup read_binary(const FileBuffer& buffer, std::size_t n_facets, const RunContext& context) {
  ByteReader reader(buffer, std::endian::little, k_first_facet);
  reader.require(n_facets, k_facet_bytes, "facets of the binary STL, the number given in its header");
  SurfaceBuilder builder(buffer.source);
  builder.reserve_points(3 * n_facets);
  builder.reserve_polygons(n_facets);
  for (std::size_t i = 0; i < n_facets; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    reader.skip(3 * sizeof(float));  // the normal is ignored, because the order of the corners defines it
    std::uint32_t corners[3];
    for (std::uint32_t& corner : corners) {
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(reader.take<float>());
      corner = builder.add_point(p);
    }
    builder.add_triangle(corners[0], corners[1], corners[2]);
    reader.skip(sizeof(std::uint16_t));  // attribute, usually colours
  }
  SurfaceSoup soup = builder.finish(context);
  soup.single_precision = true;
  return soup;
}

std::string solid_name(std::string_view rest) {
  if (rest.size() >= 2 && rest.front() == '"' && rest.back() == '"') rest = rest.substr(1, rest.size() - 2);
  return std::string(rest);
}

void read_facet(TextScanner& scanner, SurfaceBuilder& builder) {
  scanner.keyword("normal");
  for (int i = 0; i < 3; ++i) scanner.skip_token("a facet's normal");  // the normal may be nan; the order of the corners defines it
  scanner.keyword("outer");
  scanner.keyword("loop");
  std::uint32_t corners[3];
  for (std::uint32_t& corner : corners) {
    scanner.keyword("vertex");
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner.coordinate("a coordinate of a vertex");
    corner = builder.add_point(p);
  }
  scanner.keyword("endloop");
  scanner.keyword("endfacet");
  builder.add_triangle(corners[0], corners[1], corners[2]);
}

SurfaceSoup read_text_solids(const FileBuffer& buffer, const RunContext& context) {
  TextScanner scanner(buffer);
  SurfaceBuilder builder(buffer.source);
  builder.reserve_points(3 * (buffer.bytes.size() / k_text_facet_bytes));
  builder.reserve_polygons(buffer.bytes.size() / k_text_facet_bytes);
  std::size_t n_solids = 0;
  std::size_t n_named = 0;
  bool is_open = false;
  for (std::size_t i = 0; !scanner.at_end(); ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    const std::string_view word = scanner.token("a facet");
    if (equal_ignoring_case(word, "facet")) {
      read_facet(scanner, builder);
    } else if (equal_ignoring_case(word, "solid")) {
      const std::string name = solid_name(scanner.rest_of_line());
      ++n_solids;
      n_named += name.empty() ? 0 : 1;
      builder.set_patch(name.empty() ? "solid_" + std::to_string(n_solids) : name);
      is_open = true;
    } else if (equal_ignoring_case(word, "endsolid")) {
      scanner.rest_of_line();
      is_open = false;
    } else if (equal_ignoring_case(word, "color")) {
      scanner.rest_of_line();
    } else if (n_solids > 0 && !is_open) {
      // Complete solids may be followed by other data (Gmsh models were appended to STL files this way). The solids are read, and the remainder is reported as
      // ignored.
      context.warn(buffer.source + ": line " + std::to_string(scanner.line()) + ": the data after the last \"endsolid\" are not STL and are ignored");
      break;
    } else {
      scanner.fail_expected("\"facet\", \"endsolid\" or \"solid\"");
    }
  }
  if (is_open) context.warn(buffer.source + ": the last solid has no \"endsolid\"; the file may have been cut short");
  SurfaceSoup soup = builder.finish(context);
  soup.has_names = n_named > 0 || n_solids > 1;
  if (!soup.has_names)
    for (std::string& name : soup.patch_names) name.clear();
  return soup;
}

// ---- writing

/// Returns the unit normal by the right-hand rule; zero for a triangle without area.
Vec3 facet_normal(const std::array<Point, 3>& p) {
  const Vec3 n = cross(p[1] - p[0], p[2] - p[0]);
  const double length = norm(n);
  return length > 0.0 && std::isfinite(length) ? n / length : Vec3{};
}

OutputSection binary_facets(const TriMesh& mesh) {
  return items_section(mesh.n_triangles(), k_facet_bytes, [&mesh](std::uint64_t i, char* at) {
    const std::array<Point, 3> p = corners(mesh, TriangleId(i));
    for (const Vec3& v : {facet_normal(p), p[0], p[1], p[2]})
      for (std::size_t axis = 0; axis < 3; ++axis) at = put_bytes(at, static_cast<float>(v[axis]), std::endian::little);
    return put_bytes(at, std::uint16_t{0}, std::endian::little);
  });
}

OutputSection text_facets(const TriMesh& mesh, std::span<const TriangleId> triangles) {
  constexpr std::size_t k_words = 120;  // text of a facet without its numbers
  return items_section(triangles.size(), k_words + 4 * k_max_point_text, [&mesh, triangles](std::uint64_t i, char* at) {
    const std::array<Point, 3> p = corners(mesh, triangles[i]);
    at = put_point_text(put_text(at, "facet normal "), facet_normal(p));
    at = put_text(at, "\n outer loop\n");
    for (const Point& corner : p) {
      at = put_point_text(put_text(at, "  vertex "), corner);
      *at++ = '\n';
    }
    return put_text(at, " endloop\nendfacet\n");
  });
}

}  // namespace

SurfaceSoup read_stl(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const bool is_text = looks_like_text(buffer);
  if (buffer.bytes.size() < k_first_facet) {
    if (is_text) return read_text_solids(buffer, context);
    throw_malformed(buffer.source, "byte 0",
                    "found " + quoted_excerpt(buffer.text()) + " (" + std::to_string(buffer.bytes.size()) +
                        " bytes), expected \"solid\" or the 84 bytes before the facets of a binary STL");
  }
  const std::size_t n_facets = ByteReader(buffer, std::endian::little, k_header_bytes).take<std::uint32_t>();
  const std::size_t binary_bytes = k_first_facet + k_facet_bytes * n_facets;
  if (binary_bytes != buffer.bytes.size() && is_text) return read_text_solids(buffer, context);
  if (binary_bytes < buffer.bytes.size()) {
    if (n_facets == 0)
      throw_malformed(buffer.source, "byte 80",
                      "found 0 as the number of facets and " + std::to_string(buffer.bytes.size() - binary_bytes) +
                          " bytes after it, expected a binary STL with facets or a text that begins with \"solid\"");
    context.warn(buffer.source + ": " + std::to_string(buffer.bytes.size() - binary_bytes) + " bytes after the last of " + std::to_string(n_facets) +
                 " facets are ignored");
  }
  return read_binary(buffer, n_facets, context);
}

void write_stl(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  mesh.patches.size() > 1 ? write_stl_text(mesh, path, context) : write_stl_binary(mesh, path, context);
}

void write_stl_binary(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  require_count(mesh.n_triangles(), std::numeric_limits<std::uint32_t>::max(), "triangles", "binary STL", path.string());
  require_single_precision(mesh, "binary STL", path.string(), context);
  if (mesh.patches.size() > 1)
    context.warn("binary STL has no patches: the " + std::to_string(mesh.patches.size()) + " patches of the surface become one patch");
  std::string header = "binary STL, single precision";  // must not begin with "solid"
  header.resize(k_first_facet, ' ');
  put_bytes(header.data() + k_header_bytes, static_cast<std::uint32_t>(mesh.n_triangles()), std::endian::little);
  write_file(path, {fixed_section(std::move(header)), binary_facets(mesh)}, context);
}

void write_stl_text(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const TrianglesByPatch triangles(mesh);
  const std::vector<std::string> names = names_by_rules(mesh.patches, {.format = "STL", .forbidden = "\""}, context);
  std::vector<OutputSection> sections;
  for (const PatchId patch : triangles.used_patches()) {
    sections.push_back(fixed_section("solid " + names[patch.index()] + "\n"));
    sections.push_back(text_facets(mesh, triangles.of(patch)));
    sections.push_back(fixed_section("endsolid " + names[patch.index()] + "\n"));
  }
  if (sections.empty()) sections.push_back(fixed_section("solid\nendsolid\n"));
  write_file(path, sections, context);
}

}  // namespace sterna::io
