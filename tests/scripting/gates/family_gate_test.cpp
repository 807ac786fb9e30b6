// The family rule: families are passed, meshes that are none are found out, what cannot be known is said.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "geom/mesh/family.h"
#include "scripting/terminal/exit_status.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/error_of.h"
#include "tests/support/process.h"

namespace sterna::scripting {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// The member f of an ideal family.
FamilyMember member(double f) {
  FamilyMember m{.name = "f = " + std::to_string(f)};
  m.nodes = std::llround(1e6 * f * f * f);
  m.wall_faces = std::llround(1e4 * f * f);
  m.wall_edge = 0.1 / f;
  m.box.add(Point{-100, -100, -100});
  m.box.add(Point{100, 100, 100});
  m.patches = {{"farfield", "farfield"}, {"wing", "wall"}};
  m.layers = static_cast<int>(std::lround(30 * f));
  m.first_height = 1e-5 / f;
  m.measured_first = 1.01e-5 / f;
  m.growth = std::pow(1.2, 1.0 / f);
  m.measured_growth = std::pow(1.18, 1.0 / f);
  m.constant_layers = static_cast<int>(std::lround(4 * f));
  m.tet_growth = 1.0 + 0.3 / f;
  return m;
}

const FamilyRule& rule(const FamilyReport& report, const std::string& name, std::size_t step = 0) {
  for (const FamilyRule& r : report.steps.at(step).rules)
    if (r.name == name) return r;
  throw std::runtime_error("no rule " + name);
}

TEST(FamilyRules, IdealFamilyPassesAndDeviationsAreFound) {
  const FamilyReport ideal = check_family({member(1 / 1.5), member(1), member(1.5)}, {});
  EXPECT_EQ(ideal.state(), GateState::pass) << to_text(ideal);
  ASSERT_EQ(ideal.steps.size(), 2u);
  EXPECT_NEAR(ideal.steps[0].factor, 1.5, 1e-12);
  EXPECT_NEAR(ideal.steps[1].factor_by_nodes, 1.5, 1e-6);
  EXPECT_EQ(rule(ideal, "constant_layers").state, GateState::pass);

  const auto slip = [&](auto change) {
    FamilyMember fine = member(1.5);
    change(fine);
    return check_family({member(1), fine}, {});
  };
  // Workshop meshes that changed one thing: the same layer, the same growth, another farfield, a patch less.
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.first_height = 1e-5; }), "first_height").state, GateState::fail);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.growth = 1.2; }), "growth").state, GateState::fail);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.layers = 30; }), "layers").state, GateState::fail);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.layers = 47; }), "layers").state, GateState::warn);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.tet_growth = 1.3; }), "tet_growth").state, GateState::fail);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.constant_layers = 1; }), "constant_layers").state, GateState::fail);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.box.add(Point{150, 0, 0}); }), "box").state, GateState::fail);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.nodes = 3'000'000; }), "nodes").state, GateState::pass);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.nodes = 1'500'000; }), "nodes").state, GateState::warn);
  EXPECT_EQ(rule(slip([](FamilyMember& m) { m.nodes = 8'000'000; }), "nodes").state, GateState::fail);
  const FamilyReport renamed = slip([](FamilyMember& m) { m.patches[1].first = "Wing"; });
  EXPECT_EQ(rule(renamed, "patches").state, GateState::fail);
  EXPECT_THAT(rule(renamed, "patches").reason, AllOf(HasSubstr("\"wing\", wall"), HasSubstr("\"Wing\", wall")));
  // The wall says 1.5, the option 3^(1/3): the wall is a few percent off.
  EXPECT_EQ(rule(check_family({member(1), member(1.5)}, {.factor = std::cbrt(3.0)}), "wall_edge").state, GateState::pass);
  EXPECT_EQ(rule(check_family({member(1), member(1.5)}, {.factor = 2.0}), "wall_edge").state, GateState::fail);
}

