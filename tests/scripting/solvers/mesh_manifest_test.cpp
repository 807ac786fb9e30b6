// Kinds of patches of a mesh file: what its format does not hold stands in the manifest beside it, which every command reads where it fits.
#include <gmock/gmock.h>

#include "io/file/format_table.h"
#include "io/volume/volume_su2.h"
#include "scripting/terminal/exit_status.h"
#include "scripting/values/manifest.h"
#include "scripting/values/verbs.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Hexahedra in the unit cube, each side a patch: a duct along x, periodic in y, a slip side below, a wall above.
MeshValue duct() {
  HybridMesh mesh = test::hexahedra_block(2);
  mesh.patches = {};
  for (const auto& [name, kind] : {std::pair("in let", PatchKind::inflow),
                                   {"outlet", PatchKind::outflow},
                                   {"left", PatchKind::slip},
                                   {"right", PatchKind::slip},
                                   {"floor", PatchKind::slip},
                                   {"7", PatchKind::wall}})
    mesh.patches.push_back({.name = name, .kind = kind});
  for (BoundaryQuad& face : mesh.boundary_quads) {
    Point middle{};
    for (const NodeId node : face.nodes) middle = middle + 0.25 * mesh.points[node];
    for (std::size_t k = 0; k < 3; ++k)
      for (const int end : {0, 1})
        if (middle[k] == static_cast<double>(end)) face.patch = PatchId(2 * k + static_cast<std::size_t>(end));
  }
  mesh.periodic = {{PatchId(2), PatchId(3), {0.0, 1.0, 0.0}}};
  return {.mesh = std::move(mesh)};
}

class MeshManifest : public ScriptFixture {
 protected:
  test::ProcessResult sterna(const std::vector<std::string>& arguments) const { return test::run_process(test::sterna_program(), arguments, folder_); }
  void write(const std::string& name) const { write_mesh(duct(), folder_ / name, {}, RunContext()); }
  std::vector<std::string> config(const std::string& mesh, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"su2-config", mesh, "-o", "a.cfg", "--flow", "speed=20 temperature=293 pressure=1e5 length=0.2", "--reference-area", "1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::string line_of(const std::string& file, const std::string& key) const {
    const std::string text = text_of(file);
    const std::size_t at = text.find("\n" + key + "=");
    return at == std::string::npos ? "absent" : text.substr(at + 1, text.find('\n', at + 1) - at - 1);
  }
};

std::map<std::string, PatchKind> kinds_of(const HybridMesh& mesh) {
  std::map<std::string, PatchKind> kinds;
  for (const Patch& patch : mesh.patches) kinds[patch.name.starts_with("in") ? "inlet" : patch.name.ends_with("7") ? "wall" : patch.name] = patch.kind;
  return kinds;
}

TEST_F(MeshManifest, BringsKindsBackFromEveryFormat) {
  const auto expected = kinds_of(duct().mesh);
  int n = 0;
  for (const io::Format& format : io::formats()) {
    if (!format.write_volume || !format.read_volume) continue;
    const std::string extension(format.extensions.substr(0, format.extensions.find(' ')));
    const std::filesystem::path path = folder_ / ("duct" + std::to_string(n) + (format.name == "Fluent" ? ".fluent.msh" : extension));
    SCOPED_TRACE(std::string(format.name));
    write_mesh(duct(), path, {}, RunContext());
    const MeshValue read = read_mesh({path.string(), path}, RunContext());
    auto kinds = kinds_of(read.mesh);
    if (format.name == "OpenFOAM")
      for (const char* side : {"left", "right"}) kinds[side] = expected.at(side);  // cyclic there
    EXPECT_EQ(kinds, expected);
    EXPECT_EQ(read.mesh.periodic.size(), 1u);
    EXPECT_TRUE(read.unknown_kinds.empty());
    ++n;
  }
  EXPECT_GE(n, 10);
}

