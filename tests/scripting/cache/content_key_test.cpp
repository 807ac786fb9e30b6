// Every option is in the key of its own stage, and in the key of no earlier stage.
#include "scripting/values/value_keys.h"

#include <gtest/gtest.h>

#include <set>

#include "scripting/lua/component_value.h"
#include "scripting/values/models.h"
#include "scripting/values/patch_rules.h"
#include "scripting/values/stored_stages.h"
#include "scripting/values/verbs.h"
#include "tests/support/test_shapes.h"
#include "volmesh/case/layer_rules.h"

namespace sterna::scripting {
namespace {

/// Changes the option to another value, valid or not.
void change(const Option& option) {
  const OptionValue value = option.get();
  if (const auto* flag = std::get_if<bool>(&value)) option.store(!*flag);
  else if (const auto* whole = std::get_if<std::int64_t>(&value)) option.store(*whole + 1);
  else if (const auto* number = std::get_if<double>(&value)) option.store(is_automatic(*number) ? 0.125 : std::nextafter(*number, 1e300));
  else if (option.name == "farfield_sides") option.store("x_min=slip");
  else if (option.name == "periodic") option.store("left,right");
  else option.store(std::get<std::string>(value) + "x");
}

TEST(ContentKeys, VolumeMeshOptionsEnterTheirKeys) {
  volmesh::MeshCase defaults;
  const ContentKey volume = volume_options_key(defaults), envelope = envelope_options_key(defaults);
  std::set<ContentKey> seen = {volume};
  const std::size_t n_options = volmesh::options_of(defaults).size();
  ASSERT_GT(n_options, 40u);
  for (std::size_t i = 0; i < n_options; ++i) {
    volmesh::MeshCase options;
    const OptionTable table = volmesh::options_of(options);
    change(table[i]);
    EXPECT_TRUE(seen.insert(volume_options_key(options)).second) << table[i].stage << "." << table[i].name;
    const bool is_of_envelope =
        table[i].stage == "family" || table[i].stage == "needles" || table[i].stage == "envelope" || table[i].stage == "farfield" || table[i].stage == "ridges";
    EXPECT_EQ(envelope_options_key(options) != envelope, is_of_envelope) << table[i].stage << "." << table[i].name;
  }
}

TEST(ContentKeys, NonNumericVolumeMeshInputsEnterKey) {
  const volmesh::MeshCase defaults;
  std::set<ContentKey> volume = {volume_options_key(defaults)}, envelope = {envelope_options_key(defaults)};
  const auto expect = [&](const volmesh::MeshCase& options, bool is_of_envelope, const char* what) {
    EXPECT_TRUE(volume.insert(volume_options_key(options)).second) << what;
    EXPECT_EQ(envelope.insert(envelope_options_key(options)).second, is_of_envelope) << what;
  };
  Rule rule_defaults;
  for (std::size_t i = 0; i < volmesh::layer_rule_options(rule_defaults).size(); ++i) {
    volmesh::MeshCase options;
    options.patches.resize(1);
    const Option option = volmesh::layer_rule_options(options.patches.front())[i];
    change(option);
    expect(options, true, "rule of a patch");
  }
  volmesh::MeshCase options;
  options.sources = {{.kind = volmesh::SourceKind::sphere, .radius = 1.0, .size = 0.1}};
  expect(options, false, "source");
  options.sources.front().size = 0.2;
  expect(options, false, "size of a source");
  options.sources.front() = {.kind = volmesh::SourceKind::samples, .points = {{0, 0, 0}}, .sizes = {0.1}};
  expect(options, false, "samples");
  options.sources.front().sizes = {0.2};
  expect(options, false, "size of a sample");
  options = {};
  options.discs = {{.name = "a", .radius = 1.0}};
  expect(options, true, "disc");
  options.discs.front().radius = 2.0;
  expect(options, true, "radius of a disc");
  options.size.size_growth += 0.01;  // determines the triangles of a disc
  expect(options, true, "growth beside a disc");
  options.wakes = {{.wing = "main"}};
  expect(options, true, "wake sheet");
  options.wakes.front().length = 3.0;
  expect(options, true, "length of a wake sheet");
  options.wakes.front().height_growth = 1.1;
  expect(options, true, "growth of heights on a wake sheet");
  options = {};
  options.smooth_angle = 0.2;
  expect(options, true, "smooth angle");
  options = {};
  auto farfield = std::make_shared<TriMesh>(test::sphere(1, 10.0));
  options.farfield_surface = farfield;
  expect(options, true, "farfield's surface");
  farfield->points[VertexId(0)].x += 1e-12;
  expect(options, true, "a point of it");
}

TEST(ContentKeys, SurfaceMeshOptionsEnterTheirKey) {
  SurfaceRecipe defaults;
  std::set<ContentKey> seen = {key_of(defaults)};
  for (std::size_t i = 0; i < sterna::options_of(defaults.options).size(); ++i) {
    SurfaceRecipe recipe;
    const Option option = sterna::options_of(recipe.options)[i];
    change(option);
    EXPECT_TRUE(seen.insert(key_of(recipe)).second) << option.name;
  }
  Rule none;
  for (const Option& option : size_rule_options(none)) {
    SurfaceRecipe recipe;
    recipe.patches = {{.names = "wing*", .options = {{std::string(option.name), 0.5}}}};
    EXPECT_TRUE(seen.insert(key_of(recipe)).second) << option.name;
  }
  SurfaceRecipe recipe;
  recipe.sources = {{.kind = volmesh::SourceKind::point, .size = 0.1}};
  EXPECT_TRUE(seen.insert(key_of(recipe)).second);
}

TEST(ContentKeys, SurfaceKeyHasMeshAndManifestData) {
  SurfaceValue surface;
  surface.mesh = test::sphere(1);
  const auto first = key_of(surface);
  ASSERT_TRUE(first);
  std::set<ContentKey> seen = {*first};
  const auto expect_other = [&](SurfaceValue other, const char* what) { EXPECT_TRUE(seen.insert(*key_of(other)).second) << what; };
  EXPECT_EQ(*key_of(SurfaceValue(surface)), *first);
  SurfaceValue other = surface;
  other.mesh.points[VertexId(3)].z = std::nextafter(other.mesh.points[VertexId(3)].z, 10.0);
  expect_other(other, "a point");
  other = surface;
  std::swap(other.mesh.triangles[TriangleId(0)], other.mesh.triangles[TriangleId(1)]);
  expect_other(other, "order of triangles");
  other = surface;
  other.mesh.patches[PatchId(0)].name += "x";
  expect_other(other, "name of a patch");
  other = surface;
  other.mesh.patches[PatchId(0)].kind = PatchKind::slip;
  expect_other(other, "kind of a patch");
  other = surface;
  other.layers = {{.names = "a"}};
  expect_other(other, "rules of layers");
  other = surface;
  other.smooth_angle = 0.1;
  expect_other(other, "smooth angle");
  other = surface;
  other.history = {{.options = SurfaceRecipe{}}};
  expect_other(other, "recipe");
  other.history = {{.options = UnionOptions{}}};
  expect_other(other, "union");
  other.history = {{.options = surfmesh::RepairOptions{}}};
  expect_other(other, "repair");
  other.history.push_back({.options = surfmesh::WrapOptions{}});
  expect_other(other, "wrap");
  other.history = {{.changes = {"repaired"}}};
  expect_other(other, "change");
  other.history = {{.figures = "{}"}};
  expect_other(other, "figures");
  other = surface;
  other.inputs = {{"a.stl", "0123"}};
  expect_other(other, "an input");
  other = surface;
  other.options.unit = 0.001;
  expect_other(other, "unit");
}

TEST(ContentKeys, ComponentKeysIgnoreTheirHistory) {
  ComponentValue component;
  Wing wing{.name = "wing"};
  wing.sections.resize(2);
  component.shape = wing;
  const ContentKey before = key_of(component);
  component.placement().origin.x = 1.0;
  EXPECT_NE(key_of(component), before);
  component.placement().origin.x = 0.0;
  EXPECT_EQ(key_of(component), before);
  std::get<Wing>(component.shape).sections[1].chord = 2.0;
  EXPECT_NE(key_of(component), before);
  std::get<Wing>(component.shape).sections[1].chord = 1.0;
  component.deflections.resize(1);
  EXPECT_NE(key_of(component), before);
}

TEST(ContentKeys, ModelCopyHasNoKeyUntilSet) {
  ModelValue model;
  EXPECT_FALSE(model.provenance.key());
  model.provenance = ContentKey{};
  ModelValue copy = model;
  EXPECT_FALSE(copy.provenance.key());
  const ModelValue moved = std::move(model);
  EXPECT_TRUE(moved.provenance.key());
}

}  // namespace
}  // namespace sterna::scripting