TEST(FamilyRules, WhatIsNotKnownIsNotChecked) {
  FamilyMember file = member(1);
  file.first_height = file.growth = file.tet_growth = std::nullopt;
  const FamilyReport report = check_family({file, member(1.5)}, {});
  EXPECT_EQ(report.state(), GateState::pass);
  EXPECT_EQ(rule(report, "first_height").state, GateState::not_checked);
  EXPECT_THAT(rule(report, "first_height").reason, HasSubstr("does not store the requested layer"));
  EXPECT_THAT(to_text(report), HasSubstr("not checked: f = 1.000000 has no manifest"));
  EXPECT_THAT(test::error_of([&] { check_family({member(1)}, {}); }).what(), HasSubstr("at least two"));
  EXPECT_THAT(test::error_of([&] { check_family({member(1.5), member(1)}, {}); }).what(), HasSubstr("from coarse to fine"));
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["schema"], "sterna-family-1");
  EXPECT_EQ(json["steps"][0]["rules"][2]["state"], "not checked");
}

class FamilyGate : public ScriptFixture {
 protected:
  test::ProcessResult sterna(const std::vector<std::string>& arguments) { return test::run_process(test::sterna_program(), arguments, folder_); }
};

const std::string k_family =
    "local m = cylinder{ {0,0,0}, {3,0,0}, radius=0.5, name='can' } local function member(f) local w = surface_mesh{ m, max_edge=0.2, refinement=f } "
    "return volume_mesh{ w, layers=12, first_height=2e-3, max_growth=1.25, refinement=f, farfield=sphere{ radius=10 } } end ";

TEST_F(FamilyGate, MeshesAndTheirFilesGiveSameVerdict) {
  const std::string printed =
      run(k_family +
              "local a, b = member(1), member(1.5) local r = check_family{ a, b } print(r.verdict, r[1].rules.layers, r[1].rules.first_height, r[1].factor) "
              "a:write(" +
              out("a.sterna") + ") b:write(" + out("b.sterna") + ") b:write(" + out("b.su2") + ") check_family{ a, " + out("b.sterna") + " }",
          {}, 2);
  EXPECT_THAT(printed, AllOf(HasSubstr("factor 1.5 by the requested refinements"), HasSubstr("pass\tpass\t1.5"), HasSubstr("growth of tetrahedra")));
  EXPECT_THAT(printed, Not(HasSubstr("FAIL")));
  const test::ProcessResult files = sterna({"check-family", "a.sterna", "b.sterna"});
  EXPECT_EQ(files.status, k_exit_success) << files.errors;
  EXPECT_THAT(files.output,
              AllOf(HasSubstr("family of 2 meshes: "), HasSubstr("a.sterna -> b.sterna: factor 1.5 by the requested refinements"), Not(HasSubstr("FAIL"))));
  // SU2 knows no columns; what was requested stands in the manifest beside it.
  const auto json = nlohmann::json::parse(sterna({"check-family", "a.sterna", "b.su2", "--json"}).output);
  for (const auto& entry : json["steps"][0]["rules"]) {
    const std::string name = entry["rule"], state = entry["state"];
    if (name == "layers") {
      EXPECT_EQ(state, "not checked") << name;
    }
    if (name == "first_height" || name == "growth" || name == "tet_growth" || name == "box" || name == "patches") {
      EXPECT_EQ(state, "pass") << name;
    }
  }
}

TEST_F(FamilyGate, UnrefinedLayerIsNoFamily) {
  const std::string broken = k_family +
                             "local a = member(1) local b = volume_mesh{ surface_mesh{ m, max_edge=0.2, refinement=1.5 }, layers=12, first_height=2e-3, "
                             "max_growth=1.25, farfield=sphere{ radius=10 } } ";
  EXPECT_THAT(run(broken + "print(check_family{ a, b }.verdict)", {}, 2),
              AllOf(HasSubstr("FAIL\n"), HasSubstr("requested first height, m                    FAIL")));
  EXPECT_THAT(error(broken + "check_family{ a, b, strict = true }"), HasSubstr("the meshes are not a family"));
  EXPECT_THAT(error("check_family{ 'a.sterna' }"), HasSubstr("at least two meshes"));
}

}  // namespace
}  // namespace sterna::scripting
