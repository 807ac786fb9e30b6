// Pictures as PNG: known colours at known locations, every view and colouring, and refused input.
#include "geom/draw/draw.h"

#include <cairo.h>
#include <gmock/gmock.h>

#include <cstring>
#include <map>
#include <set>

#include "geom/base/error.h"
#include "geom/draw/choices.h"
#include "geom/draw/colours.h"
#include "geom/draw/legend.h"
#include "geom/draw/scene.h"
#include "geom/mesh/body_patches.h"
#include "geom/mesh/surface_fields.h"
#include "tests/support/hybrid_shapes.h"
#include "tests/support/test_constants.h"
#include "tests/support/test_shapes.h"

namespace sterna {
namespace {

using namespace test;
using draw::Image;
using draw::Rgb;
using testing::HasSubstr;

using test::k_context;

Image decoded(const std::string& png) {
  struct Reader {
    const std::string& bytes;
    std::size_t at = 0;
  } reader{png};
  cairo_surface_t* const surface = cairo_image_surface_create_from_png_stream(
      [](void* closure, unsigned char* data, unsigned int n) {
        Reader& r = *static_cast<Reader*>(closure);
        if (r.at + n > r.bytes.size()) return CAIRO_STATUS_READ_ERROR;
        std::memcpy(data, r.bytes.data() + r.at, n);
        r.at += n;
        return CAIRO_STATUS_SUCCESS;
      },
      &reader);
  EXPECT_EQ(cairo_surface_status(surface), CAIRO_STATUS_SUCCESS);
  Image image{cairo_image_surface_get_width(surface), cairo_image_surface_get_height(surface), {}};
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      std::uint32_t word = 0;
      std::memcpy(&word, cairo_image_surface_get_data(surface) + y * cairo_image_surface_get_stride(surface) + 4 * x, 4);
      image.pixels.push_back({static_cast<std::uint8_t>(word >> 16), static_cast<std::uint8_t>(word >> 8), static_cast<std::uint8_t>(word)});
    }
  cairo_surface_destroy(surface);
  return image;
}

/// Returns options without title, legend or other annotations.
DrawOptions bare() {
  DrawOptions options;
  options.width = options.height = 200;
  options.edges = options.legend = false;
  options.title = "none";
  return options;
}

std::size_t count(const Image& image, Rgb color) { return static_cast<std::size_t>(std::count(image.pixels.begin(), image.pixels.end(), color)); }
std::set<std::tuple<int, int, int>> colors_of(const Image& image) {
  std::set<std::tuple<int, int, int>> colors;
  for (const Rgb c : image.pixels) colors.insert({c.r, c.g, c.b});
  return colors;
}

/// Returns a cube whose sides are patches x_min, x_max, ...
TriMesh cube_of_patches() {
  TriMesh mesh = cube(2);
  mesh.patches = {{"x_min", PatchKind::wall}, {"x_max", PatchKind::wall}, {"y_min", PatchKind::wall},
                  {"y_max", PatchKind::wall}, {"z_min", PatchKind::slip}, {"z_max", PatchKind::wall}};
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto p = corners(mesh, t);
    const Point middle = (p[0] + p[1] + p[2]) / 3.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t end = 0; end < 2; ++end)
        if (std::abs(middle[axis] - static_cast<double>(end)) < 1e-9) mesh.triangle_patch[t] = PatchId(2 * axis + end);
  }
  return mesh;
}

std::string text_of(const std::function<void()>& f, ErrorCode code) {
  try {
    f();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code);
    return error.what();
  }
  ADD_FAILURE() << "nothing was refused";
  return {};
}

