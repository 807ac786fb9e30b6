#include "io/surface/surface_cart3d.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "io/input/byte_reader.h"
#include "io/input/file_buffer.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

constexpr std::uint32_t k_first_record_bytes = 8;  // bytes of a record with two counts
constexpr std::size_t k_min_vertex_bytes = 6;      // "0 0 0" and a line end
constexpr std::size_t k_min_triangle_bytes = 6;

/// Triangles of the file, without component numbers.
using Corners = std::vector<std::array<std::uint32_t, 3>>;

void add_triangles(SurfaceBuilder& builder, const Corners& triangles, const std::vector<std::int64_t>& components) {
  builder.reserve_polygons(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    if (!components.empty() && (i == 0 || components[i] != components[i - 1])) builder.set_patch(numbered_patch(components[i]));
    builder.add_triangle(triangles[i][0], triangles[i][1], triangles[i][2]);
  }
}

// ---- text

SurfaceSoup read_text(const FileBuffer& buffer, const RunContext& context) {
  TextScanner scanner(buffer, {.line_bound = true});
  scanner.at_end();
  const std::size_t n_points = scanner.count("the number of vertices", k_min_vertex_bytes);
  const std::size_t n_triangles = scanner.count("the number of triangles", k_min_triangle_bytes);
  const bool has_scalars = !scanner.at_line_end() && scanner.integer("the number of scalars") > 0;  // a .triq file also has scalars
  scanner.set_line_bound(false);
  SurfaceBuilder builder(buffer.source);
  builder.reserve_points(n_points);
  for (std::size_t i = 0; i < n_points; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner.coordinate("a coordinate of a vertex");
    builder.add_point(p);
  }
  Corners triangles(n_triangles);
  for (auto& triangle : triangles)
    for (std::uint32_t& corner : triangle) corner = scanner.index("a corner of a triangle (counted from 1)", 1, n_points);
  std::vector<std::int64_t> components;
  if (!scanner.at_end()) {
    components.resize(n_triangles);
    for (std::int64_t& component : components) component = scanner.integer("the component of a triangle");
  }
  if (!scanner.at_end() && !has_scalars)
    context.warn(buffer.source + ": the data after the components of the last of " + std::to_string(n_triangles) + " triangles are ignored");
  add_triangles(builder, triangles, components);
  SurfaceSoup soup = builder.finish(context);
  soup.has_names = !components.empty();
  return soup;
}

// ---- binary: Fortran records, each enclosed by its size in bytes

class RecordReader {
 public:
  RecordReader(const FileBuffer& buffer, std::endian order) : reader_(buffer, order) {}

  bool at_end() const { return reader_.remaining() == 0; }
  ByteReader& begin(std::uint64_t n, std::string_view what) {
    const std::uint32_t size = reader_.read<std::uint32_t>("the size of a record");
    if (size != 4 * n)
      reader_.fail("found a record of " + std::to_string(size) + " bytes before this byte, expected " + std::to_string(4 * n) + ": " + std::string(what));
    reader_.require(n, 4, what);
    size_ = size;
    return reader_;
  }
  void end() {
    if (reader_.read<std::uint32_t>("the size of the record again") != size_)
      reader_.fail("the record before this byte does not end with its size " + std::to_string(size_));
  }

 private:
  ByteReader reader_;
  std::uint32_t size_ = 0;
};

std::optional<std::endian> byte_order(const FileBuffer& buffer) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    ByteReader reader(buffer, order);
    if (reader.remaining() >= 4 && reader.take<std::uint32_t>() == k_first_record_bytes) return order;
  }
  return std::nullopt;
}

