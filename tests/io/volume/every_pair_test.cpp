// Every volume format of the table, alone and with every other format. New formats of the table are tested automatically.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>

#include "geom/mesh/check.h"
#include "geom/mesh/numbering.h"
#include "io/file/format_table.h"
#include "io/file/volume_file.h"
#include "io/names/patch_names.h"
#include "tests/io/volume/round_trip.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/half_shapes.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

/// A format with one of its extensions.
struct Variant {
  const Format* format;
  std::string extension;
  std::string name() const { return std::string(format->name) + " " + extension; }
};

/// Returns the formats that can be written and read.
std::vector<Variant> variants() {
  std::vector<Variant> result;
  for (const Format& format : formats()) {
    if (!format.write_volume) continue;
    EXPECT_NE(format.read_volume, nullptr) << format.name << " is written and not read";
    std::istringstream extensions{std::string(format.extensions)};
    for (std::string extension; extensions >> extension;) result.push_back({&format, extension});
  }
  return result;
}

/// Writes and reads the mesh; collects the messages.
HybridMesh through(const HybridMesh& mesh, const Variant& variant, const std::filesystem::path& folder, std::vector<std::string>* reported = nullptr,
                   Numbering cells = Numbering::lines) {
  const RunContext context({.threads = 2, .log = [reported](LogLevel level, std::string_view text) {
                              if (reported && level == LogLevel::warning) reported->emplace_back(text);
                            }});
  // "polymesh" is a folder name, not an extension; an OpenFOAM folder holds one mesh.
  const std::filesystem::path path = variant.extension.starts_with('.') ? folder / variant.extension.substr(1) / ("mesh" + variant.extension)
                                                                        : folder / "case" / "constant" / variant.extension;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path.parent_path());
  write_volume_file(mesh, path, context, variant.format->name, cells);
  return read_volume_file(path, context);
}

using Loop = std::vector<NodeId>;
template <class Nodes>
Loop loop_of(const Nodes& nodes) {
  Loop loop(nodes.begin(), nodes.end());
  std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  return loop;
}

/// Returns each boundary face with its patch, starting at its lowest node.
std::map<Loop, PatchId> faces_of(const HybridMesh& mesh) {
  std::map<Loop, PatchId> faces;
  for (const auto& face : mesh.boundary_triangles) faces[loop_of(face.nodes)] = face.patch;
  for (const auto& face : mesh.boundary_quads) faces[loop_of(face.nodes)] = face.patch;
  return faces;
}