TEST_F(MeshManifest, IsWhatConfigurationsAreMadeOf) {
  write("duct.su2");
  const test::ProcessResult made = sterna(config("duct.su2"));
  ASSERT_EQ(made.status, k_exit_success) << made.errors;
  EXPECT_THAT(line_of("a.cfg", "MARKER_INLET"), HasSubstr("( in_let,"));
  EXPECT_THAT(line_of("a.cfg", "MARKER_OUTLET"), HasSubstr("( outlet, 100000 )"));
  EXPECT_THAT(line_of("a.cfg", "MARKER_EULER"), HasSubstr("floor"));
  EXPECT_THAT(line_of("a.cfg", "MARKER_PERIODIC"), HasSubstr("( left, right, 0, 0, 0, 0, 0, 0, 0, 1, 0 )"));
  const test::ProcessResult info = sterna({"info", "duct.su2"});
  EXPECT_THAT(info.output, AllOf(HasSubstr("\"in_let\", inflow"), HasSubstr("\"floor\", slip")));
  EXPECT_THAT(sterna({"info", "duct.su2", "--json"}).output, HasSubstr("\"kind\": \"inflow\""));
  ASSERT_EQ(sterna({"convert", "duct.su2", "copy.msh"}).status, k_exit_success);
  EXPECT_THAT(sterna({"info", "copy.msh"}).output, AllOf(HasSubstr("\"in_let\", inflow"), HasSubstr("\"floor\", slip")));
  EXPECT_EQ(sterna({"foam-case", "copy.msh", "-o", "case", "--flow", "speed=20 temperature=293 pressure=1e5 length=0.2"}).status, k_exit_success);
  EXPECT_THAT(text_of("case/0/U"), HasSubstr("inletOutlet"));
}

TEST_F(MeshManifest, MissingOrStaleManifestMakesKindsUnknown) {
  write("duct.su2");
  std::filesystem::remove(folder_ / "duct.su2.json");
  for (const bool is_stale : {false, true}) {
    SCOPED_TRACE(is_stale);
    if (is_stale) {
      write("duct.su2");
      std::ofstream(folder_ / "duct.su2", std::ios::app) << "% edited\n";
    }
    const test::ProcessResult refused = sterna(config("duct.su2"));
    EXPECT_EQ(refused.status, k_exit_usage);
    EXPECT_THAT(refused.errors,
                AllOf(HasSubstr("\"in_let\""), HasSubstr("\"floor\""), HasSubstr("--kind"), HasSubstr(is_stale ? "another version" : "no manifest")));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.cfg"));
    EXPECT_EQ(sterna({"foam-case", "duct.su2", "-o", "case", "--flow", "speed=20 temperature=293 pressure=1e5 length=0.2"}).status, k_exit_usage);
    EXPECT_THAT(sterna({"info", "duct.su2"}).output, HasSubstr("\"in_let\", kind unknown"));
    EXPECT_THAT(sterna({"check", "duct.su2"}).errors, AllOf(HasSubstr("is unknown"), HasSubstr("\"floor\"")));
    const test::ProcessResult given = sterna(config("duct.su2", {"--kind", "in*=inflow", "--kind", "outlet=outflow", "--kind", "*=wall"}));
    EXPECT_EQ(given.status, k_exit_success) << given.errors;
    EXPECT_THAT(line_of("a.cfg", "MARKER_INLET"), HasSubstr("in_let"));
    std::filesystem::remove(folder_ / "a.cfg");
  }
  EXPECT_THAT(error("read_mesh(" + out("duct.su2") + "):su2_config{ " + out("b.cfg") + ", mach = 0.3, altitude = 0, length = 1, reference_area = 1 }"),
              HasSubstr("kinds = {"));
}

TEST_F(MeshManifest, OfSomebodyElseIsLeftAlone) {
  write("duct.cgns");
  std::ofstream(folder_ / "duct.cgns.json") << "{\"mine\": 1}";
  EXPECT_THAT(sterna({"info", "duct.cgns"}).errors, Not(HasSubstr("another version")));
  EXPECT_THAT(sterna({"info", "duct.cgns"}).output, HasSubstr("\"in let\", inflow"));
}

/// Surfaces: what a wall knows goes along when it is cut, converted or joined.
TEST_F(MeshManifest, OfSurfacesGoesAlong) {
  run("surface_mesh{ box{ {0,0,0}, {1,1,1} }, max_edge = 0.5, patches = { ['*'] = { kind = 'slip' } } }:write(" + out("box.su2") + ")");
  ASSERT_TRUE(std::filesystem::exists(folder_ / "box.su2.json"));
  ASSERT_EQ(sterna({"convert", "box.su2", "box.obj"}).status, k_exit_success);
  EXPECT_THAT(sterna({"info", "box.obj"}).output, HasSubstr(", slip"));
  const test::ProcessResult half = sterna({"half", "box.obj", "-o", "half.obj", "--at", "0.5"});
  ASSERT_EQ(half.status, k_exit_success) << half.errors;
  EXPECT_THAT(sterna({"info", "half.obj"}).output, HasSubstr(", slip"));
  std::ofstream(folder_ / "box.obj", std::ios::app) << "# edited\n";
  EXPECT_THAT(sterna({"info", "box.obj"}).errors, HasSubstr("another version"));
}

}  // namespace
}  // namespace sterna::scripting
