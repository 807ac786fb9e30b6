// Requests in rules of patches that have no effect: each kind is an error or a warning that names it.
#include "volmesh/case/ignored_requests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "geom/base/error.h"

namespace sterna::volmesh {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

/// What comes of rules for a model with a wall "wing" that has layers, a wall "body" that has none, a slip wall "floor" and a farfield.
struct Outcome {
  std::string error, log;
};

Outcome outcome_of(const std::vector<PatchRule>& rules, const EnvelopeOptions& all = {}) {
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

TEST(IgnoredRequests, EachWithoutEffectIsAnErrorThatNamesIt) {
  struct Case {
    PatchRule rule;
    std::string request, patch, remedy;
  };
  const std::string wall = "kind = \"wall\"", layers = "layers = 1 or more";
  const std::vector<Case> cases = {
      {{.names = "farfield", .layers = 10}, "layers = 10", "\"farfield\" (of kind farfield)", wall},
      {{.names = "floor", .first_height = 1e-3}, "first_height = 0.001", "\"floor\" (of kind slip)", wall},
      {{.names = "f*", .max_growth = 1.2}, "max_growth = 1.2", "\"floor\" (of kind slip), \"farfield\" (of kind farfield)", wall},
      {{.names = "floor", .total_height = 0.1}, "total_height = 0.1", "\"floor\"", wall},
      {{.names = "floor", .max_thickness = 0.1}, "max_thickness = 0.1", "\"floor\"", wall},
      {{.names = "floor", .blend = 0.1}, "blend = 0.1", "\"floor\"", wall},
      {{.names = "floor", .open_ridges = "always"}, "open_ridges = \"always\"", "\"floor\"", wall},
      {{.names = "floor", .truncate = "auto"}, "truncate = \"auto\"", "\"floor\"", wall},
      {{.names = "body", .layers = 0, .total_height = 0.1}, "total_height = 0.1", "\"body\" (no layers are requested there)", layers},
      {{.names = "body", .first_height = 1e-3}, "first_height = 0.001", "\"body\"", layers},
      {{.names = "floor", .kind = "slip", .layers = 4}, "layers = 4", "\"floor\"", wall},
  };
  for (const Case& c : cases)
    EXPECT_THAT(outcome_of({c.rule}).error,
                AllOf(HasSubstr("patches[\"" + c.rule.names + "\"] requests " + c.request), HasSubstr(c.patch), HasSubstr(c.remedy)))
        << c.request;
}

TEST(IgnoredRequests, AllAreNamedTogether) {
  EXPECT_THAT(outcome_of({{.names = "farfield", .layers = 10}, {.names = "floor", .first_height = 1e-3}}).error,
              AllOf(HasSubstr("patches[\"farfield\"]"), HasSubstr("patches[\"floor\"]")));
}

TEST(IgnoredRequests, WhatHasAnEffectOrIsReplacedPasses) {
  const std::vector<std::vector<PatchRule>> cases = {
      {{.names = "*", .layers = 10}},                                             // on the wing
      {{.names = "floor", .layers = 0}},                                          // as it is
      {{.names = "floor", .kind = "slip"}},                                       // likewise
      {{.names = "floor", .layers = 10}, {.names = "floor", .kind = "slip"}},     // replaced on purpose
      {{.names = "body", .first_height = 1e-3}, {.names = "body", .layers = 0}},  // likewise
      {{.names = "floor", .open_ridges = "never"}, {.names = "body", .truncate = "never"}},
  };
  for (const std::vector<PatchRule>& rules : cases) {
    const Outcome outcome = outcome_of(rules);
    EXPECT_THAT(outcome.error, IsEmpty()) << rules.front().names;
    EXPECT_THAT(outcome.log, IsEmpty());
  }
}

TEST(IgnoredRequests, OptionsOfAllWallsThatNoneUsesAreWarnings) {
  EnvelopeOptions all;
  all.first_height = 1e-3;
  EXPECT_THAT(outcome_of({{.names = "wing", .first_height = 1e-4}}, all).log, HasSubstr("first_height = 0.001 of all walls has no effect"));
  EXPECT_THAT(outcome_of({{.names = "wing", .layers = 5}}, all).log, IsEmpty());
}

}  // namespace
}  // namespace sterna::volmesh