/// Returns each cell as its outward faces, independent of the numbering of its nodes.
std::vector<std::vector<Loop>> cells_of(const HybridMesh& mesh) {
  std::vector<std::vector<Loop>> cells;
  for_each_cell(mesh, [&](const Cell& cell) {
    std::vector<Loop> faces;
    for (const LocalFace& local : cell_faces(cell.kind)) {
      Loop nodes;
      for (std::size_t k = 0; k < local.size; ++k) nodes.push_back(cell.nodes[local.nodes[k]]);
      faces.push_back(loop_of(nodes));
    }
    std::sort(faces.begin(), faces.end());
    cells.push_back(std::move(faces));
  });
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// Precision of coordinates of about 1: exact with 17 digits or 64 bits, half an ulp with 32 bits.
double precision_of(const Variant& variant) { return variant.extension == ".lb4.ugrid" || variant.extension == ".b4.ugrid" ? 0x1p-24 : 0.0; }

/// Content of a mesh, independent of its storage in a file.
struct Content {
  Column<NodeId, Point> points;
  std::vector<std::vector<Loop>> cells;
  std::map<Loop, PatchId> faces;
  explicit Content(const HybridMesh& mesh) : points(mesh.points), cells(cells_of(mesh)), faces(faces_of(mesh)) {}
};

/// Checks that the content is the same; returns for each patch of `back` the patch of `mesh`.
std::vector<PatchId> expect_same_content(const HybridMesh& back, const Content& expected, double precision) {
  const Content found(back);
  EXPECT_EQ(found.points.size(), expected.points.size());
  double farthest = 0.0;
  for (std::size_t i = 0; i < std::min(found.points.size(), expected.points.size()); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(found.points.raw()[i][axis] - expected.points.raw()[i][axis]));
  EXPECT_LE(farthest, precision);
  EXPECT_TRUE(found.cells == expected.cells);
  std::vector<PatchId> patch_of(back.patches.size());
  EXPECT_EQ(found.faces.size(), expected.faces.size());
  for (const auto& [loop, patch] : found.faces) {
    const auto it = expected.faces.find(loop);
    if (it == expected.faces.end()) {
      ADD_FAILURE() << "a boundary face that was not written";
      return patch_of;
    }
    if (!patch_of[patch.index()].is_valid()) patch_of[patch.index()] = it->second;
    EXPECT_EQ(patch_of[patch.index()], it->second) << "patch " << back.patches[patch].name;
  }
  EXPECT_NEAR(test::enclosed_volume(back), test::volume_of(back), 1e-12 * test::volume_of(back));  // rounding of sums
  return patch_of;
}

/// Checks that names are kept, or that a message states the old and the new name.
void expect_names(const HybridMesh& back, const HybridMesh& mesh, const std::vector<PatchId>& patch_of, const std::vector<std::string>& reported) {
  EXPECT_EQ(back.patches.size(), mesh.patches.size());
  for (const PatchId patch : back.patches.ids()) {
    ASSERT_TRUE(patch_of[patch.index()].is_valid()) << "a patch without faces: " << back.patches[patch].name;
    const std::string &found = back.patches[patch].name, &required = mesh.patches[patch_of[patch.index()]].name;
    if (found == required) continue;
    EXPECT_TRUE(std::any_of(reported.begin(), reported.end(),
                            [&](const std::string& line) { return line.find(required) != std::string::npos && line.find(found) != std::string::npos; }))
        << "\"" << required << "\" came back as \"" << found << "\", and nobody tells";
  }
}

TEST(EveryVolumeFormat, KeepsCellsFacesAndNames) {
  const HybridMesh mesh = test::six_patch_mesh();
  ASSERT_EQ(mesh.patches.size(), 6u);
  const CellCounts counts = count_cells(mesh);
  ASSERT_TRUE(counts.prisms > 0 && counts.pyramids > 0 && counts.tetrahedra > 0 && !mesh.boundary_quads.empty() && !mesh.boundary_triangles.empty());
  const Content content(mesh);
  ASSERT_GE(variants().size(), 12u);
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(variant.name());
    std::vector<std::string> reported;
    const HybridMesh back = through(mesh, variant, test::scratch(), &reported);
    expect_names(back, mesh, expect_same_content(back, content, precision_of(variant)), reported);
    EXPECT_EQ(back.patches.size(), 6u);
    for (const PatchId patch : back.patches.ids())
      EXPECT_EQ(std::count_if(mesh.patches.begin(), mesh.patches.end(), [&](const Patch& p) { return p.name == back.patches[patch].name; }), 1)
          << "plain names need no mapping: " << back.patches[patch].name;
  }
}

/// Returns the patch kind after reading, for formats with conditions of their own and for formats with names only.
PatchKind kind_after(const Format& format, const Patch& patch) {
  const bool has_names_only = format.name.starts_with("SU2") || format.name.starts_with("Gmsh") || format.name.starts_with("MSH");
  if (has_names_only) return kind_of_name(patch.name);
  if (patch.kind != PatchKind::interface) return patch.kind;
  // Disc patches: three formats have no such condition and write a slip wall, with a warning; CGNS writes UserDefined, which may mean anything.
  if (format.name == "TAU" || format.name == "Edge" || format.name.starts_with("UGRID")) return PatchKind::slip;
  return format.name == "CGNS" ? kind_of_name(patch.name) : patch.kind;
}

/// Layers that end on patches of all kinds, with quads beside triangles, and triangles beside collapsed growth lines.
TEST(EveryVolumeFormat, KeepsQuadsOfEveryKindOfPatch) {
  const HybridMesh mesh = test::half_shell_of_all_kinds(5, {.has_collapsed_border = true});
  const Content content(mesh);
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(variant.name());
    std::vector<std::string> reported;
    const HybridMesh back = through(mesh, variant, test::scratch(), &reported);
    const std::vector<PatchId> patch_of = expect_same_content(back, content, 2.0 * precision_of(variant));  // coordinates are up to 3
    expect_names(back, mesh, patch_of, reported);
    EXPECT_EQ(back.boundary_quads.size(), mesh.boundary_quads.size());
    for (const PatchId patch : back.patches.ids()) {
      const Patch& original = mesh.patches[patch_of[patch.index()]];
      const PatchKind expected = kind_after(*variant.format, original);
      EXPECT_EQ(to_string(back.patches[patch].kind), to_string(expected)) << original.name;
    }
  }
}