SurfaceSoup read_binary(const FileBuffer& buffer, std::endian order, const RunContext& context) {
  RecordReader records(buffer, order);
  ByteReader& counts = records.begin(2, "the numbers of vertices and triangles");
  const std::int32_t n_points = counts.take<std::int32_t>();
  const std::int32_t n_triangles = counts.take<std::int32_t>();
  if (n_points < 0 || n_triangles < 0)
    counts.fail("found " + std::to_string(n_points) + " vertices and " + std::to_string(n_triangles) + " triangles before this byte");
  records.end();
  SurfaceBuilder builder(buffer.source);
  ByteReader& coordinates = records.begin(3 * static_cast<std::uint64_t>(n_points), "coordinates of the vertices");
  builder.reserve_points(static_cast<std::size_t>(n_points));
  for (std::int32_t i = 0; i < n_points; ++i) {
    if (static_cast<std::size_t>(i) % k_stop_interval == 0) context.check_stop();
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = static_cast<double>(coordinates.take<float>());
    builder.add_point(p);
  }
  records.end();
  ByteReader& corners = records.begin(3 * static_cast<std::uint64_t>(n_triangles), "corners of the triangles");
  Corners triangles(static_cast<std::size_t>(n_triangles));
  for (auto& triangle : triangles) {
    for (std::uint32_t& corner : triangle) {
      const std::int32_t number = corners.take<std::int32_t>();
      if (number < 1 || number > n_points)
        corners.fail("found the corner " + std::to_string(number) + " before this byte, expected 1 to " + std::to_string(n_points));
      corner = static_cast<std::uint32_t>(number - 1);
    }
  }
  records.end();
  std::vector<std::int64_t> components;
  if (!records.at_end()) {
    ByteReader& numbers = records.begin(static_cast<std::uint64_t>(n_triangles), "components of the triangles");
    for (std::int32_t i = 0; i < n_triangles; ++i) components.push_back(numbers.take<std::int32_t>());
    records.end();
  }
  add_triangles(builder, triangles, components);
  SurfaceSoup soup = builder.finish(context);
  soup.has_names = !components.empty();
  soup.single_precision = true;
  return soup;
}

/// Returns the items of a record, enclosed by its sizes.
template <class Put>
void add_record(std::vector<OutputSection>& sections, std::uint64_t n_items, std::size_t item_bytes, const Put& put) {
  std::string size(sizeof(std::int32_t), '\0');
  put_bytes(size.data(), static_cast<std::int32_t>(n_items * item_bytes), std::endian::little);
  sections.push_back(fixed_section(size));
  sections.push_back(items_section(n_items, item_bytes, put));
  sections.push_back(fixed_section(size));
}

}  // namespace

SurfaceSoup read_cart3d(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  if (const auto order = byte_order(buffer)) return read_binary(buffer, *order, context);
  return read_text(buffer, context);
}

void write_cart3d(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  report_numbered_patches(mesh, "Cart3D", context);
  write_file(path,
             {fixed_section(std::to_string(mesh.n_vertices()) + " " + std::to_string(mesh.n_triangles()) + "\n"), point_lines(mesh, ""),
              triangle_lines(mesh, "", 1), patch_number_lines(mesh)},
             context);
}

void write_cart3d_binary(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  constexpr std::uint64_t k_most = std::numeric_limits<std::int32_t>::max() / 12;  // a record has 12 bytes per item
  require_count(std::max(mesh.n_vertices(), mesh.n_triangles()), k_most, "vertices or triangles", "binary Cart3D", path.string());
  require_single_precision(mesh, "binary Cart3D", path.string(), context);
  report_numbered_patches(mesh, "Cart3D", context);
  constexpr std::endian k_order = std::endian::little;
  std::vector<OutputSection> sections;
  add_record(sections, 1, 8, [&mesh](std::uint64_t, char* at) {
    return put_bytes(put_bytes(at, static_cast<std::int32_t>(mesh.n_vertices()), k_order), static_cast<std::int32_t>(mesh.n_triangles()), k_order);
  });
  add_record(sections, mesh.n_vertices(), 12, [&mesh](std::uint64_t i, char* at) {
    for (std::size_t axis = 0; axis < 3; ++axis) at = put_bytes(at, static_cast<float>(mesh.points.raw()[i][axis]), k_order);
    return at;
  });
  add_record(sections, mesh.n_triangles(), 12, [&mesh](std::uint64_t i, char* at) {
    for (const VertexId v : mesh.triangles.raw()[i]) at = put_bytes(at, static_cast<std::int32_t>(v.value()) + 1, k_order);
    return at;
  });
  add_record(sections, mesh.n_triangles(), 4,
             [&mesh](std::uint64_t i, char* at) { return put_bytes(at, static_cast<std::int32_t>(patch_number(mesh, TriangleId(i))), k_order); });
  write_file(path, sections, context);
}

}  // namespace sterna::io