TEST(Draw, ACubeFromEachSideShowsThatSide) {
  const TriMesh mesh = cube_of_patches();
  DrawOptions options = bare();
  options.patches = "*";
  const std::map<std::string, std::size_t> seen = {{"front", 0}, {"back", 1}, {"left", 2}, {"right", 3}, {"bottom", 4}, {"top", 5}};
  for (const auto& [view, patch] : seen) {
    options.view = view;
    const Image image = decoded(draw_png(mesh, options, "", {}, k_context));
    const Rgb base = draw::patch_color(patch), middle = image.at(100, 100);
    // All sides are lit by the same light: the pixel is the patch's colour times one factor.
    EXPECT_NEAR(static_cast<double>(middle.r) / base.r, static_cast<double>(middle.g) / base.g, 0.02) << view;
    EXPECT_NEAR(static_cast<double>(middle.b) / base.b, static_cast<double>(middle.g) / base.g, 0.02) << view;
    EXPECT_EQ(image.at(2, 2), (Rgb{255, 255, 255})) << view;
    EXPECT_EQ(image.at(20, 20), middle) << view;  // the cube fills the picture except for the margin
  }
}

TEST(Draw, IsoShowsThreeSidesOfACube) {
  DrawOptions options = bare();
  options.patches = "*";
  const Image image = decoded(draw_png(cube_of_patches(), options, "", {}, k_context));
  // Seen from ahead, left and above: x_min is at the left, y_min at the right, z_max at the top.
  const auto is_shade_of = [](Rgb pixel, std::size_t patch) {
    const Rgb base = draw::patch_color(patch);
    return std::abs(static_cast<double>(pixel.r) / base.r - static_cast<double>(pixel.g) / base.g) < 0.02 &&
           std::abs(static_cast<double>(pixel.b) / base.b - static_cast<double>(pixel.g) / base.g) < 0.02;
  };
  EXPECT_TRUE(is_shade_of(image.at(45, 120), 0));
  EXPECT_TRUE(is_shade_of(image.at(135, 130), 2));
  EXPECT_TRUE(is_shade_of(image.at(100, 40), 5));
}

/// A block with a symmetry plane at y = 0 or at y = 1.
TEST(Draw, HalfModelsAreSeenFromFluidSide) {
  for (const double at : {0.0, 1.0}) {
    HybridMesh mesh = plate_block(4, {.n_layers = 3, .layer_height = 0.5, .ratio = 1.0, .outer_height = 1.0});
    PatchId plane;
    const auto look = [&](const auto& face) {
      if (std::ranges::all_of(face.nodes, [&](NodeId n) { return std::abs(mesh.points[n].y - at) < 1e-12; })) plane = face.patch;
    };
    for (const BoundaryTriangle& t : mesh.boundary_triangles) look(t);
    for (const BoundaryQuad& q : mesh.boundary_quads) look(q);
    ASSERT_TRUE(plane.is_valid());
    // The symmetry plane gets a patch of its own, separate from other faces of its original patch.
    const PatchId symmetry = mesh.patches.push_back({"symmetry", PatchKind::symmetry});
    const auto take = [&](auto& face) {
      if (std::ranges::all_of(face.nodes, [&](NodeId n) { return std::abs(mesh.points[n].y - at) < 1e-12; })) face.patch = symmetry;
    };
    for (BoundaryTriangle& t : mesh.boundary_triangles) take(t);
    for (BoundaryQuad& q : mesh.boundary_quads) take(q);
    const double inwards = at == 0.0 ? 1.0 : -1.0;
    for (const char* view : {"automatic", "iso", "ISO"}) {
      DrawOptions options;
      options.view = view;
      EXPECT_GT(draw::build_scene(mesh, false, options, k_context).toward.y * inwards, 0.0) << view << ", symmetry at y = " << at;
    }
    DrawOptions options;
    options.view = at == 0.0 ? "left" : "right";  // a named view is used as given
    EXPECT_LT(draw::build_scene(mesh, false, options, k_context).toward.y * inwards, 0.0);
  }
}

