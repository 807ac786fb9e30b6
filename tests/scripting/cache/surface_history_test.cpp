#include "scripting/values/surface_history.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "scripting/cache/content_key.h"
#include "scripting/values/stored_types.h"

namespace sterna::scripting {
namespace {

SurfaceHistory repaired_and_remeshed() {
  return {{.options = SurfaceRecipe{}},
          {.options = surfmesh::RepairOptions{}, .changes = {"repaired", "faces replaced"}, .figures = R"({"by":"repair"})"},
          {.options = surfmesh::RemeshOptions{}, .changes = {"remeshed"}}};
}

TEST(SurfaceHistories, LastStepOfEachKindIsFound) {
  SurfaceHistory history = repaired_and_remeshed();
  EXPECT_EQ(last_of<UnionOptions>(history), nullptr);
  surfmesh::RemeshOptions second;
  second.sizes.growth = 1.5;
  history.push_back({.options = second});
  EXPECT_EQ(last_of<surfmesh::RemeshOptions>(history)->sizes.growth, 1.5);
  const OptionTable table = history_options(history);
  EXPECT_TRUE(std::ranges::any_of(table, [](const Option& option) { return option.name == "growth" && option.get() == OptionValue(1.5); }));
}

TEST(SurfaceHistories, InheritedStepsKeepChangesWithoutOptions) {
  SurfaceHistory without, with;
  inherit(without, repaired_and_remeshed());
  inherit(with, repaired_and_remeshed(), true);
  for (const SurfaceHistory& history : {without, with}) {
    EXPECT_EQ(changes_of(history), changes_of(repaired_and_remeshed()));
    EXPECT_EQ(last_of<surfmesh::RepairOptions>(history), nullptr);
    EXPECT_EQ(last_of<surfmesh::RemeshOptions>(history), nullptr);
  }
  EXPECT_EQ(last_of<SurfaceRecipe>(without), nullptr);
  EXPECT_NE(last_of<SurfaceRecipe>(with), nullptr);
}

TEST(SurfaceHistories, ChangesAndFiguresAreReadBack) {
  Json json = Json::object(), again = Json::object();
  add_changes(json, repaired_and_remeshed());
  EXPECT_EQ(json.dump(), R"({"changes":["repaired","faces replaced","remeshed"],"changed":[{"by":"repair"}]})");
  add_changes(again, read_changes(json));
  EXPECT_EQ(again.dump(), json.dump());
  EXPECT_TRUE(read_changes(Json::object()).empty());
}

TEST(SurfaceHistories, RecipeIsReadBack) {
  SurfaceRecipe recipe;
  recipe.patches = {{.names = "wing*", .options = {{"max_edge", 0.25}}}};
  recipe.sources = {{.kind = volmesh::SourceKind::sphere, .radius = 1.0, .size = 0.1}};
  for (const bool has_function : {false, true}) {
    recipe.has_function = has_function;
    Json json = Json::object();
    add_recipe(json, recipe);
    SurfaceRecipe read;
    read_recipe(json, read);
    EXPECT_EQ(KeyMaker("recipe").add(read).key(), KeyMaker("recipe").add(recipe).key()) << json.dump();
  }
  Json nothing = Json::object();
  add_recipe(nothing, SurfaceRecipe{});
  EXPECT_TRUE(nothing.empty());
}

}  // namespace
}  // namespace sterna::scripting
