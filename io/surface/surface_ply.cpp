// A PLY file has a header that declares elements and their properties, then the elements as text or as bytes of either order.
#include "io/surface/surface_ply.h"

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/input/byte_reader.h"
#include "io/input/left_out.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/mesh/surface_polygon.h"
#include "io/names/name_rules.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyEncoding { text, little_endian, big_endian };

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8: return 1;
    case PlyType::int16:
    case PlyType::uint16: return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32: return 4;
    case PlyType::float64: return 8;
  }
  return 8;
}
bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

struct PlyTypeName {
  std::string_view name;
  PlyType type;
};
constexpr std::array<PlyTypeName, 16> k_type_names = {{{"char", PlyType::int8},
                                                       {"int8", PlyType::int8},
                                                       {"uchar", PlyType::uint8},
                                                       {"uint8", PlyType::uint8},
                                                       {"short", PlyType::int16},
                                                       {"int16", PlyType::int16},
                                                       {"ushort", PlyType::uint16},
                                                       {"uint16", PlyType::uint16},
                                                       {"int", PlyType::int32},
                                                       {"int32", PlyType::int32},
                                                       {"uint", PlyType::uint32},
                                                       {"uint32", PlyType::uint32},
                                                       {"float", PlyType::float32},
                                                       {"float32", PlyType::float32},
                                                       {"double", PlyType::float64},
                                                       {"float64", PlyType::float64}}};

/// Face properties that number patches, in order of preference.
constexpr std::array<std::string_view, 7> k_patch_properties = {"patch", "patch_id", "marker", "boundary", "region", "label", "group"};

/// Meaning of a property for the reader.
enum class Role { skipped, x, y, z, corners, patch };

struct Property {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;
  Role role = Role::skipped;
};

struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
  bool is_vertex() const { return name == "vertex"; }
  bool is_face() const { return name == "face"; }
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::text;
  std::vector<Element> elements;
  std::map<std::int64_t, std::string> patch_names;  ///< from comments "patch <number> <name>"
};

// ---- header

PlyType parse_type(TextScanner& scanner) {
  const std::string_view word = scanner.token("the type of a property");
  for (const PlyTypeName& candidate : k_type_names)
    if (candidate.name == word) return candidate.type;
  scanner.fail_expected("a type of PLY such as float, double, uchar or int");
}

Property parse_property(TextScanner& scanner) {
  Property property;
  property.is_list = scanner.peek() == "list";
  if (property.is_list) {
    scanner.skip_token("list");
    property.count_type = parse_type(scanner);
    if (!is_integer(property.count_type)) scanner.fail_expected("an integer type for the length of a list");
  }
  property.type = parse_type(scanner);
  property.name = scanner.token("the name of a property");
  return property;
}

PlyEncoding parse_format(TextScanner& scanner) {
  const std::string_view word = scanner.token("the kind of PLY");
  PlyEncoding encoding = PlyEncoding::text;
  if (word == "binary_little_endian") encoding = PlyEncoding::little_endian;
  else if (word == "binary_big_endian") encoding = PlyEncoding::big_endian;
  else if (word != "ascii") scanner.fail_expected("ascii, binary_little_endian or binary_big_endian");
  if (scanner.token("the version of PLY") != "1.0") scanner.fail_expected("version 1.0");
  return encoding;
}

void assign_roles(TextScanner& scanner, Element& element) {
  const auto find = [&element](std::string_view name, bool is_list) -> Property* {
    for (Property& property : element.properties)
      if (property.name == name && property.is_list == is_list) return &property;
    return nullptr;
  };
  if (element.is_vertex()) {
    constexpr std::array<std::pair<std::string_view, Role>, 3> k_axes = {{{"x", Role::x}, {"y", Role::y}, {"z", Role::z}}};
    for (const auto& [name, role] : k_axes) {
      Property* const property = find(name, false);
      if (!property) scanner.fail("element vertex has no property \"" + std::string(name) + "\"");
      property->role = role;
    }
  } else if (element.is_face()) {
    Property* corners = find("vertex_indices", true);
    if (!corners) corners = find("vertex_index", true);
    if (!corners) scanner.fail("element face has no list \"vertex_indices\" (or \"vertex_index\")");
    if (!is_integer(corners->type)) scanner.fail("the list \"" + corners->name + "\" of element face holds floating-point numbers, expected integers");
    corners->role = Role::corners;
    for (const std::string_view name : k_patch_properties) {
      Property* const patch = find(name, false);
      if (!patch || !is_integer(patch->type)) continue;
      patch->role = Role::patch;
      break;
    }
  }
}

