#include <gmock/gmock.h>

#include <limits>

#include "geom/math/measures.h"
#include "io/file/volume_file.h"
#include "tests/io/volume/volume_tools.h"
#include "tests/support/data.h"
#include "tests/support/hybrid_shapes.h"

namespace sterna::io {
namespace {

using test::bytes_of;
using test::expect_error;
using test::write_text;

/// The worked example of docs/method/formats.md, "Sample meshes": a prism with a tetrahedron on it.
HybridMesh prism_and_tet() {
  HybridMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {0.25, 0.25, 2}};
  const auto n = [](int i) { return NodeId(i); };
  mesh.prisms = {{n(0), n(1), n(2), n(3), n(4), n(5)}};
  mesh.tetrahedra = {{n(3), n(4), n(5), n(6)}};
  mesh.patches = {{"wall", PatchKind::wall}, {"side", PatchKind::wall}, {"farfield", PatchKind::farfield}};
  mesh.boundary_triangles = {
      {{n(0), n(2), n(1)}, PatchId(0)}, {{n(3), n(4), n(6)}, PatchId(2)}, {{n(4), n(5), n(6)}, PatchId(2)}, {{n(5), n(3), n(6)}, PatchId(2)}};
  mesh.boundary_quads = {{{n(0), n(1), n(4), n(3)}, PatchId(1)}, {{n(1), n(2), n(5), n(4)}, PatchId(1)}, {{n(2), n(0), n(3), n(5)}, PatchId(1)}};
  return mesh;
}

constexpr const char* k_prism_and_tet =
    "NDIME= 3\nNPOIN= 7\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 1\n0 1 1\n0.25 0.25 2\n"
    "NELEM= 2\n13 0 2 1 3 5 4\n10 3 4 5 6\n"
    "NMARK= 3\nMARKER_TAG= wall\nMARKER_ELEMS= 1\n5 0 2 1\n"
    "MARKER_TAG= side\nMARKER_ELEMS= 3\n9 0 1 4 3\n9 1 2 5 4\n9 2 0 3 5\n"
    "MARKER_TAG= farfield\nMARKER_ELEMS= 3\n5 3 4 6\n5 4 5 6\n5 5 3 6\n";

using test::read;
HybridMesh read_text(const std::string& text) { return read(write_text("mesh.su2", text)); }
using test::write;

void expect_equal(const HybridMesh& a, const HybridMesh& b) {
  EXPECT_EQ(a.points, b.points);  // to the bit
  EXPECT_EQ(a.prisms, b.prisms);
  EXPECT_EQ(a.pyramids, b.pyramids);
  EXPECT_EQ(a.hexahedra, b.hexahedra);
  EXPECT_EQ(a.tetrahedra, b.tetrahedra);
  EXPECT_EQ(a.patches, b.patches);
}

using test::replaced;

TEST(Su2Write, WorkedExampleByteForByte) {
  const auto path = test::scratch() / "pt.su2";
  write(prism_and_tet(), path);
  EXPECT_EQ(bytes_of(path), k_prism_and_tet);
}

TEST(Su2Write, ColumnsAndExplicitCellsGiveTheSameFile) {
  const HybridMesh columns = test::mixed_mesh();
  const CellCounts counts = count_cells(columns);
  ASSERT_GT(counts.pyramids, 0);  // otherwise the test would prove little
  const auto folder = test::scratch();
  write(columns, folder / "columns.su2");
  write(explicit_cells(columns), folder / "explicit.su2");
  EXPECT_EQ(bytes_of(folder / "columns.su2"), bytes_of(folder / "explicit.su2"));
}

TEST(Su2Write, SameBytesForAnyNumberOfThreads) {
  const HybridMesh mesh = test::sphere_shell(24, {.collapsed = {5, 100, 101}});  // many chunks and batches
  const auto folder = test::scratch();
  for (const std::string extension : {".su2", ".vtu"}) {
    for (const int threads : {1, 2, 7}) write_volume_file(mesh, folder / (std::to_string(threads) + extension), RunContext({.threads = threads}));
    const std::string one = bytes_of(folder / ("1" + extension));
    EXPECT_GT(one.size(), 1000000u);
    EXPECT_TRUE(one == bytes_of(folder / ("2" + extension)));
    EXPECT_TRUE(one == bytes_of(folder / ("7" + extension)));
  }
}

TEST(Su2Write, UnsupportedNamesAreChangedWithWarning) {
  HybridMesh mesh = prism_and_tet();
  mesh.patches = {{"left wing (a)", PatchKind::wall}, {"SEND_RECEIVE", PatchKind::wall}, {"", PatchKind::farfield}, {"unused", PatchKind::wall}};
  std::vector<std::string> log;
  const RunContext context({.threads = 1, .log = [&](LogLevel level, std::string_view text) {
                              if (level == LogLevel::warning) log.emplace_back(text);
                            }});
  const auto path = test::scratch() / "mesh.su2";
  write_volume_file(mesh, path, context);
  const std::string text = bytes_of(path);
  EXPECT_THAT(text, testing::HasSubstr("NMARK= 3\nMARKER_TAG= left_wing__a_\n"));
  EXPECT_THAT(text, testing::HasSubstr("MARKER_TAG= SEND_RECEIVE_2\n"));
  EXPECT_THAT(text, testing::HasSubstr("MARKER_TAG= patch_3\n"));
  EXPECT_THAT(text, testing::Not(testing::HasSubstr("unused")));  // no faces, so no marker
  ASSERT_EQ(log.size(), 3u);
  EXPECT_THAT(log[0], testing::HasSubstr("\"left wing (a)\" is written as marker \"left_wing__a_\""));
}

TEST(Su2Write, RefusesWhatSu2CannotHold) {
  const auto path = test::scratch() / "mesh.su2";
  HybridMesh mesh;
  mesh.layers.n_layers = std::numeric_limits<int>::max();
  mesh.layers.first_node = {0, 1, 2};
  mesh.layers.is_collapsed = {0, 0, 0};
  mesh.layers.base = {{0, 1, 2}, {0, 2, 1}};
  expect_error(ErrorCode::overflow, "4294967294 cells", [&] { write(mesh, path); });

  mesh = prism_and_tet();
  mesh.points[NodeId(4)].y = std::numeric_limits<double>::quiet_NaN();
  expect_error(ErrorCode::mesh_invalid, "node 4 are not finite", [&] { write(mesh, path); });
  mesh = prism_and_tet();
  mesh.boundary_quads[1].patch = PatchId(3);
  expect_error(ErrorCode::mesh_invalid, "boundary quad 1 has patch 3 of 3", [&] { write(mesh, path); });
  EXPECT_TRUE(test::files_in(path.parent_path()).empty());
}

TEST(Su2, RoundTripToTheBit) {
  const auto folder = test::scratch();
  int i = 0;
  for (const HybridMesh& mesh :
       {prism_and_tet(), test::mixed_mesh(), test::hexahedron_with_roof(), test::hexahedra_block(3), test::sphere_shell(12, {.collapsed = {0, 20, 21}})}) {
    const auto first = folder / (std::to_string(i) + "a.su2"), second = folder / (std::to_string(i) + "b.su2");
    ++i;
    write(mesh, first);
    const HybridMesh back = read(first);
    HybridMesh expected = explicit_cells(mesh);
    for (Patch& patch : expected.patches) patch.kind = patch.name == "farfield" ? PatchKind::farfield : PatchKind::wall;  // the file stores no kinds
    expect_equal(back, expected);
    EXPECT_EQ(back.boundary_triangles.size(), mesh.boundary_triangles.size());
    EXPECT_EQ(back.boundary_quads.size(), mesh.boundary_quads.size());
    EXPECT_NEAR(test::enclosed_volume(back), test::volume_of(mesh), 1e-12 * test::volume_of(mesh));  // rounding of sums
    write(back, second);
    EXPECT_EQ(bytes_of(first), bytes_of(second));
  }
}

TEST(Su2, CoordinatesOfAllSizesSurvive) {
  HybridMesh mesh = prism_and_tet();
  const double tiny = std::numeric_limits<double>::denorm_min();
  mesh.points[NodeId(0)] = {-0.0, tiny, -2.2250738585072014e-308};
  mesh.points[NodeId(1)] = {1.0 / 3.0, 0.1, 1.7976931348623157e308};
  const auto path = test::scratch() / "mesh.su2";
  write(mesh, path);
  const HybridMesh back = read(path);
  EXPECT_EQ(back.points, mesh.points);
  EXPECT_TRUE(std::signbit(back.points[NodeId(0)].x));
}

TEST(Su2Read, Variants) {
  const HybridMesh expected = prism_and_tet();
  const std::string text = k_prism_and_tet;
  const auto same = [&](const std::string& variant) {
    SCOPED_TRACE(variant);
    const HybridMesh mesh = read_text(variant);
    expect_equal(mesh, expected);
    ASSERT_EQ(mesh.boundary_quads.size(), 3u);
    EXPECT_EQ(mesh.boundary_quads[2].nodes, expected.boundary_quads[2].nodes);
    EXPECT_EQ(mesh.boundary_quads[2].patch, PatchId(1));
  };
  same(text);
  same("% comment\n\n" + replaced(text, "NELEM= 2", "\n% between\n  NELEM = 2"));
  same(replaced(text, "NPOIN= 7", "NPOIN=7 7"));
  same(text.substr(0, text.size() - 1));  // no line end at the end of the file
  same(text + "NPERIODIC= 1\nPERIODIC_INDEX= 0\n0 0 0\n0 0 0\n0 0 0\nFFD_NBOX= 0\n");
  same("AOA_OFFSET= 1.5\n" + text);
  same(replaced(text, "0.25 0.25 2\n", "2.5D-1 +0.25 0.2e1 6\n\n"));
  same(replaced(text, "10 3 4 5 6\n", "10 3 4 5 6 1\n% inside\n"));
  same("\tNZONE= 1\nIZONE= 1\n" + text);
  same(replaced(text, "MARKER_TAG= side", "MARKER_TAG= s ide "));
  same(replaced(replaced(text, "NMARK= 3\n", "NMARK= 4\n"), "MARKER_TAG= side",
                "MARKER_TAG= SEND_RECEIVE\nMARKER_ELEMS= 2\nSEND_TO= -2\n1 3 0 0\n1 4 0 0\nMARKER_TAG= side"));
  std::string crlf;
  for (const char c : text) crlf += c == '\n' ? std::string("\r\n") : std::string(1, c);
  same(crlf);
  // Elements before nodes.
  const std::size_t points = text.find("NPOIN"), elements = text.find("NELEM"), markers = text.find("NMARK");
  same(text.substr(0, points) + text.substr(elements, markers - elements) + text.substr(points, elements - points) + text.substr(markers));
}

TEST(Su2Read, WrongWindingsAreFlippedAndTold) {
  std::string text = k_prism_and_tet;
  text = replaced(text, "13 0 2 1 3 5 4", "13 0 1 2 3 4 5");  // CGNS order, as meshio writes it
  text = replaced(text, "10 3 4 5 6", "10 3 5 4 6");
  text = replaced(text, "9 1 2 5 4", "9 1 4 5 2");
  text = replaced(text, "5 3 4 6", "5 6 4 3");
  std::vector<std::string> log;
  const RunContext context({.threads = 1, .log = [&](LogLevel, std::string_view line) { log.emplace_back(line); }});
  const HybridMesh mesh = read_volume_file(write_text("mesh.su2", text), context);
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(test::enclosed_volume(mesh), 2.0 / 3.0);
  EXPECT_THAT(log, testing::ElementsAre(testing::HasSubstr("flipped: 1 of kind tetrahedron"), testing::HasSubstr("flipped: 1 of kind prism"),
                                        testing::HasSubstr("turned outwards: 2"), testing::HasSubstr("mesh.su2: 2 of 2 cells in the file are inverted")));
  EXPECT_EQ(mesh.n_flipped_cells, 2);
}

TEST(Su2Read, EveryKindIsFlipped) {
  for (HybridMesh mesh : {test::hexahedron_with_roof(), test::mixed_mesh()}) {
    mesh = explicit_cells(mesh);
    const double volume = test::volume_of(mesh);
    for (Point& p : mesh.points) p.x = -p.x;  // mirroring inverts every cell and face
    const auto path = test::scratch() / "mesh.su2";
    write(mesh, path);
    const HybridMesh back = read(path);
    EXPECT_NEAR(test::volume_of(back), volume, 1e-13 * volume);
    EXPECT_NEAR(test::enclosed_volume(back), volume, 1e-13 * volume);
  }
}

/// Two prisms on each other and a tetrahedron, with the nodes of the cells of each kind in this order.
std::vector<std::string> warnings_of_windings(const std::string& first_prism, const std::string& second_prism, const std::string& tetrahedron) {
  std::vector<std::string> warnings;
  const RunContext context({.threads = 1, .log = [&](LogLevel level, std::string_view line) {
                              if (level == LogLevel::warning) warnings.emplace_back(line);
                            }});
  const std::string text = "NDIME= 3\nNELEM= 3\n13 " + first_prism + "\n13 " + second_prism + "\n10 " + tetrahedron +
                           "\nNPOIN= 10\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 1\n0 1 1\n0 0 2\n1 0 2\n0 1 2\n0 0 3\nNMARK= 0\n";
  const HybridMesh mesh = read_volume_file(test::write_text("windings.su2", text), context);
  EXPECT_DOUBLE_EQ(test::volume_of(mesh), 1.0 + 1.0 / 6.0);
  std::erase_if(warnings, [](const std::string& line) { return line.find("no boundary faces") != std::string::npos; });
  EXPECT_EQ(mesh.n_flipped_cells > 0, !warnings.empty());
  return warnings;
}

TEST(Su2Read, InvertedCellsWarnButConventionsOfPrismsDoNot) {
  const std::string first = "0 2 1 3 5 4", second = "3 5 4 6 8 7", tet = "6 7 8 9";
  const std::string other_first = "0 1 2 3 4 5", other_second = "3 4 5 6 7 8", inverted_tet = "6 8 7 9";
  EXPECT_THAT(warnings_of_windings(first, second, tet), testing::IsEmpty());
  EXPECT_THAT(warnings_of_windings(other_first, other_second, tet), testing::IsEmpty());
  EXPECT_THAT(warnings_of_windings(other_first, second, tet),
              testing::ElementsAre(testing::AllOf(testing::HasSubstr("windings.su2: 1 of 3 cells in the file are inverted"), testing::HasSubstr("convert"))));
  EXPECT_THAT(warnings_of_windings(first, second, inverted_tet), testing::ElementsAre(testing::HasSubstr("1 of 3 cells")));
  EXPECT_THAT(warnings_of_windings(other_first, other_second, inverted_tet), testing::ElementsAre(testing::HasSubstr("3 of 3 cells")));
}

TEST(Su2Read, WarpedValidPrismsStay) {
  // Valid by the exact test, but of negative volume if its sides are cut along the wrong diagonals: only the exact formula gives the right winding.
  HybridMesh mesh;
  const WedgePoints p = {{{-1.38, 1.26, -0.04}, {2.57, 1.04, -0.21}, {-0.27, 1.22, -0.07}, {-0.82, -0.99, 0.2}, {0.97, 1.42, 2.05}, {-0.38, -0.34, 0.69}}};
  ASSERT_TRUE(is_wedge_valid(p));
  ASSERT_LT(tet_volume(p[0], p[1], p[2], p[5]) + tet_volume(p[0], p[1], p[5], p[4]) + tet_volume(p[0], p[4], p[5], p[3]), 0.0);
  for (const Point& point : p) mesh.points.push_back(point);
  mesh.prisms.push_back({NodeId(0), NodeId(1), NodeId(2), NodeId(3), NodeId(4), NodeId(5)});
  const auto path = test::scratch() / "mesh.su2";
  write(mesh, path);
  EXPECT_EQ(read(path).prisms, mesh.prisms);
}

TEST(Su2Read, KindsFollowFromNames) {
  const HybridMesh mesh = read_text(replaced(replaced(k_prism_and_tet, "TAG= side", "TAG= Symmetry_y"), "TAG= farfield", "TAG= FARFIELD_1"));
  EXPECT_EQ(mesh.patches[PatchId(0)].kind, PatchKind::wall);
  EXPECT_EQ(mesh.patches[PatchId(1)].kind, PatchKind::symmetry);
  EXPECT_EQ(mesh.patches[PatchId(2)].kind, PatchKind::farfield);
}

TEST(Su2Read, MistakesHaveTheirLine) {
  const std::string text = k_prism_and_tet;
  const auto wrong = [&](const std::string& from, const std::string& to, const std::string& message) {
    SCOPED_TRACE(to);
    expect_error(ErrorCode::file_malformed, message, [&] { read_text(replaced(text, from, to)); });
  };
  wrong("0 0 1\n", "0 zero 1\n", "line 6: found \"zero\", expected a coordinate of node 3");
  wrong("0 0 1\n", "0 0\n", "line 6: found the end of the line, expected a coordinate of node 3");
  wrong("0 0 1\n", "0 0 nan\n", "line 6: found \"nan\"");
  wrong("0 0 1\n", "0 0 1e999\n", "line 6: found \"1e999\"");
  wrong("0 0 1\n", "0 0x10 1\n", "line 6: found \"0x10\"");
  wrong("10 3 4 5 6", "10 3 4 5 7", "line 12: found 7 as a node of element 1, expected a number from 0 to 6");
  wrong("10 3 4 5 6", "10 3 4 5", "line 12: found the end of the line, expected a node of element 1");
  wrong("10 3 4 5 6", "10 3 -4 5 6", "line 12: found \"-4\"");
  wrong("10 3 4 5 6", "5 3 4 5", "line 12: found element type 5, expected a volume element");
  wrong("5 0 2 1", "3 0 2", "line 16: found element type 3 in a marker");
  wrong("NELEM= 2", "NELEM= 1", "line 12: found \"10 3 4 5 6\", expected a keyword such as NPOIN= or MARKER_TAG=; NELEM= in line 10 announces fewer lines");
  wrong("NPOIN= 7", "NPOIN= 8", "line 10: found \"NELEM= 2\" after 7 of the 8 lines that NPOIN= in line 2 announces");
  wrong("MARKER_ELEMS= 3\n5", "MARKER_ELEMS= 4\n5", "found the end of the file after 3 of the 4 lines that MARKER_ELEMS= in line 23 announces");
  wrong("NPOIN= 7", "NPOIN= 99999999999", "of the 99999999999 lines that NPOIN= in line 2 announces");
  wrong("NPOIN= 7", "NPOIN= -7", "line 2: found \"-7\", expected a count after NPOIN=");
  wrong("NPOIN= 7", "NPOIN=", "line 2: found \"\", expected a count");
  wrong("NMARK= 3", "NMARK= 4", "found 3 markers, expected 4");
  wrong("NMARK= 3\n", "NMARK= 3\nNELEM= 0\n", "line 14: a second NELEM=; the first is in line 10");
  wrong("MARKER_ELEMS= 1\n", "", "line 15: found \"5 0 2 1\", expected MARKER_ELEMS= of marker \"wall\"");
  wrong("NDIME= 3\n", "", "without NDIME=");
  wrong("NDIME= 3\n", "NDIME= 4\n", "line 1: found \"4\", expected 3");
  expect_error(ErrorCode::file_malformed, "without NDIME=", [] { read_text("% nothing\n"); });
  expect_error(ErrorCode::file_malformed, "line 1: found \"hello\"", [] { read_text("hello\n"); });
  expect_error(ErrorCode::unsupported_format, "NDIME= 2 is a plane mesh", [&] { read_text(replaced(text, "NDIME= 3", "NDIME= 2")); });
  expect_error(ErrorCode::file_not_found, "no such file", [] { read(test::scratch() / "absent.su2"); });
  expect_error(ErrorCode::unsupported_format, "volume meshes are read from", [] { read("mesh.xyzzy"); });
}

TEST(Su2Read, TheFirstMistakeIsTold) {
  // The error of the first chunk of lines is reported for any number of threads.
  std::string text = "NDIME= 3\nNPOIN= 100000\n";
  for (int i = 0; i < 100000; ++i) text += i == 30000 || i == 70000 ? "0 x 0\n" : "0 0 0\n";
  text += "NELEM= 0\nNMARK= 0\n";
  const auto path = write_text("mesh.su2", text);
  for (const int threads : {1, 2, 7}) expect_error(ErrorCode::file_malformed, "line 30003", [&] { read_volume_file(path, RunContext({.threads = threads})); });
}

TEST(Su2Read, NeverCrashesOnCutFiles) {
  const std::string text = k_prism_and_tet;
  for (std::size_t n = 1; n < text.size(); ++n) {
    const auto path = write_text("mesh.su2", text.substr(0, n));
    try {
      read(path);
    } catch (const Error& error) {
      EXPECT_EQ(to_string(error.code()), "file_malformed");
    }
  }
}

TEST(Su2Read, Samples) {
  STERNA_NEEDS_SHARED_DATA();
  const auto samples = test::shared_data() / "formats";
  for (const char* name : {"pt.su2", "pt.legacyindex.su2"}) {
    const HybridMesh mesh = read(samples / name);
    expect_equal(mesh, prism_and_tet());
  }
  HybridMesh mesh = read(samples / "mix4.su2");
  EXPECT_EQ(count_cells(mesh).total(), 4);
  EXPECT_EQ(mesh.boundary_triangles.size(), 8u);
  EXPECT_EQ(mesh.boundary_quads.size(), 6u);
  EXPECT_NEAR(test::volume_of(mesh), 1.983333, 1e-6);  // value of docs/method/formats.md, "Sample meshes", to its digits
  EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-14);

