// Requests in patch rules that have no effect: each kind is an error or a warning with the name of the rule.
#include "volmesh/case/ignored_requests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "geom/base/error.h"
#include "tests/support/test_shapes.h"

namespace sterna::volmesh {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// Result of rules for a model with a wall "wing" that has layers, a wall "body" that has none, a slip wall "floor" and a farfield.
struct Outcome {
  std::string error, log;
};

Outcome outcome_of(const std::vector<Rule>& rules, const EnvelopeOptions& all = {}) {
  const Column<PatchId, Patch> patches{{"wing", PatchKind::wall}, {"body", PatchKind::wall}, {"floor", PatchKind::slip}, {"farfield", PatchKind::farfield}};
  const Column<PatchId, std::uint8_t> has_layer{std::uint8_t{1}, std::uint8_t{0}, std::uint8_t{0}, std::uint8_t{0}};
  MeshCase options;
  options.envelope = all;
  options.patches = rules;
  Outcome outcome;
  const RunContext context({.threads = 1, .log = [&](LogLevel, std::string_view line) { outcome.log += std::string(line) + "\n"; }});
  try {
    require_used_requests(patches, has_layer, options, context);
  } catch (const Error& error) {
    outcome.error = error.what();
  }
  return outcome;
}

TEST(IgnoredRequests, EachIneffectiveRequestIsAnErrorWithName) {
  struct Case {
    Rule rule;
    std::string request, patch, remedy;
  };
  const std::string wall = "kind = \"wall\"", layers = "layers = 1 or more";
  const std::vector<Case> cases = {
      {{.names = "farfield", .options = {{"layers", 10}}}, "layers = 10", "\"farfield\" (of kind farfield)", wall},
      {{.names = "floor", .options = {{"first_height", 1e-3}}}, "first_height = 0.001", "\"floor\" (of kind slip)", wall},
      {{.names = "f*", .options = {{"max_growth", 1.2}}}, "max_growth = 1.2", "\"floor\" (of kind slip), \"farfield\" (of kind farfield)", wall},
      {{.names = "floor", .options = {{"total_height", 0.1}}}, "total_height = 0.1", "\"floor\"", wall},
      {{.names = "floor", .options = {{"max_thickness", 0.1}}}, "max_thickness = 0.1", "\"floor\"", wall},
      {{.names = "floor", .options = {{"blend", 0.1}}}, "blend = 0.1", "\"floor\"", wall},
      {{.names = "floor", .options = {{"open_ridges", "always"}}}, "open_ridges = \"always\"", "\"floor\"", wall},
      {{.names = "floor", .options = {{"truncate", "auto"}}}, "truncate = \"auto\"", "\"floor\"", wall},
      {{.names = "body", .options = {{"layers", 0}, {"total_height", 0.1}}}, "total_height = 0.1", "\"body\" (no layers are requested there)", layers},
      {{.names = "body", .options = {{"first_height", 1e-3}}}, "first_height = 0.001", "\"body\"", layers},
      {{.names = "floor", .options = {{"kind", "slip"}, {"layers", 4}}}, "layers = 4", "\"floor\"", wall},
  };
  for (const Case& c : cases)
    EXPECT_THAT(outcome_of({c.rule}).error,
                AllOf(HasSubstr("patches[\"" + c.rule.names + "\"] requests " + c.request), HasSubstr(c.patch), HasSubstr(c.remedy)))
        << c.request;
}

TEST(IgnoredRequests, AllAreNamedTogether) {
  EXPECT_THAT(outcome_of({{.names = "farfield", .options = {{"layers", 10}}}, {.names = "floor", .options = {{"first_height", 1e-3}}}}).error,
              AllOf(HasSubstr("patches[\"farfield\"]"), HasSubstr("patches[\"floor\"]")));
}

TEST(IgnoredRequests, WhatHasAnEffectOrIsReplacedPasses) {
  const std::vector<std::vector<Rule>> cases = {
      {{.names = "*", .options = {{"layers", 10}}}},                                                            // affects the wing
      {{.names = "floor", .options = {{"layers", 0}}}},                                                         // equals the present state
      {{.names = "floor", .options = {{"kind", "slip"}}}},                                                      // equals the present state
      {{.names = "floor", .options = {{"layers", 10}}}, {.names = "floor", .options = {{"kind", "slip"}}}},     // replaced on purpose
      {{.names = "body", .options = {{"first_height", 1e-3}}}, {.names = "body", .options = {{"layers", 0}}}},  // replaced on purpose
      {{.names = "floor", .options = {{"open_ridges", "never"}}}, {.names = "body", .options = {{"truncate", "never"}}}},
  };
  for (const std::vector<Rule>& rules : cases) {
    const Outcome outcome = outcome_of(rules);
    EXPECT_THAT(outcome.error, IsEmpty()) << rules.front().names;
    EXPECT_THAT(outcome.log, IsEmpty());
  }
}

TEST(IgnoredRequests, UnusedOptionsOfAllWallsAreWarnings) {
  EnvelopeOptions all;
  all.first_height = 1e-3;
  EXPECT_THAT(outcome_of({{.names = "wing", .options = {{"first_height", 1e-4}}}}, all).log, HasSubstr("first_height = 0.001 of all walls has no effect"));
  EXPECT_THAT(outcome_of({{.names = "wing", .options = {{"layers", 5}}}}, all).log, IsEmpty());
}

std::string error_of_farfield(const FarfieldOptions& options) {
  try {
    require_used_farfield(options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(IgnoredRequests, FarfieldOptionsBelongToTheShape) {
  EXPECT_THAT(error_of_farfield({.farfield_shape = "box", .farfield_radius = 50}),
              AllOf(HasSubstr("the shape \"box\" does not have farfield_radius = 50"), HasSubstr("sphere, cylinder")));
  EXPECT_THAT(error_of_farfield({.farfield_shape = "sphere", .farfield_from_x = -3}), HasSubstr("farfield_from_x = -3 (of the shapes box, cylinder)"));
  EXPECT_THAT(error_of_farfield({.farfield_to_z = 4}), HasSubstr("\"automatic\", a sphere,"));
  EXPECT_THAT(error_of_farfield({.farfield_shape = "cylinder", .farfield_center_y = 1}), HasSubstr("farfield_center_y = 1"));
  EXPECT_THAT(error_of_farfield({.farfield_shape = "none", .farfield_radius = 9, .farfield_edge = 1}),
              AllOf(HasSubstr("farfield_radius = 9"), HasSubstr("farfield_edge = 1")));
  EXPECT_THAT(error_of_farfield({.farfield_shape = "surface", .farfield_edge = 1}), HasSubstr("farfield_edge = 1"));
  EXPECT_THAT(error_of_farfield({.farfield_shape = "sphere", .farfield_surface = "far.stl"}), HasSubstr("far.stl"));
  EXPECT_THAT(error_of_farfield({.farfield_radius = 50, .farfield_edge = 10, .farfield_center_x = 1}), IsEmpty());
  EXPECT_THAT(error_of_farfield({.farfield_shape = "box", .farfield_edge = -0.5, .farfield_from_x = -3, .farfield_to_x = 3}), IsEmpty());
  EXPECT_THAT(error_of_farfield({.farfield_shape = "cylinder", .farfield_radius = 50, .farfield_from_x = -3, .farfield_to_x = 3}), IsEmpty());
  EXPECT_THAT(error_of_farfield({.farfield_shape = "surface", .farfield_edge = -0.5, .farfield_surface = "far.stl"}), IsEmpty());
}

/// A cube of 1 m with edges of 0.25 m in a box from -10 to 10 m with edges of 4 m.
std::string log_of_source(const SizeSource& source) {
  TriMesh boundary = test::cube(4), far = test::cube(5);
  boundary.patches.raw().front() = {"body", PatchKind::wall};
  for (Point& p : far.points) p = 20.0 * p - Vec3{10, 10, 10};
  for (TriangleVertices& t : far.triangles) std::swap(t[1], t[2]);  // normals into the fluid
  far.patches.raw().front() = {"farfield", PatchKind::farfield};
  append(boundary, far);
  MeshCase options;
  options.sources = {source};
  std::string log;
  warn_of_sources_outside(boundary, options, RunContext({.threads = 1, .log = [&](LogLevel, std::string_view line) { log += std::string(line) + "\n"; }}));
  return log;
}

TEST(IgnoredRequests, SourcesOutsideOfTheFluidAreWarnings) {
  EXPECT_THAT(log_of_source({.kind = SourceKind::sphere, .from = {1000, 0, 0}, .radius = 5, .size = 0.1}),
              AllOf(HasSubstr("source 1 (sphere about (1000, 0, 0), size 0.1 m) lies completely outside the fluid and has no effect"), HasSubstr("985 m away"),
                    HasSubstr("\"farfield\""), HasSubstr("leave out the source")));
  EXPECT_THAT(log_of_source({.kind = SourceKind::box, .from = {11, -1, -1}, .to = {15, 1, 1}, .size = 0.1}), HasSubstr("box about (13, 0, 0)"));
  EXPECT_THAT(log_of_source({.kind = SourceKind::line, .from = {0, 0, 20}, .to = {5, 0, 20}, .size = 0.1}), HasSubstr("line"));
  EXPECT_THAT(
      log_of_source({.kind = SourceKind::wake, .from = {-12, 0, 0}, .to = {-12, 1, 0}, .direction = {-1, 0, 0}, .length = 3, .height = 0.1, .size = 0.1}),
      HasSubstr("wake"));
  EXPECT_THAT(log_of_source({.kind = SourceKind::samples, .points = {{40, 0, 0}, {50, 0, 0}}, .sizes = {0.1, 0.1}}), HasSubstr("samples"));
  // In the cube: edges longer than those of the farfield have no effect.
  EXPECT_THAT(log_of_source({.kind = SourceKind::sphere, .from = {0.5, 0.5, 0.5}, .radius = 0.1, .size = 30}), HasSubstr("no effect"));
}

TEST(IgnoredRequests, SourcesWithAnEffectPass) {
  const std::vector<SizeSource> sources = {
      {.kind = SourceKind::sphere, .from = {3, 0, 0}, .radius = 0.5, .size = 0.1},
      {.kind = SourceKind::sphere, .from = {0.5, 0.5, 0.5}, .radius = 0.1, .size = 0.1},        // in the body, refines the fluid beside it
      {.kind = SourceKind::box, .from = {-100, -100, -100}, .to = {100, 100, 100}, .size = 9},  // around everything
      {.kind = SourceKind::box, .from = {9, -1, -1}, .to = {30, 1, 1}, .size = 0.1},            // across the farfield
      {.kind = SourceKind::wake, .from = {1, 0, 0.5}, .to = {1, 1, 0.5}, .length = 30, .height = 0.2, .spread = 0.1, .size = 0.1},
      {.kind = SourceKind::samples, .points = {{40, 0, 0}, {5, 0, 0}}, .sizes = {0.1, 0.1}},
  };
  for (const SizeSource& source : sources) EXPECT_THAT(log_of_source(source), IsEmpty()) << to_string(source.kind);
}

}  // namespace
}  // namespace sterna::volmesh