/// Returns the minimum number of bytes of an element.
std::size_t min_bytes(const Element& element, PlyEncoding encoding) {
  std::size_t n = 0;
  for (const Property& property : element.properties)
    n += encoding == PlyEncoding::text ? 2 : property.is_list ? size_of(property.count_type) : size_of(property.type);
  return n;
}

/// Parses a comment of sterna's writer that names a patch: "patch 2 left wing".
void parse_comment(TextScanner& scanner, PlyHeader& header) {
  if (scanner.peek() != "patch") return;
  scanner.skip_token("patch");
  const std::string_view number = scanner.peek();
  std::int64_t patch = 0;
  const auto [end, failure] = std::from_chars(number.data(), number.data() + number.size(), patch);
  if (number.empty() || failure != std::errc{} || end != number.data() + number.size()) return;
  scanner.skip_token("the number of a patch");
  const std::size_t begin = scanner.offset();
  if (const std::string_view name = scanner.rest_of_line(); !name.empty()) header.patch_names[patch] = name;
  scanner.seek(begin);
}

PlyHeader parse_ply_header(TextScanner& scanner) {
  PlyHeader header;
  bool has_format = false;
  if (scanner.token("\"ply\"") != "ply") scanner.fail_expected("\"ply\"");
  for (;;) {
    scanner.next_line();
    if (scanner.at_line_end() && scanner.remaining() > 0) continue;
    const std::string_view word = scanner.token("a line of the header, or end_header");
    if (word == "end_header") break;
    if (word == "comment" || word == "obj_info") {
      parse_comment(scanner, header);
      continue;
    }
    if (word == "format") {
      header.encoding = parse_format(scanner);
      has_format = true;
    } else if (word == "element") {
      Element element;
      element.name = scanner.token("the name of an element");
      for (const Element& other : header.elements)
        if (other.name == element.name) scanner.fail("element " + quoted_excerpt(element.name) + " is declared twice");
      element.count = scanner.count("the number of elements", 1);
      header.elements.push_back(std::move(element));
    } else if (word == "property") {
      if (header.elements.empty()) scanner.fail_expected("an element before its properties");
      header.elements.back().properties.push_back(parse_property(scanner));
    } else {
      scanner.fail_expected("format, element, property, comment or end_header");
    }
    if (!scanner.at_line_end()) scanner.fail_expected("the end of the line");
  }
  if (!has_format) scanner.fail("the header has no line \"format\"");
  scanner.next_line();
  for (Element& element : header.elements) {
    assign_roles(scanner, element);
    const std::size_t n_bytes = min_bytes(element, header.encoding);
    if (n_bytes > 0 && element.count > (scanner.remaining() + 1) / n_bytes)
      scanner.fail("the header declares " + std::to_string(element.count) + " elements \"" + element.name + "\", but only " +
                       std::to_string(scanner.remaining()) + " bytes follow it",
                   "the file may have been cut short: copy or write it again");
  }
  return header;
}

// ---- the two sources of values; both offer coordinate, integer, skip, fail

class TextValues {
 public:
  explicit TextValues(TextScanner& scanner) : scanner_(scanner) { scanner_.set_line_bound(false); }
  double coordinate(PlyType, std::string_view expected) { return scanner_.coordinate(expected); }
  std::int64_t integer(PlyType, std::string_view expected) { return scanner_.integer(expected); }
  void skip(PlyType, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) scanner_.skip_token("the value of a property");
  }
  [[noreturn]] void fail(std::string_view problem) { scanner_.fail(problem); }
  void expect_end(std::size_t n_last) {
    if (!scanner_.at_end()) scanner_.fail("found more after the last of " + std::to_string(n_last) + " declared elements, expected the end of the file");
  }

 private:
  TextScanner& scanner_;
};

