// report{} in scripts: content and size of the page, identical bytes, refused input.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "scripting/report/report_page.h"
#include "scripting/report/thin_surface.h"
#include "tests/scripting/report/page_json.h"
#include "tests/scripting/script_fixture.h"
#include "tests/support/data.h"
#include "tests/support/test_shapes.h"

namespace sterna::scripting {
namespace {

using testing::HasSubstr;

class Report : public ScriptFixture {
 protected:
  void SetUp() override { STERNA_NEEDS(!report_page().empty(), "the report page (npm or its registry, when this was built)"); }
  static std::string mesh_script() {
    return "local wall = read_surface{ '" + test::source_folder().string() + "/tests/data/scripts/box.stl' }\n" +
           "local mesh = volume_mesh{ wall, layers = 5, first_height = 1e-3 * wall.length, farfield = sphere{ radius = 10 * wall.length } }\n";
  }
};

TEST_F(Report, HoldsTheMeshItsGatesPlacesAndHistograms) {
  run(mesh_script() + "report{ mesh, " + out("box.html") + ", title = 'A </script> box', cuts = { { x = 0.25 }, 'nose' } }");
  const nlohmann::json page = test::page_json(folder_ / "box.html");
  EXPECT_EQ(page["schema"], "sterna-report-1");
  EXPECT_EQ(page["title"], "A </script> box");
  EXPECT_EQ(page["verdict"], "VALID");
  EXPECT_EQ(page["cuts"][0]["name"], "x=0.25");
  EXPECT_GE(page["cuts"].size(), 3u);
  EXPECT_GT(page["surface"]["shown"].get<int>(), 0);
  EXPECT_EQ(page["surface"]["shown"], page["surface"]["total"]);
  EXPECT_EQ(page["manifest"]["options"]["envelope"]["layers"], 5);
  EXPECT_THAT(page["options_set"]["envelope"].dump(), HasSubstr("layers"));
  EXPECT_GT(page["run"]["seconds"].get<double>(), 0.0);
  std::size_t n_histograms = 0;
  for (const auto& histogram : page["histograms"]) {
    EXPECT_EQ(histogram["edges"].size(), histogram["counts"].size() + 1);
    ++n_histograms;
  }
  EXPECT_GE(n_histograms, 15u);
  std::set<std::string> fields;
  for (const auto& field : page["surface"]["fields"]) fields.insert(field["name"].get<std::string>());
  EXPECT_THAT(fields, testing::IsSupersetOf({"edge_length", "layer_height", "first_height", "skew", "coverage", "scaled_jacobian"}));
}

TEST_F(Report, WithoutTimesBytesAreEqualForAnyThreads) {
  for (const int threads : {1, 2, 7})
    run(mesh_script() + "report{ mesh, " + out("box" + std::to_string(threads) + ".html") + ", title = 'box', times = false }", {}, threads);
  // The manifest contains the file name of the page.
  const auto without_name = [&](int threads) {
    std::string text = text_of("box" + std::to_string(threads) + ".html");
    const std::string name = "\"output\":\"box" + std::to_string(threads) + "\"";
    const std::size_t at = text.find(name);
    EXPECT_NE(at, std::string::npos);
    return text.erase(at, name.size());
  };
  EXPECT_EQ(without_name(1), without_name(2));
  EXPECT_EQ(without_name(1), without_name(7));
}

TEST_F(Report, OfASurfaceAndThinned) {
  run(mesh_script() + "report{ wall, " + out("wall.html") + " } report{ mesh, " + out("thin.html") + ", max_triangles = 50, max_polygons = 30 }");
  const nlohmann::json wall = test::page_json(folder_ / "wall.html"), thin = test::page_json(folder_ / "thin.html");
  EXPECT_EQ(wall["kind"], "surface");
  ASSERT_TRUE(wall["facts"].is_array());
  EXPECT_EQ(wall["facts"][0][0], "triangles");
  EXPECT_TRUE(wall["cuts"].empty());
  EXPECT_LE(thin["surface"]["shown"].get<int>(), 50);
  EXPECT_GT(thin["surface"]["total"].get<int>(), 50);
}

TEST_F(Report, TellsWhatWasChangedOnTheSurface) {
  run("local whole = read_surface '" + test::source_folder().string() + "/tests/data/scripts/box.stl'\n" + "whole:write(" + out("whole.off") + ")");
  std::string text = text_of("whole.off");
  text.erase(text.find_last_of('\n', text.size() - 2) + 1);  // without its last facet
  const std::size_t counts = text.find('\n') + 1;
  std::istringstream numbers(text.substr(counts));
  std::size_t n_points = 0, n_facets = 0;
  numbers >> n_points >> n_facets;
  text.replace(counts, text.find('\n', counts) - counts, std::to_string(n_points) + " " + std::to_string(n_facets - 1) + " 0");
  std::ofstream(folder_ / "open.off") << text;
  run("report{ read_surface{ " + out("open.off") + ", auto = true }, " + out("open.html") + " }");
  const nlohmann::json page = test::page_json(folder_ / "open.html");
  ASSERT_EQ(page["manifest"]["changes"].size(), 1u);
  EXPECT_THAT(page["manifest"]["changes"][0].get<std::string>(), HasSubstr("holes filled: 1 place"));
  EXPECT_THAT(page["manifest"]["changes"][0].get<std::string>(), HasSubstr("retained facets moved by at most 0 m"));
}

TEST_F(Report, RefusesWhatItCannotShow) {
  EXPECT_THAT(error(mesh_script() + "report{ mesh, 'x.txt' }"), HasSubstr("ends in .html"));
  EXPECT_THAT(error(mesh_script() + "report{ mesh }"), HasSubstr("entry 2"));
  EXPECT_THAT(error("report{ 5, 'x.html' }"), HasSubstr("expected a mesh, a surface or the name of a file"));
  EXPECT_THAT(error("report{ 'nothing.su2', 'x.html' }"), HasSubstr("nothing.su2"));
  EXPECT_THAT(error(mesh_script() + "report{ mesh, 'x.html', cuts = { { x = 1000 } } }"),
              HasSubstr("the plane is at 1000 m along (1, 0, 0), the mesh extends from"));
  EXPECT_THAT(error(mesh_script() + "report{ mesh, 'x.html', cuts = { 'leadin edge' } }"), HasSubstr("leadin edge"));
  EXPECT_THAT(error(mesh_script() + "report{ wall, 'x.html', cuts = 'tip' }"), HasSubstr("no cells to cut"));
  EXPECT_THAT(error(mesh_script() + "report{ mesh, 'x.html', titel = 'box' }"), HasSubstr("title"));
}

TEST_F(Report, OfFiles) {
  run(mesh_script() + "mesh:write(" + out("box.su2") + ")");
  run("report{ " + out("box.su2") + ", " + out("box.html") + ", cuts = {} } report{ '" + test::source_folder().string() + "/tests/data/scripts/box.stl', " +
      out("wall.html") + " }");
  EXPECT_EQ(test::page_json(folder_ / "box.html")["title"], "box.su2");
  EXPECT_EQ(test::page_json(folder_ / "wall.html")["kind"], "surface");
}

TEST_F(Report, CellsAreAVtuBesideTheMesh) {
  run(mesh_script() + "mesh:write(" + out("box.su2") + ") mesh:check{ cells = " + out("cells.vtu") + " }");
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cells.vtu"));
  EXPECT_THAT(error(mesh_script() + "mesh:check{ cells = " + out("cells.csv") + " }"), HasSubstr("as a .vtu file"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "cells.csv"));
}

TEST_F(Report, UserGatesDecideVerdictManifestAndPage) {
  const std::string printed = run(mesh_script() + "mesh:check{ gates = { orthogonality = { hard = 89*deg, target = 89.5*deg, usual = false } } } mesh:write(" +
                                  out("box.su2") + ") report{ mesh, " + out("box.html") + " }");
  EXPECT_THAT(printed, HasSubstr("FAIL"));
  EXPECT_THAT(text_of("box.su2.json"), HasSubstr("\"failed\": [\n"));
  const nlohmann::json manifest = nlohmann::json::parse(text_of("box.su2.json")), page = test::page_json(folder_ / "box.html");
  EXPECT_EQ(manifest["verdict"], "VALID");
  EXPECT_EQ(manifest["quality"]["verdict"], "FAIL");
  EXPECT_THAT(manifest["quality"]["failed"].dump(), HasSubstr("orthogonality"));
  EXPECT_NEAR(manifest["quality"]["measures"]["orthogonality"]["limits"]["hard"].get<double>(), 89.0, 1e-9);
  EXPECT_TRUE(manifest["quality"]["measures"]["orthogonality"]["limits"]["usual"].is_null());
  EXPECT_FALSE(manifest["quality"]["measures"]["face_weight"].contains("limits"));
  EXPECT_EQ(page["quality_verdict"], "FAIL");
  EXPECT_THAT(error(mesh_script() + "mesh:check{ strict = true, gates = { G5 = { hard = 89*deg, target = 89.5*deg } } }"), HasSubstr("node-centred: FAIL"));
  EXPECT_THAT(error(mesh_script() + "mesh:check{ gates = { ortogonality = { hard = 1 } } }"), HasSubstr("did you mean orthogonality"));
  EXPECT_THAT(error(mesh_script() + "mesh:check{ gates = { orthogonality = { hart = 1 } } }"), HasSubstr("did you mean hard"));
  EXPECT_THAT(error(mesh_script() + "mesh:check{ gates = { orthogonality = {} } }"), HasSubstr("expected a table with hard, target"));
  EXPECT_THAT(error(mesh_script() + "mesh:check{ gates = { orthogonality = { hard = 50*deg } } }"), HasSubstr("values are better: give both"));
  EXPECT_THAT(error(mesh_script() + "mesh:check{ gates = { orthogonality = { hard = 20*deg, target = 10*deg } } }"), HasSubstr("less strict than hard"));
  EXPECT_THAT(error(mesh_script() + "mesh:check{ gates = { G9 = { hard = 1 } } }"), HasSubstr("several measures"));
}

TEST(ThinSurface, KeepsTheShapeWithFewerTriangles) {
  const TriMesh sphere = test::sphere(24);
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const TriangleVertices& t : sphere.triangles) triangles.push_back({t[0].value(), t[1].value(), t[2].value()});
  const auto all = thin_surface(sphere.points.raw(), triangles, triangles.size());
  EXPECT_EQ(all.triangles, triangles);
  const auto thin = thin_surface(sphere.points.raw(), triangles, 2000);
  EXPECT_LE(thin.triangles.size(), 2000u);
  EXPECT_GT(thin.triangles.size(), 500u);
  double area = 0.0;
  for (std::size_t t = 0; t < thin.triangles.size(); ++t) {
    const auto& c = thin.triangles[t];
    const auto p = [&](std::size_t k) { return sphere.points[VertexId(c[k])]; };
    EXPECT_LT(thin.source[t], triangles.size());
    area += 0.5 * norm(cross(p(1) - p(0), p(2) - p(0)));
  }
  EXPECT_NEAR(area, 4.0 * 3.14159265, 0.1 * 4.0 * 3.14159265);  // the area of a sphere, with coarser facets
}

}  // namespace
}  // namespace sterna::scripting