TEST(Draw, PatchesThatAreNotNamedAreNotShown) {
  const TriMesh mesh = cube_of_patches();
  DrawOptions options = bare();
  options.view = "bottom";
  options.patches = "x_* y_*";
  EXPECT_EQ(decoded(draw_png(mesh, options, "", {}, k_context)).at(60, 60), decoded(draw_png(mesh, options, "", {}, k_context)).at(60, 60));
  options.view = "top";
  options.patches = "z_min";
  const Image bottom = decoded(draw_png(mesh, options, "", {}, k_context));
  EXPECT_EQ(colors_of(bottom).size(), 2u);  // one patch with one shade, and the background
  options.patches = "automatic";            // walls: z_max is a wall, z_min is not
  options.view = "bottom";
  const Image walls = decoded(draw_png(mesh, options, "", {}, k_context));
  EXPECT_NE(walls.at(100, 100), decoded(draw_png(
                                            mesh,
                                            [&] {
                                              options.patches = "*";
                                              return options;
                                            }(),
                                            "", {}, k_context))
                                    .at(100, 100));
}

TEST(Draw, PlateCutShowsPrismsBelowTetrahedra) {
  const HybridMesh mesh = plate_block(4, {.n_layers = 3, .layer_height = 0.5, .ratio = 1.0, .outer_height = 1.0});
  DrawOptions options = bare();
  options.cut = "y=0.55";
  options.focus = "0.5,0.55,0.5 radius=0.5";
  options.patches = "none";
  const Image image = decoded(draw_png(mesh, options, "", {}, k_context));
  const Rgb prism = draw::kind_color(CellKind::prism), tet = draw::kind_color(CellKind::tetrahedron);
  EXPECT_EQ(image.at(100, 150), prism);
  EXPECT_EQ(image.at(30, 180), prism);
  EXPECT_EQ(image.at(100, 50), tet);
  EXPECT_EQ(count(image, prism) + count(image, tet) + count(image, {255, 255, 255}), image.pixels.size());  // and no other colours
}

TEST(Draw, WallsInFrontOfCutAreRemoved) {
  const HybridMesh mesh = cube_shell(4, {.layer_height = 0.1, .outer_height = 0.5});
  DrawOptions options = bare();
  options.cut = "point=0.5,0.5,0.5 normal=0,1,0";
  const Image image = decoded(draw_png(mesh, options, "", {}, k_context));
  EXPECT_EQ(colors_of(image).count({draw::kind_color(CellKind::prism).r, draw::kind_color(CellKind::prism).g, draw::kind_color(CellKind::prism).b}), 1u);
  // The middle shows the body: the inside of its far wall, lit from the front.
  const Rgb middle = image.at(100, 100);
  EXPECT_LT(middle.r, middle.b);
  EXPECT_LT(middle.b, 190);
  EXPECT_NE(middle, draw::kind_color(CellKind::prism));
}

TEST(Draw, EveryViewColourAndLocationOfSmallMesh) {
  const HybridMesh mesh = sphere_shell(4);
  DrawOptions options;
  options.width = 320;
  options.height = 200;
  for (const char* projection : {"orthographic", "perspective"})
    for (const char* view : {"automatic", "iso", "front", "back", "left", "right", "top", "bottom", "225 30", "-1,-1,0.5"}) {
      options.projection = projection;
      options.view = view;
      const Image image = decoded(draw_png(mesh, options, "sphere", {}, k_context));
      EXPECT_EQ(image.width, 320);
      EXPECT_EQ(image.height, 200);
      EXPECT_GT(colors_of(image).size(), 50u) << view;
    }
  options.view = "automatic";
  std::vector<std::string> colors = {"automatic", "patch", "kind", "quality"};
  for (const SurfaceFieldInfo& info : surface_field_table())
    if (info.name != "coverage") colors.emplace_back(info.name);
  for (const char* cut : {"none", "nose", "section 50%", "Middle Plane", "x=0.2", "point=0,0,0.3 normal=1,1,1"})
    for (const std::string& color : colors) {
      options.cut = cut;
      options.color = color;
      EXPECT_GT(colors_of(decoded(draw_png(mesh, options, "", {}, k_context))).size(), 20u) << cut << " " << color;
    }
  for (const char* color : {"volume", "layer"}) {
    options.color = color;
    EXPECT_GT(colors_of(decoded(draw_png(mesh, options, "", {}, k_context))).size(), 20u) << color;
  }
}