class ByteValues {
 public:
  explicit ByteValues(ByteReader reader) : reader_(std::move(reader)) {}
  double coordinate(PlyType type, std::string_view expected) {
    return type == PlyType::float32   ? static_cast<double>(reader_.read<float>(expected))
           : type == PlyType::float64 ? reader_.read<double>(expected)
                                      : static_cast<double>(integer(type, expected));
  }
  std::int64_t integer(PlyType type, std::string_view expected) {
    switch (type) {
      case PlyType::int8: return reader_.read<std::int8_t>(expected);
      case PlyType::uint8: return reader_.read<std::uint8_t>(expected);
      case PlyType::int16: return reader_.read<std::int16_t>(expected);
      case PlyType::uint16: return reader_.read<std::uint16_t>(expected);
      case PlyType::int32: return reader_.read<std::int32_t>(expected);
      case PlyType::uint32: return reader_.read<std::uint32_t>(expected);
      case PlyType::float32:
      case PlyType::float64: break;
    }
    reader_.fail("found a floating-point type, expected " + std::string(expected));
  }
  void skip(PlyType type, std::size_t n) {
    reader_.require(n, size_of(type), "values of a property");
    reader_.skip(n * size_of(type));
  }
  [[noreturn]] void fail(std::string_view problem) { reader_.fail(problem); }
  void expect_end(std::size_t n_last) {
    // Some writers add a line end after the bytes.
    constexpr std::size_t k_line_end_bytes = 2;
    if (reader_.remaining() > k_line_end_bytes)
      reader_.fail("found " + std::to_string(reader_.remaining()) + " bytes after the last of " + std::to_string(n_last) +
                   " declared elements, expected the end of the file");
  }

 private:
  ByteReader reader_;
};

// ---- elements

/// Reads a list's length. It is not limited here: reading the values fails if the file does not contain them.
template <class Values>
std::size_t read_length(Values& values, const Property& property) {
  const std::int64_t n = values.integer(property.count_type, "the length of a list");
  if (n < 0) values.fail("found " + std::to_string(n) + " as the length of list \"" + property.name + "\", expected at least 0");
  return static_cast<std::size_t>(n);
}

template <class Values>
void read_corners(Values& values, const Property& property, std::size_t n_points, std::vector<std::uint32_t>& corners) {
  const std::size_t n = read_length(values, property);
  if (n > k_max_polygon_corners) values.fail("found a face of " + std::to_string(n) + " corners, expected at most " + std::to_string(k_max_polygon_corners));
  corners.clear();
  for (std::size_t i = 0; i < n; ++i) {
    const std::int64_t index = values.integer(property.type, "a corner of a face");
    if (index < 0 || static_cast<std::uint64_t>(index) >= n_points)
      values.fail("found " + std::to_string(index) + " as a corner of a face, but there are " + std::to_string(n_points) + " vertices (counted from 0)");
    corners.push_back(static_cast<std::uint32_t>(index));
  }
}

template <class Values>
void read_elements(const PlyHeader& header, Values values, const std::string& source, SurfaceBuilder& builder, const RunContext& context) {
  std::size_t n_points = 0;
  for (const Element& element : header.elements)
    if (element.is_vertex()) n_points = element.count;
  std::vector<std::uint32_t> corners;
  std::size_t n_not_faces = 0;
  for (const Element& element : header.elements) {
    if (element.properties.empty()) continue;
    if (element.is_vertex()) builder.reserve_points(element.count);
    if (element.is_face()) builder.reserve_polygons(element.count);
    for (std::size_t i = 0; i < element.count; ++i) {
      if (i % k_stop_interval == 0) context.check_stop();
      Vec3 p;
      std::optional<std::int64_t> patch;
      for (const Property& property : element.properties) {
        switch (property.role) {
          case Role::x: p.x = values.coordinate(property.type, "the x coordinate of a vertex"); break;
          case Role::y: p.y = values.coordinate(property.type, "the y coordinate of a vertex"); break;
          case Role::z: p.z = values.coordinate(property.type, "the z coordinate of a vertex"); break;
          case Role::corners: read_corners(values, property, n_points, corners); break;
          case Role::patch: patch = values.integer(property.type, "the patch of a face"); break;
          case Role::skipped: values.skip(property.type, property.is_list ? read_length(values, property) : 1); break;
        }
      }
      if (element.is_vertex()) builder.add_point(p);
      if (!element.is_face()) continue;
      if (patch) {
        const auto name = header.patch_names.find(*patch);
        builder.set_patch(name == header.patch_names.end() ? numbered_patch(*patch) : name->second);
      }
      if (corners.size() < 3) ++n_not_faces;
      else builder.add_polygon(corners);
    }
  }
  values.expect_end(header.elements.empty() ? 0 : header.elements.back().count);
  if (n_not_faces > 0) context.warn(source + ": " + std::to_string(n_not_faces) + " faces of fewer than three corners are left out");
}

}  // namespace

