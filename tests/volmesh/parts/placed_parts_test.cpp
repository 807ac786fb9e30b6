// Envelopes of parts that were made elsewhere and moved: the same at every attitude if nothing is near, lower and valid if an obstacle is near, for any number
// of threads.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tests/support/rooms.h"
#include "tests/support/test_shapes.h"
#include "volmesh/parts/part_envelope.h"
#include "volmesh/stages.h"

namespace sterna::volmesh {
namespace {

/// A room of 4 x 4 x 4 m about the origin whose walls are slip walls.
TriMesh room() {
  TriMesh mesh = test::cube_room(6);
  for (Point& p : mesh.points) p = 4.0 * p - Vec3{2, 2, 2};
  for (Patch& patch : mesh.patches) patch.kind = PatchKind::slip;
  return mesh;
}

/// A room with bodies, each a placed part.
struct Scene {
  TriMesh surface = room();
  std::vector<PlacedPart> parts;

  void add(const TriMesh& own, const Transform& placement) {
    PlacedPart part{std::make_shared<const TriMesh>(own), placement, static_cast<std::uint32_t>(surface.n_triangles()),
                    static_cast<std::uint32_t>(surface.n_vertices())};
    TriMesh moved = own;
    for (Point& p : moved.points) p = placement == Transform{} ? p : placement.point(p);
    append(surface, moved);
    parts.push_back(std::move(part));
  }
  MeshCase options() const {
    MeshCase options;
    options.envelope.layers = 10;
    options.envelope.first_height = 1e-3;  // 0.07 m in total with this growth
    options.envelope.max_growth = 1.4;
    options.envelope.max_thickness = 0.1;
    options.parts = parts;
    return options;
  }
};

TriMesh body() {
  TriMesh mesh = test::cube(6);
  for (Point& p : mesh.points) p = p - Vec3{0.5, 0.5, 0.5};
  return mesh;
}

Scene body_at(const Transform& placement) {
  Scene scene;
  scene.add(body(), placement);
  return scene;
}

/// Returns the envelope of the only part alone, as the driver requests it.
PartEnvelope alone(const Scene& scene, PartEnvelopeTask& task) {
  const MeshCase options = scene.options();
  PartEnvelope made;
  int n_calls = 0;
  Makers makers;
  makers.part_envelope = [&](const PartEnvelopeTask& requested, const RunContext& context) {
    ++n_calls;
    task = requested;
    made = part_envelope(requested, context);
    return made;
  };
  make_envelope(scene.surface, options, makers, RunContext({.threads = 2}));
  EXPECT_EQ(n_calls, 1);
  return made;
}

const Transform k_pitch = rotation({0.1, 0, 0}, {0, 1, 0}, 0.3);
const Transform k_yaw = translation({0.2, -0.1, 0.3}) * rotation({0, 0, 0}, {0, 0.2, 1}, -0.5);

TEST(PlacedParts, PartEnvelopeIsEqualAtEveryAttitude) {
  PartEnvelopeTask first, second;
  const PartEnvelope one = alone(body_at(k_pitch), first), other = alone(body_at(k_yaw), second);
  EXPECT_EQ(first.wall.points.raw(), second.wall.points.raw());
  EXPECT_EQ(first.wall.points.raw(), body().points.raw());
  EXPECT_EQ(one.envelope.height.raw(), other.envelope.height.raw());
  for (const Transform& placement : {Transform{}, k_pitch, k_yaw}) {
    const Scene scene = body_at(placement);
    const EnvelopeStage stage = make_envelope(scene.surface, scene.options(), {}, RunContext({.threads = 2}));
    EXPECT_EQ(stage.envelope.height.raw(), one.envelope.height.raw());  // the only wall with layers, and nothing is near
    for (const VertexId v : stage.envelope.direction.ids()) {
      const Vec3 moved = placement == Transform{} ? one.envelope.direction[v] : placement.vector(one.envelope.direction[v]);
      ASSERT_EQ(stage.envelope.direction[v], moved);
    }
  }
}

TEST(PlacedParts, MeshesAreValidAtEveryAttitude) {
  for (const Transform& placement : {Transform{}, k_pitch, k_yaw}) {
    const Scene scene = body_at(placement);
    const VolumeMeshResult result = volume_mesh(scene.surface, scene.options(), RunContext({.threads = 2}));
    EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
    EXPECT_GT(result.layer.coverage, 0.99);
  }
}

double least_height(const EnvelopeStage& stage) { return *std::min_element(stage.envelope.height.begin(), stage.envelope.height.end()); }

TEST(PlacedParts, LayersNearTunnelWallAreLowerAndValid) {
  // Turned by 45 degrees, its lower edge 0.03 m above the floor; the layer height is 0.07 m.
  const Transform near = translation({0, 0, -2.0 + std::sqrt(0.5) + 0.03}) * rotation({}, {1, 0, 0}, std::atan(1.0));
  const Scene far = body_at(k_pitch), scene = body_at(near);
  const RunContext context({.threads = 2});
  EXPECT_LT(least_height(make_envelope(scene.surface, scene.options(), {}, context)),
            0.5 * least_height(make_envelope(far.surface, far.options(), {}, context)));
  const VolumeMeshResult result = volume_mesh(scene.surface, scene.options(), context);
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
}

TEST(PlacedParts, PartsNearEachOtherShareTheGap) {
  Scene scene;
  scene.add(body(), translation({-0.55, 0, 0}));
  scene.add(body(), translation({0.55, 0.1, 0.1}) * rotation({}, {0, 0, 1}, std::atan(1.0) * 4.0));  // 0.1 m apart
  MeshCase options = scene.options();
  options.envelope.growth = "local";  // its target heights share the gap as tested here; uniform growth requests slightly lower heights
  const EnvelopeStage stage = make_envelope(scene.surface, options, {}, RunContext({.threads = 2}));
  EXPECT_LT(least_height(stage), 0.06);
  EXPECT_GT(least_height(stage), 0.02);
  const VolumeMeshResult result = volume_mesh(scene.surface, scene.options(), RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_TRUE(result.layer.collapsed.empty());
}

TEST(PlacedParts, WallsAroundThemHaveLayersToo) {
  Scene scene = body_at(k_pitch);
  for (const PatchId p : scene.surface.patches.ids())
    if (scene.surface.patches[p].name == "z0") scene.surface.patches[p].kind = PatchKind::wall;
  const VolumeMeshResult result = volume_mesh(scene.surface, scene.options(), RunContext({.threads = 2}));
  EXPECT_TRUE(result.check.is_valid()) << to_text(result.check);
  EXPECT_GT(result.layer.coverage, 0.9);
}

/// Returns a rule for the floor of the room that sets the given layer option, in which the option has a visible effect.
Rule floor_rule(const std::string& option) {
  const std::map<std::string, OptionValue> values = {
      {"layers", 7}, {"first_height", 2e-3}, {"max_growth", 1.15}, {"total_height", 0.09}, {"max_thickness", 0.04}};
  return {.names = "z0", .options = {{option, values.at(option)}}};
}

TEST(PlacedParts, RequestsOfSurroundingWallsApplyAsWithoutParts) {
  for (const std::string column : {"layers", "first_height", "max_growth", "total_height", "max_thickness"}) {
    Scene scene = body_at(k_pitch);
    std::uint32_t n_floor = 0;
    for (const PatchId p : scene.surface.patches.ids())
      if (scene.surface.patches[p].name == "z0") scene.surface.patches[p].kind = PatchKind::wall;
    MeshCase with_parts = scene.options(), without = with_parts;
    with_parts.patches = without.patches = {floor_rule(column)};
    without.parts.clear();
    const RunContext context({.threads = 2});
    const EnvelopeStage parts = make_envelope(scene.surface, with_parts, {}, context), whole = make_envelope(scene.surface, without, {}, context);
    const EnvelopeStage plain = make_envelope(scene.surface, scene.options(), {}, context);
    ASSERT_EQ(parts.envelope.target.size(), whole.envelope.target.size());
    bool has_effect = column == "layers";  // layers also changes the body, since each wall follows the settings of its own patches
    for (const VertexId v : parts.envelope.target.ids()) {
      if (v.index() >= parts.envelope.target.size() - scene.parts.front().own->n_vertices()) break;  // the body has a separate frame
      ++n_floor;
      EXPECT_EQ(parts.envelope.target[v], whole.envelope.target[v]) << column << " at vertex " << v.value();
      EXPECT_EQ(parts.envelope.eq1[v], whole.envelope.eq1[v]) << column << " at vertex " << v.value();
      has_effect |= parts.envelope.target[v] != plain.envelope.target[v];
    }
    EXPECT_GT(n_floor, 0u);
    EXPECT_TRUE(has_effect) << column;
  }
}

TEST(PlacedParts, ThreadsDoNotMatter) {
  Scene scene = body_at(translation({0, 0, -2.0 + 0.5 + 0.06}) * rotation({}, {1, 0, 0}, 0.02));
  scene.add(test::sphere(6, 0.3), translation({0, 0, 0.5}) * k_pitch);
  const EnvelopeStage one = make_envelope(scene.surface, scene.options(), {}, RunContext({.threads = 1}));
  for (const int threads : {2, 7}) {
    const EnvelopeStage many = make_envelope(scene.surface, scene.options(), {}, RunContext({.threads = threads}));
    EXPECT_EQ(one.envelope.height.raw(), many.envelope.height.raw());
    EXPECT_EQ(one.envelope.direction.raw(), many.envelope.direction.raw());
  }
}

TEST(PlacedParts, MisplacedPartIsMeshedInPlace) {
  Scene scene = body_at(k_pitch);
  scene.surface.points[VertexId(scene.parts.front().first_vertex)].x += 1e-9;
  const MeshCase options = scene.options();
  bool is_called = false;
  Makers makers;
  makers.part_envelope = [&](const PartEnvelopeTask& requested, const RunContext& context) {
    is_called = true;
    return part_envelope(requested, context);
  };
  make_envelope(scene.surface, options, makers, RunContext({.threads = 2}));
  EXPECT_FALSE(is_called);
}

}  // namespace
}  // namespace sterna::volmesh