TEST(Draw, BytesAreEqualForAnyNumberOfThreads) {
  const HybridMesh mesh = sphere_shell(8);
  DrawOptions options;
  options.width = 640;
  options.height = 400;
  for (const char* cut : {"none", "section 50%"}) {
    options.cut = cut;
    options.color = "quality";
    const std::string one = draw_png(mesh, options, "sphere", {}, RunContext({.threads = 1}));
    for (const int threads : {2, 7}) EXPECT_TRUE(draw_png(mesh, options, "sphere", {}, RunContext({.threads = threads})) == one);
    EXPECT_EQ(one.substr(1, 3), "PNG");
  }
}

TEST(Draw, LegendTitleAndMarks) {
  const HybridMesh mesh = sphere_shell(3);
  DrawOptions options = bare();
  const Image without = decoded(draw_png(mesh, options, "", {}, k_context));
  options.legend = true;
  const Image with = decoded(draw_png(mesh, options, "", {}, k_context));
  const auto in_panel = [](const Image& image) {
    std::size_t n = 0;
    for (int y = 0; y < 18; ++y)
      for (int x = 130; x < 200; ++x) n += image.at(x, y) == draw::patch_color(0);
    return n;
  };
  EXPECT_GT(in_panel(with), in_panel(without) + 20);
  options.color = "edge_length";
  const Image bar = decoded(draw_png(mesh, options, "", {}, k_context));
  const auto most_colors_in_a_column = [](const Image& image) {  // of the columns at the right
    std::size_t most = 0;
    for (int x = image.width / 2; x < image.width; ++x) {
      std::set<std::tuple<int, int, int>> colors;
      for (int y = 0; y < image.height; ++y) colors.insert({image.at(x, y).r, image.at(x, y).g, image.at(x, y).b});
      most = std::max(most, colors.size());
    }
    return most;
  };
  EXPECT_GT(most_colors_in_a_column(bar), most_colors_in_a_column(with) + 20);  // the bar has a colour for each of its rows
  options.title = "a title";
  EXPECT_NE(decoded(draw_png(mesh, options, "", {}, k_context)).pixels, bar.pixels);
  options.places = true;
  const std::vector<DrawMark> marks = {{{0, -1, 0}, "here"}};
  options.view = "left";
  EXPECT_GT(count(decoded(draw_png(mesh, options, "", marks, k_context)), draw::k_mark_color), 3u);
  options.places = false;
  EXPECT_EQ(count(decoded(draw_png(mesh, options, "", marks, k_context)), draw::k_mark_color), 0u);
}

TEST(Draw, TheLegendDoesNotCoverWhatIsDrawn) {
  const TriMesh mesh = cube_of_patches();
  DrawOptions options = bare();
  options.patches = "*";
  options.view = "front";  // one side fills the picture to its corners, so the legend is placed beside the side
  const auto n_shaded = [&](const Image& image) {
    std::size_t n = 0;
    const Rgb base = draw::patch_color(0);
    for (const Rgb c : image.pixels)
      n += std::abs(static_cast<double>(c.r) / base.r - static_cast<double>(c.g) / base.g) < 0.02 &&
           std::abs(static_cast<double>(c.b) / base.b - static_cast<double>(c.g) / base.g) < 0.02 && c != Rgb{255, 255, 255};
    return n;
  };
  EXPECT_GT(n_shaded(decoded(draw_png(mesh, options, "", {}, k_context))), 30000u);
  options.legend = true;
  const draw::Scene scene = draw::build_scene(boundary_of(mesh), true, options, k_context);
  draw::Layout layout = draw::layout_of(options, scene, false, {});
  ASSERT_GT(layout.inset, 0.0);
  const Rgb paper{255, 255, 255}, ink{0, 0, 0};
  Image picture{200, 200, std::vector<Rgb>(40000, paper)};
  EXPECT_TRUE(draw::place_inset(layout, scene, picture, paper));
  EXPECT_GT(layout.inset_x, 100.0);  // the inset is at the right while there is room
  picture.pixels[20 * 200 + 190] = ink;
  EXPECT_TRUE(draw::place_inset(layout, scene, picture, paper));
  EXPECT_LT(layout.inset_x, 100.0);
  picture.pixels[20 * 200 + 10] = picture.pixels[185 * 200 + 190] = ink;
  EXPECT_FALSE(draw::place_inset(layout, scene, picture, paper));
  const Image beside = decoded(draw_png(mesh, options, "", {}, k_context));
  const int edge = static_cast<int>(200.0 - layout.inset);
  for (int y = 110; y < 150; ++y) EXPECT_EQ(beside.at(edge + 8, y), paper);  // no part of the cube appears below the legend's panel
}

