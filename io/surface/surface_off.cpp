// Reads OFF as text, with the header variants of Geomview, and the two variants of OFF BINARY in use.
#include "io/surface/surface_off.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "io/input/byte_reader.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/mesh/surface_polygon.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

/// Shortest line of a vertex ("0 0 0" and a line end) and of a face ("0" and a line end).
constexpr std::size_t k_min_off_vertex_bytes = 6;
constexpr std::size_t k_min_face_bytes = 2;

struct OffHeader {
  bool has_weight = false;  ///< 4OFF: a fourth coordinate divides the other three
  bool has_extras = false;  ///< NOFF, COFF, STOFF: normals, colours, texture coordinates follow the position
  bool is_binary = false;
};

/// Parses the letters before "OFF" in their order: ST, C, N, 4, n.
OffHeader parse_header(TextScanner& scanner) {
  OffHeader header;
  const std::string_view first = scanner.peek();
  if (!first.empty() && (first.front() == '+' || (first.front() >= '0' && first.front() <= '9')) && first.find("OFF") == std::string_view::npos)
    return header;  // the keyword is optional: without it the header is plain
  const std::string_view word = scanner.token("\"OFF\"");
  std::string_view rest = word;
  const auto take = [&rest](std::string_view prefix) {
    const bool found = rest.starts_with(prefix);
    if (found) rest.remove_prefix(prefix.size());
    return found;
  };
  for (const std::string_view prefix : {"ST", "C", "N"})
    if (take(prefix)) header.has_extras = true;
  header.has_weight = take("4");
  if (rest == "nOFF") throw_unsupported(scanner.source(), quoted_excerpt(word) + " (points of any dimension) is not read", "write a plain OFF file");
  if (rest != "OFF") scanner.fail_expected("\"OFF\" (or COFF, NOFF, STOFF, 4OFF)");
  if (!scanner.at_line_end() && scanner.peek() == "BINARY") {
    scanner.skip_token("BINARY");
    header.is_binary = true;
  }
  return header;
}

/// Returns true if n extra numbers after a vertex can be colours and normals. Other counts mean that a line does not hold one vertex.
bool is_count_of_extras(std::size_t n) { return n == 0 || n == 3 || n == 4 || n == 6 || n == 7; }

Vec3 parse_vertex(TextScanner& scanner, const OffHeader& header) {
  Vec3 p;
  for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner.coordinate("a coordinate of a vertex");
  if (header.has_weight) p = p / scanner.coordinate("the fourth coordinate of a vertex");
  std::size_t n_extras = 0;
  for (; !scanner.at_line_end(); ++n_extras) scanner.real("a colour or a component of a normal");
  if (!header.has_extras && !is_count_of_extras(n_extras))
    scanner.fail("found " + std::to_string(n_extras) + " more numbers after a vertex, expected one vertex per line, perhaps with a colour or normal");
  return p;
}

SurfaceSoup read_text(const FileBuffer& buffer, TextScanner& scanner, const OffHeader& header, const RunContext& context) {
  const std::size_t n_points = scanner.count("the number of vertices", k_min_off_vertex_bytes);
  const std::size_t n_faces = scanner.count("the number of faces", k_min_face_bytes);
  scanner.rest_of_line();  // skip the number of edges, which is often wrong, sometimes missing, and never needed
  SurfaceBuilder builder(buffer.source);
  builder.reserve_points(n_points);
  builder.reserve_polygons(n_faces);
  for (std::size_t i = 0; i < n_points; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    builder.add_point(parse_vertex(scanner, header));
  }
  std::vector<std::uint32_t> corners;
  std::size_t n_not_faces = 0;
  for (std::size_t i = 0; i < n_faces; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    const std::size_t n_corners = scanner.count("the number of corners of a face", 2);
    if (n_corners > k_max_polygon_corners)
      scanner.fail("found a face of " + std::to_string(n_corners) + " corners, expected at most " + std::to_string(k_max_polygon_corners));
    corners.clear();
    for (std::size_t k = 0; k < n_corners; ++k) corners.push_back(scanner.index("a corner of a face", 0, n_points));
    scanner.next_line();  // a colour may follow
    if (n_corners < 3) ++n_not_faces;
    else builder.add_polygon(corners);
  }
  if (!scanner.at_end()) scanner.fail("found more lines after the last of " + std::to_string(n_faces) + " faces, expected the end of the file");
  if (n_not_faces > 0) context.warn(buffer.source + ": " + std::to_string(n_not_faces) + " faces of fewer than three corners (points and lines) are left out");
  return builder.finish(context);
}

