// UGRID (AFLR3): stream of counts, coordinates, triangles, quads and their patch numbers; of the volume cells only their number.
#include "io/surface_ugrid.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <system_error>

#include "io/byte_reader.h"
#include "io/file_buffer.h"
#include "io/surface_builder.h"
#include "io/text_scanner.h"

namespace sterna::io {
namespace {

constexpr std::size_t k_stop_interval = 1 << 16;

/// Width of integers and byte order follow from the name: x.lb8.ugrid, x.b8.ugrid, x.lb8l.ugrid, x.b8l.ugrid.
struct Variant {
  bool is_wide = false;
  std::endian order = std::endian::little;
};

Variant variant_of(const std::filesystem::path& path, const std::string& source) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (name.ends_with(".gz")) name.resize(name.size() - 3);
  if (name.ends_with(".lb8.ugrid")) return {false, std::endian::little};
  if (name.ends_with(".b8.ugrid")) return {false, std::endian::big};
  if (name.ends_with(".lb8l.ugrid")) return {true, std::endian::little};
  if (name.ends_with(".b8l.ugrid")) return {true, std::endian::big};
  throw_unsupported(source, "this kind of UGRID file", "use .lb8.ugrid, .b8.ugrid, .lb8l.ugrid or .b8l.ugrid");
}

/// Names of the .mapbc file beside the mesh (FUN3D), wing.mapbc or wing.lb8.mapbc for wing.lb8.ugrid: a count, then lines "id condition name".
/// Empty when there is none; a patch without a name is left out.
std::map<std::int64_t, std::string> read_mapbc(const std::filesystem::path& path, const RunContext& context) {
  std::string stem = path.filename().string();
  std::filesystem::path file;
  std::error_code status;  // of a file that cannot be looked at; load_file says what is wrong with the one that is there
  if (equal_ignoring_case(path.extension().string(), ".gz")) stem.resize(stem.size() - 3);
  for (int n_extensions = 0; n_extensions < 2; ++n_extensions) {  // ".ugrid", then ".lb8"
    stem.resize(stem.rfind('.'));
    const std::filesystem::path candidate = path.parent_path() / (stem + ".mapbc");
    if (file.empty() && std::filesystem::exists(candidate, status)) file = candidate;
  }
  std::map<std::int64_t, std::string> names;
  if (file.empty()) return names;
  const FileBuffer buffer = load_file(file, context);
  TextScanner scanner(buffer);
  const std::size_t n = scanner.count("the number of patches", 4);
  scanner.next_line();
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t id = scanner.integer("a patch number");
    scanner.integer("a boundary condition number");
    const std::string_view name = scanner.rest_of_line();
    if (!name.empty()) names[id] = name;
  }
  return names;
}

}  // namespace

SurfaceSoup read_ugrid(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  const Variant variant = variant_of(path, buffer.source);
  ByteReader reader(buffer, variant.order);
  const std::size_t width = variant.is_wide ? 8 : 4;
  const auto integer = [&]() -> std::int64_t { return variant.is_wide ? reader.take<std::int64_t>() : reader.take<std::int32_t>(); };
  reader.require(7, width, "the seven counts of a UGRID file");
  std::uint64_t counts[7];
  for (std::uint64_t& count : counts) {
    const std::int64_t n = integer();
    if (n < 0) reader.fail("found the count " + std::to_string(n) + ", expected 0 or more", "is the byte order of the file the one its name says?");
    count = static_cast<std::uint64_t>(n);
  }
  const auto [n_points, n_triangles, n_quads] = std::array{counts[0], counts[1], counts[2]};
  SurfaceBuilder builder(buffer.source);
  reader.require(n_points, 3 * sizeof(double), "coordinates of the points");
  builder.reserve_points(n_points);
  for (std::uint64_t i = 0; i < n_points; ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    Vec3 p;
    for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = reader.take<double>();
    if (!is_finite(p)) reader.fail("point " + std::to_string(i + 1) + " is not finite");
    builder.add_point(p);
  }
  const auto read_corners = [&](std::uint64_t n, std::size_t size, std::string_view what) {
    reader.require(n, size * width, what);
    std::vector<std::uint32_t> corners(n * size);
    for (std::uint32_t& corner : corners) {
      const std::int64_t node = integer();
      if (node < 1 || static_cast<std::uint64_t>(node) > n_points)
        reader.fail("found point " + std::to_string(node) + ", expected 1 to " + std::to_string(n_points));
      corner = static_cast<std::uint32_t>(node - 1);
    }
    return corners;
  };
  const std::vector<std::uint32_t> triangles = read_corners(n_triangles, 3, "corners of the triangles");
  const std::vector<std::uint32_t> quads = read_corners(n_quads, 4, "corners of the quads");
  reader.require(n_triangles + n_quads, width, "patch numbers of the faces");
  const std::map<std::int64_t, std::string> names = read_mapbc(path, context);
  const auto set_patch = [&] {
    const std::int64_t id = integer();
    const auto named = names.find(id);
    builder.set_patch(named == names.end() ? numbered_patch(id) : named->second);
  };
  builder.reserve_polygons(n_triangles + n_quads);
  for (std::size_t i = 0; i < n_triangles; ++i) {
    set_patch();
    builder.add_triangle(triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]);
  }
  for (std::size_t i = 0; i < n_quads; ++i) {
    set_patch();
    builder.add_polygon(std::span(quads).subspan(4 * i, 4));
  }
  // Volume cells: only that they are all there, since a file that was cut short is not to be trusted.
  constexpr std::array<std::size_t, 4> k_cell_corners = {4, 5, 6, 8};
  for (std::size_t kind = 0; kind < k_cell_corners.size(); ++kind) {
    const std::uint64_t n = counts[3 + kind];
    reader.require(n, k_cell_corners[kind] * width, "volume cells of " + std::to_string(k_cell_corners[kind]) + " corners");
    reader.skip(n * k_cell_corners[kind] * width);
  }
  SurfaceSoup soup = builder.finish(true);
  soup.has_names = true;
  return soup;
}

}  // namespace sterna::io