SurfaceSoup read_ply(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  TextScanner scanner(buffer, {.line_bound = true});
  const PlyHeader header = parse_ply_header(scanner);
  SurfaceBuilder builder(buffer.source);
  if (header.encoding == PlyEncoding::text) {
    read_elements(header, TextValues(scanner), buffer.source, builder, context);
  } else {
    const std::endian order = header.encoding == PlyEncoding::little_endian ? std::endian::little : std::endian::big;
    read_elements(header, ByteValues(ByteReader(buffer, order, scanner.offset())), buffer.source, builder, context);
  }

  bool has_faces = false, has_patches = false, has_strips = false, is_single = false;
  for (const Element& element : header.elements) {
    has_faces |= element.is_face();
    has_strips |= element.name == "tristrips";
    for (const Property& property : element.properties) {
      has_patches |= property.role == Role::patch;
      is_single |= property.role == Role::x && property.type == PlyType::float32;
    }
  }
  if (has_strips && !has_faces) throw_unsupported(buffer.source, "triangle strips are not read", "write the PLY file with plain faces");
  LeftOut left_out;
  for (const Element& element : header.elements)
    if (!element.is_face() && !element.is_vertex()) left_out.add("elements \"" + element.name + "\"", element.count);
  has_strips ? left_out.warn(buffer.source, context) : left_out.report(buffer.source, context);
  SurfaceSoup soup = builder.finish(context);
  soup.has_names = has_patches;
  soup.single_precision = is_single;
  return soup;
}

void write_ply(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  require_count(mesh.n_vertices(), std::numeric_limits<std::int32_t>::max(), "vertices", "PLY", path.string());
  const std::vector<std::string> names = names_by_rules(mesh.patches, {.format = "PLY"}, context);
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (std::size_t i = 0; i < names.size(); ++i) header += "comment patch " + std::to_string(i + 1) + " " + names[i] + "\n";
  header += "element vertex " + std::to_string(mesh.n_vertices()) + "\nproperty double x\nproperty double y\nproperty double z\n";
  header += "element face " + std::to_string(mesh.n_triangles()) + "\nproperty list uchar int vertex_indices\nproperty int patch\nend_header\n";
  constexpr std::size_t k_vertex_bytes = 3 * sizeof(double);
  constexpr std::size_t k_face_bytes = 1 + 4 * sizeof(std::int32_t);
  const OutputSection vertices = items_section(mesh.n_vertices(), k_vertex_bytes, [&](std::uint64_t i, char* at) {
    for (std::size_t axis = 0; axis < 3; ++axis) at = put_bytes(at, mesh.points.raw()[i][axis], std::endian::little);
    return at;
  });
  const OutputSection faces = items_section(mesh.n_triangles(), k_face_bytes, [&](std::uint64_t i, char* at) {
    *at++ = 3;
    for (const VertexId v : mesh.triangles.raw()[i]) at = put_bytes(at, static_cast<std::int32_t>(v.value()), std::endian::little);
    return put_bytes(at, static_cast<std::int32_t>(patch_number(mesh, TriangleId(i))), std::endian::little);
  });
  write_file(path, {fixed_section(std::move(header)), vertices, faces}, context);
}

}  // namespace sterna::io