/// Variants of OFF BINARY. Geomview's files are big-endian and have a count of colour components after each face; pmp's files are little-endian and do not.
struct BinaryVariant {
  std::endian order;
  bool has_colours;
};
constexpr BinaryVariant k_off_variants[] = {{std::endian::little, false}, {std::endian::big, true}, {std::endian::little, true}, {std::endian::big, false}};

/// Reads the whole file in one of the variants. \throws Error if it is not that variant, or damaged.
SurfaceSoup read_binary(const FileBuffer& buffer, std::size_t offset, const BinaryVariant& variant, const RunContext& context) {
  ByteReader reader(buffer, variant.order, offset);
  const auto read_count = [&](std::string_view what) {
    const auto n = reader.read<std::int32_t>(what);
    if (n < 0) reader.fail("found " + std::to_string(n) + " as " + std::string(what) + ", expected at least 0");
    return static_cast<std::size_t>(n);
  };
  const std::size_t n_points = read_count("the number of vertices");
  const std::size_t n_faces = read_count("the number of faces");
  read_count("the number of edges");
  reader.require(n_points, 3 * sizeof(float), "the vertices");
  SurfaceBuilder builder(buffer.source);
  builder.reserve_points(n_points);
  for (std::size_t i = 0; i < n_points; ++i) {
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(reader.take<float>());
    builder.add_point(p);
  }
  reader.require(n_faces, sizeof(std::int32_t), "the faces");
  builder.reserve_polygons(n_faces);
  std::vector<std::uint32_t> corners;
  for (std::size_t i = 0; i < n_faces; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    const std::size_t n_corners = read_count("the number of corners of a face");
    if (n_corners < 3 || n_corners > k_max_polygon_corners)
      reader.fail("found a face of " + std::to_string(n_corners) + " corners, expected 3 to " + std::to_string(k_max_polygon_corners));
    reader.require(n_corners, sizeof(std::int32_t), "the corners of a face");
    corners.clear();
    for (std::size_t k = 0; k < n_corners; ++k) {
      const auto index = reader.take<std::int32_t>();
      if (index < 0 || static_cast<std::size_t>(index) >= n_points)
        reader.fail("a corner of face " + std::to_string(i) + " ends here: found " + std::to_string(index) + ", expected 0 to " +
                    std::to_string(static_cast<std::int64_t>(n_points) - 1));
      corners.push_back(static_cast<std::uint32_t>(index));
    }
    builder.add_polygon(corners);
    if (variant.has_colours) {
      const std::size_t n_components = read_count("the number of colour components");
      reader.require(n_components, sizeof(float), "the colour of a face");
      reader.skip(n_components * sizeof(float));
    }
  }
  if (reader.remaining() > 0) reader.fail("found " + std::to_string(reader.remaining()) + " bytes after the last face, expected the end of the file");
  SurfaceSoup soup = builder.finish(context);
  soup.single_precision = true;
  return soup;
}

SurfaceSoup read_any_binary(const FileBuffer& buffer, std::size_t offset, const RunContext& context) {
  std::optional<Error> error;  // error for the variant that is most common in practice
  for (const BinaryVariant& variant : k_off_variants) {
    try {
      return read_binary(buffer, offset, variant, context);
    } catch (const Error& variant_error) {
      if (variant_error.code() != ErrorCode::file_malformed) throw;
      if (!error) error = variant_error;
    }
  }
  throw *error;
}

}  // namespace

SurfaceSoup read_off(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  TextScanner scanner(buffer, {.comment = '#'});
  const OffHeader header = parse_header(scanner);
  if (!header.is_binary) return read_text(buffer, scanner, header, context);
  if (header.has_weight || header.has_extras)
    throw_unsupported(buffer.source, "OFF BINARY with normals, colours or weights of vertices is not read", "write it as text");
  scanner.next_line();
  return read_any_binary(buffer, scanner.offset(), context);
}

void write_off(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  write_file(path,
             {fixed_section("OFF\n" + std::to_string(mesh.n_vertices()) + " " + std::to_string(mesh.n_triangles()) + " 0\n"), point_lines(mesh, ""),
              triangle_lines(mesh, "3 ", 0)},
             context);
}

}  // namespace sterna::io