TEST(EveryVolumeFormat, KeepsLinesWithOwnNumbersOfLayers) {
  for (const HybridMesh& mesh : {test::two_shells(2, 2, 5), test::two_shells(2, 4, 1, {.collapsed = {0, 1, 44}}), test::stepped_sphere_shell(3),
                                 test::stepped_plate_block(4, {.collapsed = {12}})}) {
    const Content content(mesh);
    for (const Variant& variant : variants()) {
      SCOPED_TRACE(variant.name());
      std::vector<std::string> reported;
      const HybridMesh back = through(mesh, variant, test::scratch(), &reported);
      expect_names(back, mesh, expect_same_content(back, content, 16.0 * precision_of(variant)), reported);  // the second body is at 10 to 14
      if (precision_of(variant) == 0.0) {
        EXPECT_TRUE(check(back, {}, RunContext({.threads = 2})).is_valid());
      }
    }
  }
}

/// Returns the smallest six-fold volume of the four tetrahedra at a cell's corners, or of its sub-tetrahedra, divided by the product of the three lengths. The
/// test computes the volumes independently, from absolute coordinates as a solver does.
double least_volume_of_a_solver(const HybridMesh& mesh) {
  double least = 1.0;
  const auto note = [&](const Point& o, const Point& a, const Point& b, const Point& c) {
    const Vec3 u = a - o, v = b - o, w = c - o;
    least = std::min(least, dot(cross(u, v), w) / (norm(u) * norm(v) * norm(w)));
  };
  for_each_cell(mesh, [&](const Cell& cell) {
    const auto nodes = cell.span();
    Point centre;
    for (const NodeId node : nodes) centre += mesh.points[node];
    centre = centre / static_cast<double>(nodes.size());
    for (const LocalFace& face : cell_faces(cell.kind)) {
      Point middle;
      for (std::size_t k = 0; k < face.size; ++k) middle += mesh.points[nodes[face.nodes[k]]];
      middle = middle / face.size;
      for (std::size_t k = 0; k < face.size; ++k) {
        const Point &a = mesh.points[nodes[face.nodes[k]]], &b = mesh.points[nodes[face.nodes[(k + 1) % face.size]]];
        const Point half = (a + b) / 2.0;
        note(a, middle, half, centre);
        note(b, half, middle, centre);
      }
    }
  });
  return least;
}

/// A reader of the file that computes volumes in double precision must get the proven values.
TEST(EveryVolumeFormat, VolumesInDoublePrecisionArePositiveAfterReading) {
  // A flat layer away from the origin: its first cells are 1e-6 high at coordinates of 100, where single precision steps by 8e-6.
  HybridMesh flat = test::stepped_sphere_shell(4, {.n_layers = 6, .layer_height = 2e-5, .ratio = 1.2});
  for (Point& p : flat.points) p += Vec3{100.0, 100.0, 100.0};
  const HybridMesh thick = test::mixed_mesh();
  ASSERT_GT(least_volume_of_a_solver(flat), 1e-13);
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(variant.name());
    EXPECT_GT(least_volume_of_a_solver(through(thick, variant, test::scratch())), 1e-13);
    if (precision_of(variant) == 0.0) {
      EXPECT_GT(least_volume_of_a_solver(through(flat, variant, test::scratch())), 1e-13);
      continue;
    }
    const ErrorInfo error = test::error_info_of([&] { through(flat, variant, test::scratch()); });
    EXPECT_EQ(error.code, ErrorCode::mesh_invalid);
    EXPECT_NE(error.problem.find("flat or folded"), std::string::npos) << error.problem;
    EXPECT_NE(error.hint.find(".lb8.ugrid"), std::string::npos);
    ASSERT_FALSE(error.locations.empty());
    EXPECT_NE(error.locations.front().what.find("near patch"), std::string::npos) << error.locations.front().what;
    EXPECT_LT(distance(error.locations.front().position, Point{100.0, 100.0, 100.0}), 3.0);
  }
}

TEST(EveryVolumeFormat, AwkwardNamesAreKeptOrTold) {
  HybridMesh mesh = test::six_patch_mesh();
  const std::array<std::string, 6> names = {"wing of the left side, with its flap and slat tracks",  // longer than 32 bytes, blanks
                                            "wing of the left side, with its flap and slat rails",   // identical in the first 32 bytes
                                            "Fl\xC3\xBC"
                                            "gel-\xE7\xBF\xBC",  // UTF-8
                                            "Fl\xC3\xBCgel \xC3\xBC"
                                            "ber dem Rumpf hinter dem Cockpit \xC3\xA4\xC3\xB6\xC3\xBC",  // UTF-8, truncated
                                            "2nd \"wall\"; (a=b){%}",
                                            "Wall/of\\paths#1"};
  for (std::size_t i = 0; i < names.size(); ++i) mesh.patches[PatchId(static_cast<std::uint64_t>(i))].name = names[i];
  const Content content(mesh);
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(variant.name());
    std::vector<std::string> reported;
    const HybridMesh back = through(mesh, variant, test::scratch(), &reported);
    expect_names(back, mesh, expect_same_content(back, content, precision_of(variant)), reported);
  }
}