  mesh = read(samples / "two.multizone.su2");
  EXPECT_EQ(mesh.points.size(), 19u);
  EXPECT_EQ(count_cells(mesh).total(), 6);
  EXPECT_EQ(mesh.patches.size(), 4u);  // wall and farfield are in both zones
  EXPECT_NEAR(test::volume_of(mesh), 1.983333 + 0.666667, 2e-6);

  mesh = read(samples / "mesh_brick_prism_ffd.su2");
  EXPECT_EQ(mesh.points.size(), 16800u);
  EXPECT_EQ(mesh.prisms.size(), 29640u);
  EXPECT_EQ(mesh.patches.size(), 6u);
  EXPECT_EQ(mesh.boundary_triangles.size() + mesh.boundary_quads.size(), 380u + 380u + 780u + 780u + 1482u + 1482u);
  EXPECT_NEAR(test::enclosed_volume(mesh), test::volume_of(mesh), 1e-12 * test::volume_of(mesh));  // rounding of 3e4 terms

  expect_error(ErrorCode::unsupported_format, "NDIME= 2", [&] { read(samples / "n0012_113-33.su2"); });
}

TEST(Su2Write, MeshioAgrees) {
  const auto path = test::scratch() / "mesh.su2";
  for (const HybridMesh& mesh :
       {prism_and_tet(), test::mixed_mesh(), test::hexahedron_with_roof(), test::sphere_shell(20, {.n_layers = 5, .collapsed = {3, 50, 51}})}) {
    write(mesh, path);
    const auto report = test::read_independently("meshio", path);
    STERNA_NEEDS(report, "the Python module of the independent reader");
    test::expect_same_mesh(*report, mesh);
  }
}

}  // namespace
}  // namespace sterna::io
