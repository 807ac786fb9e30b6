// Every option of a volume mesh has an effect in a suitable setting: on the mesh, or on the refused input. The options come from the option tables, so that a
// new option fails here until a setting is given for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>

#include "geom/base/error.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"
#include "tests/volmesh/domain/long_strips.h"
#include "tests/volmesh/domain/room.h"
#include "tests/volmesh/domain/sharp_wing.h"
#include "volmesh/envelope/initial.h"
#include "volmesh/envelope/untangle.h"
#include "volmesh/volume_mesh.h"

namespace sterna::volmesh {
namespace {

using test::k_context;

/// An L-shaped block of voxels with concave and convex edges, edge length 0.25 m.
TriMesh bent_block() {
  TriMesh mesh = test::voxel_boundary(
      {8, 4, 8}, 0.25, [](int i, int, int k) { return i < 4 || k < 4; },
      [](const Point&, const Vec3&) -> Patch {
        return {"body", PatchKind::wall};
      });
  for (TriangleVertices& v : mesh.triangles) std::swap(v[1], v[2]);  // the fluid is outside the block
  return mesh;
}

/// Two cubes closer to each other than their layer height.
TriMesh near_cubes() {
  TriMesh mesh = test::cube(4), other = test::cube(4);
  for (Point& p : other.points) p.x += 1.12;
  append(mesh, other);
  return mesh;
}

struct Setting {
  TriMesh wall;
  MeshCase mesh_case;
};

MeshCase few_layers() {
  MeshCase mesh_case = layers(6, 4e-3);
  mesh_case.farfield.farfield_radius = 8.0;
  return mesh_case;
}

/// Returns the setting with this name, in which some options have an effect.
Setting setting_of(const std::string& name) {
  Setting setting{bent_block(), few_layers()};
  if (name == "cubes") setting.wall = near_cubes();
  if (name == "strips") {
    setting.wall = long_strips(24, 6.0);
    setting.mesh_case.needles.needle_budget = 4.0;
  }
  if (name == "tetgen" || name == "hxt") setting.mesh_case.tetrahedra.engine = name;
  if (name == "height") setting.mesh_case.envelope.total_height = 0.03;
  if (name == "coarse") {
    setting.mesh_case.tetrahedra.engine = "tetgen";
    setting.mesh_case.size.size_growth = 2.0;
  }
  if (name == "flat") {  // cells near the wall are flat, and the smallest ratio that reaches the edges is below the largest
    setting.mesh_case = layers(16, 1e-5);
    setting.mesh_case.farfield.farfield_radius = 8.0;
    setting.mesh_case.envelope.max_growth = 2.0;
  }
  if (name == "graded") {  // edges of different length, and therefore different heights
    setting.wall = test::cube(8);
    for (Point& p : setting.wall.points) p.x *= p.x;
    setting.mesh_case.envelope.max_growth = 2.5;
    setting.mesh_case.envelope.max_thickness = 0.5;
  }
  if (name == "tall") {
    setting.mesh_case.envelope.first_height = 0.05;
    setting.mesh_case.envelope.max_thickness = 0.8;
  }
  if (name == "box" || name == "cylinder") {
    FarfieldOptions& far = setting.mesh_case.farfield;
    far.farfield_shape = name;
    if (name == "box") far.farfield_radius = FarfieldOptions().farfield_radius;  // a radius is an error for other shapes
    far.farfield_from_x = far.farfield_from_y = far.farfield_from_z = -5.0;
    far.farfield_to_x = far.farfield_to_y = far.farfield_to_z = 6.0;
    if (name == "cylinder") far.farfield_from_y = far.farfield_from_z = far.farfield_to_y = far.farfield_to_z = 0.5;
  }
  if (name == "wedge" || name == "fans") {
    setting.wall = sharp_wing(30.0, 8);
    if (name == "fans") setting.mesh_case.ridges.open_ridges = "always";
  }
  if (name == "room") {
    setting.mesh_case.farfield = {};
    setting.wall = room([](const std::string&) { return PatchKind::slip; }, [](int a, int, int c) { return a >= 8 && a < 14 && c >= 5 && c < 7; });
  }
  if (name == "surface") {
    TriMesh far = test::sphere(6, 7.0);
    for (Patch& patch : far.patches) patch = {"far", PatchKind::farfield};
    setting.mesh_case.farfield.farfield_shape = "surface";
    setting.mesh_case.farfield.farfield_surface = "far.stl";
    setting.mesh_case.farfield_surface = std::make_shared<const TriMesh>(std::move(far));
  }
  return setting;
}

/// Another value of an option, and the setting in which it has an effect.
struct Change {
  std::string value;
  std::string where = "block";
};

const std::map<std::string, Change> k_changes = {
    {"family.refinement", {"1.3"}},
    {"family.family_wake", {"on"}},
    {"needles.split_needles", {"0", "strips"}},
    {"needles.needle_budget", {"0.1", "strips"}},
    {"needles.flip_angle", {"0", "strips"}},
    {"ridges.open_ridges", {"always", "wedge"}},
    {"ridges.open_angle", {"1.0", "fans"}},
    {"ridges.fan_angle", {"1.0", "fans"}},
    {"envelope.layers", {"5"}},
    {"envelope.first_height", {"3e-3"}},
    {"envelope.max_growth", {"1.2"}},
    {"envelope.growth", {"local", "flat"}},
    {"envelope.total_height", {"0.05"}},
    {"envelope.solve_for", {"layers", "height"}},
    {"envelope.max_thickness", {"0.03"}},
    {"envelope.max_relative_height", {"0.1"}},
    {"envelope.feature_angle", {"2.0"}},
    {"envelope.height_gradient", {"0.05", "graded"}},
    {"envelope.height_sweeps", {"1", "graded"}},
    {"envelope.direction_sweeps", {"1"}},
    {"envelope.envelope_sweeps", {"1"}},
    {"envelope.height_floor", {"0.5", "graded"}},
    {"envelope.optimiser", {"none"}},
    {"envelope.optimiser_evaluations", {"1"}},
    {"envelope.height_weight", {"4"}},
    {"envelope.top_weight", {"3"}},
    {"envelope.membrane_weight", {"0"}},
    {"envelope.barrier_weight", {"0.5"}},
    {"prisms.wall_perpendicularity", {"0.4"}},
    {"prisms.truncate", {"always", "cubes"}},
    {"farfield.farfield_shape", {"cylinder"}},
    {"farfield.farfield_radius", {"9"}},
    {"farfield.farfield_edge", {"1.5"}},
    {"farfield.farfield_center_x", {"1.5"}},
    {"farfield.farfield_center_y", {"1.5"}},
    {"farfield.farfield_center_z", {"1.5"}},
    {"farfield.farfield_from_x", {"-6", "box"}},
    {"farfield.farfield_from_y", {"-6", "box"}},
    {"farfield.farfield_from_z", {"-6", "box"}},
    {"farfield.farfield_to_x", {"7", "box"}},
    {"farfield.farfield_to_y", {"7", "box"}},
    {"farfield.farfield_to_z", {"7", "box"}},
    {"farfield.farfield_sides", {"x_min=inflow", "box"}},
    {"ends.ends_growth", {"1.8", "room"}},
    {"ends.ends_max_triangles", {"10", "room"}},
    {"size.size_growth", {"1.8"}},
    {"size.size_max", {"0.8"}},
    {"tetrahedra.engine", {"tetgen"}},
    {"tetrahedra.radius_edge", {"2", "tetgen"}},
    {"tetrahedra.two_pass", {"true", "coarse"}},
    {"tetrahedra.hxt_improve_below", {"0.35", "hxt"}},
    {"tetrahedra.max_new_points", {"1"}},
    {"tetrahedra.helper_folder", {"/nowhere", "hxt"}},
    {"tetrahedra.boundary_splits", {"always", "tetgen"}},
    {"improve.improve_min_angle", {"0.5"}},
    {"improve.improve_max_angle", {"2.1"}},
    {"improve.improve_rounds", {"0"}},
    {"limits.max_memory", {"1e6"}},
};

/// Options whose effect shows only when something fails or takes too long: each has its own test.
const std::map<std::string, std::string> k_elsewhere = {
    {"ends.ends_min_angle", "plane_end_test: a goal that shows where loops leave room for it"},
    {"envelope.boundary_layer", "what gate G12 compares the layer with, the mesh stays: the last test below"},
    {"envelope.untangle_share", "heights grow back to the same limit after untangling, so it shows between the steps: the test below"},
    {"envelope.max_retract_sweeps", "a guard: from then on each sweep collapses a vertex; retraction ends long before on all surfaces of the tests"},
    {"improve.slide_share", "layer/slide_lines_test: shows where the layer's top has folds"},
    {"tetrahedra.memory_limit", "process_test: an engine that wants more memory"},
    {"tetrahedra.time_limit", "ladder_test: an engine without end"},
    {"tetrahedra.try_other_engine", "ladder_test: engines that fail"},
    {"tetrahedra.repair_boundary", "graceful_test and driver/ladder_test: boundaries that no engine fills"},
    {"tetrahedra.fall_back_on_limits", "ladder_test: limits"},
    {"limits.force", "forecast_test: a mesh that is too large"},
    {"farfield.farfield_floor", "floor_test: open sheets"},
    {"farfield.farfield_surface", "the file's name is for messages; continuation_test and farfield_test read it"},
};

/// The visible result of a run: nodes and cells, or the error.
struct Outcome {
  std::vector<Point> points;
  std::vector<std::array<NodeId, 4>> tetrahedra;
  std::vector<PatchKind> kinds;
  std::string error;
  bool operator==(const Outcome&) const = default;
};

Outcome outcome_of(const Setting& setting) {
  Outcome outcome;
  try {
    const VolumeMeshResult result = volume_mesh(setting.wall, setting.mesh_case, k_context);
    EXPECT_TRUE(result.check.is_valid());
    outcome.points = result.mesh.points.raw();
    outcome.tetrahedra = result.mesh.tetrahedra;
    for (const Patch& patch : result.mesh.patches) outcome.kinds.push_back(patch.kind);
  } catch (const Error& error) {
    outcome.error = error.what();
  }
  return outcome;
}

TEST(OptionEffects, EachOptionChangesTheMeshWhereItMatters) {
  std::map<std::string, Outcome> usual;  // by setting name
  MeshCase all;
  for (const Option& option : options_of(all)) {
    const std::string name = std::string(option.stage) + "." + std::string(option.name);
    if (k_elsewhere.contains(name)) continue;
    SCOPED_TRACE(name);
    const auto change = k_changes.find(name);
    if (change == k_changes.end()) {
      ADD_FAILURE() << "say where this option matters";
      continue;
    }
    const auto& [value, where] = change->second;
    Setting setting = setting_of(where);
    if (!usual.contains(where)) {
      usual[where] = outcome_of(setting);
      EXPECT_EQ(usual[where].error, "") << where;
    }
    const OptionTable table = options_of(setting.mesh_case);
    set_option_from_text(find_option(table, name, "changing"), value);
    EXPECT_FALSE(outcome_of(setting) == usual[where]) << name << " = " << value << " changes nothing";
  }
}

TEST(OptionEffects, UntanglingKeepsItsShareOfMeetingHeight) {
  Setting setting = setting_of("tall");
  std::vector<double> lowest;
  for (const double share : {0.3, 0.7}) {
    setting.mesh_case.envelope.untangle_share = share;
    const LayerBase base(setting.wall, k_context);
    Envelope envelope = initial_envelope(base, setting.mesh_case.envelope, k_context);
    untangle_edges(base, setting.mesh_case.envelope, envelope, k_context);
    lowest.push_back(*std::ranges::min_element(envelope.height));
  }
  EXPECT_LT(lowest[0], 0.6 * lowest[1]);
}

TEST(OptionEffects, GateG12ComparesWithRequestedBoundaryLayer) {
  const auto state = [](double boundary_layer, double total_height = k_automatic) {
    Setting setting = setting_of("block");
    setting.mesh_case.envelope.boundary_layer = boundary_layer;
    setting.mesh_case.envelope.total_height = total_height;
    return volume_mesh(setting.wall, setting.mesh_case, k_context).check.gate(Measure::boundary_layer).state;
  };
  EXPECT_EQ(state(k_automatic), GateState::not_checked);
  EXPECT_EQ(state(1e-3), GateState::pass);
  EXPECT_EQ(state(10.0), GateState::fail);
  EXPECT_EQ(state(k_automatic, 0.04), GateState::pass);
  EXPECT_EQ(state(10.0, 0.04), GateState::fail) << "what is asked for by name counts";
}

}  // namespace
}  // namespace sterna::volmesh
