// Wakes of bodies: which settings refine them, also in members of a mesh family.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "volmesh/case/body_wake.h"
#include "volmesh/case/layer_choice.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

MeshCase member(double refinement, const std::string& family_wake = "automatic") {
  MeshCase mesh_case;
  mesh_case.family = {refinement, family_wake};
  mesh_case.envelope.layers = 6;
  mesh_case.envelope.first_height = 4e-3;
  mesh_case.farfield.farfield_radius = 8.0;
  return mesh_case;
}

MeshCase with_rule(MeshCase mesh_case, const std::string& kind) {
  mesh_case.patches = {{.names = "*", .options = {{"kind", kind}}}};
  return mesh_case;
}

std::vector<SizeSource> sources_of(const TriMesh& wall, const MeshCase& mesh_case) { return with_family_wake(wall, mesh_case, test::k_context).sources; }

TEST(FamilyWake, IsWallWakeWithoutOtherRefinement) {
  const TriMesh cube = test::cube(4);
  EXPECT_THAT(sources_of(cube, member(1.0)), testing::IsEmpty());
  EXPECT_THAT(sources_of(cube, member(1.5, "off")), testing::IsEmpty());
  for (const MeshCase& mesh_case : {member(1.5), member(0.7), member(1.0, "on")}) {
    const std::vector<SizeSource> sources = sources_of(cube, mesh_case);
    ASSERT_EQ(sources.size(), 1U);
    const SizeSource expected = wake_behind(cube, {});
    EXPECT_EQ(sources.front().size, expected.size);
    EXPECT_EQ(sources.front().length, expected.length);
    EXPECT_EQ(refined(with_family_wake(cube, mesh_case, test::k_context)).sources.front().size, expected.size / mesh_case.family.refinement);
    EXPECT_FALSE(has_bare_wake(cube, mesh_case));
  }
  EXPECT_TRUE(has_bare_wake(cube, member(1.0)));
  EXPECT_TRUE(has_bare_wake(cube, member(1.5, "off")));
}

TEST(FamilyWake, IsOmittedWithSourcesOrInternalFlow) {
  const TriMesh cube = test::cube(4);
  MeshCase own = member(1.5);
  own.sources = {{.kind = SourceKind::sphere, .radius = 1.0, .size = 0.1}};
  EXPECT_EQ(sources_of(cube, own).size(), 1U);
  EXPECT_EQ(sources_of(cube, own).front().size, 0.1);
  MeshCase sheets = member(1.5);
  sheets.wakes = {WakeSheet{}};
  EXPECT_THAT(sources_of(cube, sheets), testing::IsEmpty());
  for (const char* kind : {"inflow", "outflow", "farfield", "slip"}) EXPECT_THAT(sources_of(cube, with_rule(member(1.5), kind)), testing::IsEmpty()) << kind;
  EXPECT_EQ(sources_of(cube, with_rule(member(1.5), "wall")).size(), 1U);
  for (const char* shape : {"none", "surface"}) {
    MeshCase inside = member(1.5);
    inside.farfield.farfield_shape = shape;
    EXPECT_THAT(sources_of(cube, inside), testing::IsEmpty()) << shape;
  }
}

TEST(FamilyWake, PutsTetrahedraBehindTheBody) {
  const TriMesh cube = test::cube(4);
  const auto tetrahedra_behind = [&](const MeshCase& mesh_case) {
    const HybridMesh mesh = volume_mesh(cube, mesh_case, test::k_context).mesh;
    std::size_t n = 0;
    for (const std::array<NodeId, 4>& tetrahedron : mesh.tetrahedra) {
      const Point& p = mesh.points[tetrahedron[0]];
      n += p.x > 1.2 && p.x < 3.0 && p.y > 0.0 && p.y < 1.0 && p.z > 0.0 && p.z < 1.0 ? 1 : 0;
    }
    return n;
  };
  EXPECT_GT(tetrahedra_behind(member(1.0, "on")), 3 * tetrahedra_behind(member(1.0, "off")));
}

}  // namespace
}  // namespace sterna::volmesh
