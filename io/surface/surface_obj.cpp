// Reads vertices and faces of OBJ. Changes of group, object and material are recorded, and one of the three becomes the patches at the end.
#include "io/surface/surface_obj.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <set>
#include <string>
#include <vector>

#include "io/input/left_out.h"
#include "io/input/text_limits.h"
#include "io/input/text_scanner.h"
#include "io/mesh/surface_builder.h"
#include "io/mesh/surface_polygon.h"
#include "io/names/name_rules.h"
#include "io/output/surface_output.h"

namespace sterna::io {
namespace {

/// Keywords that have no effect on the triangles of the surface.
constexpr std::array<std::string_view, 41> k_ignored = {
    "vt",         "vn",        "vp",    "s",     "l",    "p",   "mtllib", "maplib", "usemap", "mg",     "lod",  "bevel", "c_interp", "d_interp",
    "shadow_obj", "trace_obj", "ctech", "stech", "call", "csh", "deg",    "bmat",   "step",   "cstype", "curv", "curv2", "surf",     "parm",
    "trim",       "hole",      "scrv",  "sp",    "end",  "con", "res",    "cdp",    "cdc",    "bzp",    "bsp",  "vc",    "cbp"};

/// Returns the geometry type of a keyword in k_ignored; empty for the rest.
std::string_view geometry_of(std::string_view word) {
  if (word == "l") return "lines (l)";
  if (word == "p") return "points (p)";
  if (word == "surf") return "free-form surfaces (surf)";
  if (word == "curv" || word == "curv2") return "free-form curves (curv)";
  if (word == "bzp" || word == "bsp") return "patches of curves (bzp, bsp)";
  return {};
}

/// The three ways to name parts in a file.
enum Naming : std::size_t { k_group, k_object, k_material, k_n_namings };

/// From polygon `first` on, the parts are called `name`.
struct NameChange {
  std::size_t first = 0;
  std::string name;
};

struct Faces {
  std::vector<std::uint32_t> corners;
  std::vector<std::size_t> ends;  ///< per face: index in `corners` after its last corner
  std::array<std::vector<NameChange>, k_n_namings> changes;
  std::size_t size() const { return ends.size(); }
};

/// The highest vertex referenced by a face, and the location of that reference. It is checked at the end, because a face may precede its vertices.
struct HighestIndex {
  std::int64_t value = 0;
  std::size_t offset = 0;
};

/// Parses one corner "7", "7/2", "7//5", "-1/2/5". Returns the vertex counted from 0.
std::uint32_t parse_corner(TextScanner& scanner, std::size_t n_points, HighestIndex& highest) {
  constexpr std::string_view k_expected = "a vertex number (from 1, or negative from the last), perhaps with /texture/normal";
  const std::string_view token = scanner.token(k_expected);
  std::int64_t number = 0;
  const auto result = std::from_chars(token.data(), token.data() + token.size(), number);
  const std::string_view rest(result.ptr, static_cast<std::size_t>(token.data() + token.size() - result.ptr));
  if (result.ec != std::errc{} || number == 0 || (!rest.empty() && rest.front() != '/') || rest.find_first_not_of("/-0123456789") != std::string_view::npos)
    scanner.fail_expected(k_expected);
  const std::int64_t index = number > 0 ? number - 1 : number + static_cast<std::int64_t>(n_points);
  if (index < 0) scanner.fail("found vertex number " + std::to_string(number) + ", but only " + std::to_string(n_points) + " vertices precede it");
  if (index >= static_cast<std::int64_t>(0xFFFFFFFF)) scanner.fail("found vertex number " + std::to_string(number) + ", expected at most 4294967294");
  if (index >= highest.value) highest = {index, scanner.offset()};
  return static_cast<std::uint32_t>(index);
}

void parse_face(TextScanner& scanner, std::size_t n_points, HighestIndex& highest, Faces& faces) {
  const std::size_t first = faces.corners.size();
  while (!scanner.at_line_end()) faces.corners.push_back(parse_corner(scanner, n_points, highest));
  const std::size_t n = faces.corners.size() - first;
  if (n < 3 || n > k_max_polygon_corners)
    scanner.fail("found a face of " + std::to_string(n) + " corners, expected 3 to " + std::to_string(k_max_polygon_corners));
  faces.ends.push_back(faces.corners.size());
}

/// Chooses the source of the names of patches: the first of groups, objects and materials with more than one name, else the first with one name.
const std::vector<NameChange>* choose_naming(const Faces& faces) {
  const std::vector<NameChange>* first_with_name = nullptr;
  for (const std::vector<NameChange>& changes : faces.changes) {
    std::set<std::string_view> names;
    if (!changes.empty() && changes.front().first > 0) names.insert("");
    for (std::size_t i = 0; i < changes.size(); ++i) {
      const std::size_t end = i + 1 < changes.size() ? changes[i + 1].first : faces.size();
      if (changes[i].first < end) names.insert(changes[i].name);
    }
    if (names.size() > 1) return &changes;
    if (names.size() == 1 && !names.begin()->empty() && !first_with_name) first_with_name = &changes;
  }
  return first_with_name;
}

/// Reports namings that are not used. A file may name its parts in several ways, but only one of them becomes the patches.
void report_other_namings(const Faces& faces, const std::vector<NameChange>* chosen, const std::string& source, const RunContext& context) {
  constexpr std::array<std::string_view, k_n_namings> k_words = {"groups", "objects", "materials"};
  const auto names_of = [](const std::vector<NameChange>& changes) {
    std::set<std::string_view> names;
    for (const NameChange& change : changes) names.insert(change.name);
    return names;
  };
  for (std::size_t k = 0; k < k_n_namings; ++k)
    if (chosen && &faces.changes[k] != chosen && names_of(faces.changes[k]).size() > 1 && names_of(faces.changes[k]) != names_of(*chosen))
      context.info(source + ": patches are named by " + std::string(k_words[static_cast<std::size_t>(chosen - faces.changes.data())]) + "; the " +
                   std::to_string(names_of(faces.changes[k]).size()) + " " + std::string(k_words[k]) + " are left out");
}

}  // namespace

SurfaceSoup read_obj(const std::filesystem::path& path, const RunContext& context) {
  const FileBuffer buffer = load_file(path, context);
  TextScanner scanner(buffer, {.comment = '#', .continuation = '\\', .line_bound = true});
  SurfaceBuilder builder(buffer.source);
  Faces faces;
  HighestIndex highest;
  LeftOut surfaces, others;
  for (std::size_t i = 0; !scanner.at_end(); ++i) {
    if (i % k_stop_interval == 0) context.check_stop();
    const std::string_view word = scanner.token("a keyword");
    if (word == "v") {
      Vec3 p;
      for (std::size_t axis = 0; axis < 3; ++axis) p[axis] = scanner.coordinate("a coordinate of a vertex");
      builder.add_point(p);
    } else if (word == "f" || word == "fo") {
      parse_face(scanner, builder.n_points(), highest, faces);
    } else if (word == "g" || word == "o" || word == "usemtl") {
      const Naming naming = word == "g" ? k_group : word == "o" ? k_object : k_material;
      faces.changes[naming].push_back({.first = faces.size(), .name = scanner.at_line_end() ? std::string() : std::string(scanner.rest_of_line())});
      continue;  // rest_of_line has moved on; at a line end the next iteration skips it
    } else if (std::find(k_ignored.begin(), k_ignored.end(), word) == k_ignored.end()) {
      scanner.fail_expected("an OBJ keyword such as \"v\", \"f\" or \"g\"");
    } else if (const std::string_view geometry = geometry_of(word); !geometry.empty()) {
      (word == "surf" || word == "bzp" || word == "bsp" ? surfaces : others).add(geometry);
    }
    scanner.next_line();
  }
  if (faces.size() > 0 && highest.value >= static_cast<std::int64_t>(builder.n_points()))
    throw_malformed(buffer.source, "line " + std::to_string(scanner.line_at(highest.offset)),
                    "found vertex number " + std::to_string(highest.value + 1) + ", but the file has " + std::to_string(builder.n_points()) + " vertices");

  surfaces.warn(buffer.source, context);
  others.report(buffer.source, context);
  const std::vector<NameChange>* const naming = choose_naming(faces);
  report_other_namings(faces, naming, buffer.source, context);
  constexpr std::string_view k_default_group = "default";  // the format's name for elements before any group
  if (naming) builder.set_patch(k_default_group);
  builder.reserve_polygons(faces.size());
  std::size_t next_change = 0;
  for (std::size_t i = 0, first = 0; i < faces.size(); first = faces.ends[i++]) {
    while (naming && next_change < naming->size() && (*naming)[next_change].first <= i) {
      const std::string& name = (*naming)[next_change++].name;
      builder.set_patch(name.empty() ? k_default_group : std::string_view(name));
    }
    builder.add_polygon(std::span(faces.corners).subspan(first, faces.ends[i] - first));
  }
  SurfaceSoup soup = builder.finish(context);
  soup.has_names = naming != nullptr;
  return soup;
}

void write_obj(const TriMesh& mesh, const std::filesystem::path& path, const RunContext& context) {
  const std::vector<std::string> names = names_by_rules(mesh.patches, {.format = "OBJ", .forbidden = "#\\", .may_have_blanks = false}, context);
  std::size_t longest_name = 0;
  for (const std::string& name : names) longest_name = std::max(longest_name, name.size());
  const OutputSection faces = items_section(mesh.n_triangles(), longest_name + 3 * k_max_id_text + 8, [&](std::uint64_t i, char* at) {
    const TriangleId t(i);
    const PatchId patch = mesh.triangle_patch[t];
    if (i == 0 || mesh.triangle_patch[TriangleId(i - 1)] != patch) {
      at = put_text(put_text(at, "g "), names[patch.index()]);
      *at++ = '\n';
    }
    at = put_corners_text(put_text(at, "f "), mesh.triangles[t], 1);
    *at++ = '\n';
    return at;
  });
  write_file(path, {point_lines(mesh, "v "), faces}, context);
}

}  // namespace sterna::io