TEST(Draw, CutShowsDiscAsLineWithName) {
  HybridMesh mesh = plate_block(4, {.n_layers = 3, .layer_height = 0.5, .ratio = 1.0, .outer_height = 1.0});
  const PatchId disc = mesh.patches.push_back({"prop", PatchKind::interface}), back = mesh.patches.push_back({"prop.back", PatchKind::interface});
  std::array<NodeId, 4> n;
  for (std::size_t k = 0; k < 4; ++k) n[k] = mesh.points.push_back({0.5, k == 1 || k == 2 ? 0.8 : 0.2, k >= 2 ? 0.9 : 0.6});
  for (const PatchId patch : {disc, back}) {
    mesh.boundary_triangles.push_back({{n[0], n[1], n[2]}, patch});
    mesh.boundary_triangles.push_back({{n[0], n[2], n[3]}, patch});
  }
  DrawOptions options = bare();
  options.cut = "y=0.55";
  options.focus = "0.5,0.55,0.5 radius=0.5";
  options.patches = "none";
  const draw::Scene scene = draw::build_scene(mesh, false, options, k_context);
  ASSERT_EQ(scene.lines.size(), 1u);
  EXPECT_EQ(scene.lines[0].name, "prop");
  EXPECT_EQ(scene.lines[0].segments.size(), 2u);
  EXPECT_EQ(scene.swatches.back().text, "prop");
  EXPECT_GT(count(decoded(draw_png(mesh, options, "", {}, k_context)), scene.lines[0].color), 10u);
}

TEST(Draw, MarksAreWhatTheCheckFound) {
  HybridMesh mesh = plate_block(3);
  const std::vector<DrawMark> good = marks_of(check(mesh, {}, k_context));
  mesh.points[mesh.layers.top(5)].z = -0.2;  // folded
  const CheckReport report = check(mesh, {}, k_context);
  const std::vector<DrawMark> bad = marks_of(report);
  ASSERT_GT(bad.size(), good.size());
  EXPECT_THAT(bad.front().text, HasSubstr("G"));
  std::set<std::string> texts;
  for (const DrawMark& mark : bad) texts.insert(mark.text.substr(0, mark.text.find(':')));
  EXPECT_EQ(texts.size(), bad.size());  // each kind is listed once
}