/// Returns each cell as its points, independent of numbering.
std::vector<std::vector<std::array<double, 3>>> cells_by_points(const HybridMesh& mesh) {
  std::vector<std::vector<std::array<double, 3>>> cells;
  for_each_cell(mesh, [&](const Cell& cell) {
    std::vector<std::array<double, 3>> points;
    for (const NodeId node : cell.span()) points.push_back({mesh.points[node].x, mesh.points[node].y, mesh.points[node].z});
    std::ranges::sort(points);
    cells.push_back(std::move(points));
  });
  std::ranges::sort(cells);
  return cells;
}

/// Counts the prisms of a file that do not stand on the preceding prism: the number of columns if columns are contiguous.
std::size_t count_stacks(const HybridMesh& mesh) {
  std::size_t n = 0;
  std::vector<NodeId> before;
  for_each_cell(mesh, [&](const Cell& cell) {
    if (cell.kind != CellKind::prism) return;
    std::vector<NodeId> nodes(cell.span().begin(), cell.span().end()), common;
    std::ranges::sort(nodes);
    std::ranges::set_intersection(nodes, before, std::back_inserter(common));
    n += common.size() == 3 ? 0 : 1;
    before = std::move(nodes);
  });
  return n;
}

/// Requirement of line-implicit solvers: the nodes of each growth line, and the prisms of each column, are consecutive and start at the wall.
TEST(EveryVolumeFormat, KeepsTheOrderForSolvers) {
  const HybridMesh mesh = test::sphere_shell(6, {.n_layers = 5});
  const RunContext context({.threads = 2});
  const auto given = cells_by_points(mesh);
  for (const Numbering numbering : {Numbering::bandwidth, Numbering::both}) {
    const HybridMesh numbered = renumbered(mesh, numbering, context);
    ASSERT_TRUE(cells_by_points(numbered) == given);
    EXPECT_LT(measure_numbering(node_graph(numbered, context)).mean_profile, 0.7 * measure_numbering(node_graph(mesh, context)).mean_profile);
    const Content content(numbered);
    for (const Variant& variant : variants()) {
      SCOPED_TRACE(variant.name());
      const HybridMesh back = through(numbered, variant, test::scratch(), nullptr, numbering);
      expect_same_content(back, content, 8.0 * precision_of(variant));
      if (numbering == Numbering::both) EXPECT_EQ(count_stacks(back), mesh.layers.n_columns());
    }
  }
  // If a file does not store the columns, the growth lines are found from the prisms on walls.
  const HybridMesh found = renumbered(explicit_cells(renumbered(mesh, Numbering::bandwidth, context)), Numbering::both, context);
  EXPECT_TRUE(cells_by_points(found) == given);
  EXPECT_EQ(count_stacks(found), mesh.layers.n_columns());
  std::size_t n_steps = 0;
  for (const auto& prism : found.prisms)
    for (std::size_t k = 0; k < 3; ++k) n_steps += prism[k + 3].value() == prism[k].value() + 1 ? 1 : 0;
  EXPECT_EQ(n_steps, 3 * found.prisms.size()) << "each node has the next number of the one below it";
}

TEST(EveryVolumeFormat, EveryPairKeepsCellsFacesAndNames) {
  const HybridMesh mesh = test::six_patch_mesh();
  const Content content(mesh);
  const auto folder = test::scratch();
  for (const Variant& first : variants()) {
    if (!first.format->extensions.starts_with(first.extension)) continue;  // other extensions of a format read the same content
    const HybridMesh once = through(mesh, first, folder / "once");
    for (const Variant& second : variants()) {
      SCOPED_TRACE(first.name() + " to " + second.name());
      std::vector<std::string> reported;
      const HybridMesh twice = through(once, second, folder / "twice", &reported);
      expect_names(twice, mesh, expect_same_content(twice, content, std::max(precision_of(first), precision_of(second))), reported);
    }
  }
}

}  // namespace
}  // namespace sterna::io