TEST(Draw, UnknownNamesAreRefusedWithKnownOnes) {
  const HybridMesh mesh = sphere_shell(2);
  const auto refused = [&](const std::function<void(DrawOptions&)>& change, ErrorCode code) {
    DrawOptions options = bare();
    change(options);
    return text_of([&] { draw_png(mesh, options, "", {}, k_context); }, code);
  };
  EXPECT_THAT(refused([](DrawOptions& o) { o.color = "qualty"; }, ErrorCode::unknown_option),
              testing::AllOf(HasSubstr("did you mean \"quality\""), HasSubstr("edge_length"), HasSubstr("volume")));
  EXPECT_THAT(refused([](DrawOptions& o) { o.color = "volume"; }, ErrorCode::bad_argument), HasSubstr("cut"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.color = "coverage"; }, ErrorCode::bad_argument), HasSubstr("edge_length"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.cut = "nos"; }, ErrorCode::unknown_option),
              testing::AllOf(HasSubstr("did you mean \"nose\""), HasSubstr("section 50%")));
  EXPECT_THAT(refused([](DrawOptions& o) { o.cut = "w=1"; }, ErrorCode::bad_argument), HasSubstr("normal=0,1,0"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.cut = "point=0,0,0 normal=0,0,0"; }, ErrorCode::bad_argument), HasSubstr("normal"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.cut = "x=400"; }, ErrorCode::bad_argument), HasSubstr("crosses no cell"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.focus = "1,2,3"; }, ErrorCode::bad_argument), HasSubstr("radius"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.focus = "1,2,3 radius=-1"; }, ErrorCode::bad_argument), HasSubstr("radius"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.view = "isi"; }, ErrorCode::unknown_option), HasSubstr("did you mean \"iso\""));
  EXPECT_THAT(refused([](DrawOptions& o) { o.view = "0,0,0"; }, ErrorCode::bad_argument), HasSubstr("length"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.patches = "wing*"; }, ErrorCode::bad_argument), HasSubstr("sphere"));
  EXPECT_THAT(refused([](DrawOptions& o) { o.patches = "none"; }, ErrorCode::bad_argument), HasSubstr("nothing to show"));
  EXPECT_THAT(refused(
                  [](DrawOptions& o) {
                    o.color = "edge_length";
                    o.range_min = 2.0;
                    o.range_max = 1.0;
                  },
                  ErrorCode::bad_argument),
              HasSubstr("range_min"));
  DrawOptions options = bare();
  options.cut = "x=0";
  EXPECT_THAT(text_of([&] { draw_png(cube(1), options, "", {}, k_context); }, ErrorCode::bad_argument), HasSubstr("surface has no cells"));
}

TEST(Draw, TextsOfViewsPlanesAndSpheres) {
  using namespace draw;
  EXPECT_FALSE(view_of("automatic"));
  EXPECT_EQ(*view_of("left"), (Vec3{0, -1, 0}));
  EXPECT_NEAR(view_of("270 0")->y, -1.0, 1e-15);
  EXPECT_NEAR(view_of("180, 30")->z, 0.5, 1e-15);
  EXPECT_EQ(*view_of("-1 -1 0.5"), (Vec3{-1, -1, 0.5}));
  EXPECT_EQ(plane_of("z=-0.5")->origin, (Point{0, 0, -0.5}));
  EXPECT_EQ(plane_of("z=-0.5")->normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(plane_of("point=1,2,3 normal=0,2,0")->origin, (Point{1, 2, 3}));
  EXPECT_EQ(plane_of("normal=0,2,0 point=1,2,3")->normal, (Vec3{0, 1, 0}));
  EXPECT_EQ(plane_of("normal=0,0,1")->origin, (Point{0, 0, 0}));
  EXPECT_FALSE(plane_of("leading edge"));
  EXPECT_EQ(sphere_of("1,2,0 radius=0.5")->center, (Point{1, 2, 0}));
  EXPECT_EQ(sphere_of("1 2 0 radius=0.5")->radius, 0.5);
  EXPECT_FALSE(sphere_of("automatic"));
}

TEST(Draw, TicksAreRoundNumbers) {
  using draw::ticks_of;
  EXPECT_EQ(ticks_of(0.0, 1.0, false, 5), (std::vector<double>{0.0, 1 * 0.2, 2 * 0.2, 3 * 0.2, 4 * 0.2, 1.0}));
  EXPECT_EQ(ticks_of(1.0, 1000.0, true, 5).size(), 4u);
  EXPECT_EQ(ticks_of(0.9, 11.0, true, 6), (std::vector<double>{1, 2, 5, 10}));
  EXPECT_GE(ticks_of(1.1, 1.4, true, 6).size(), 2u);
  EXPECT_EQ(ticks_of(3.0, 3.0, false, 5), (std::vector<double>{3.0}));
}

}  // namespace
}  // namespace sterna
