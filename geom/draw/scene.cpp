// Steps: select patches, plane, and view; collect the faces of the patches and cut them off in front of the plane; add the polygons of the cut.
#include "geom/draw/scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "geom/base/error.h"
#include "geom/base/glob.h"
#include "geom/base/number_text.h"
#include "geom/draw/figures.h"
#include "geom/math/measures.h"
#include "geom/mesh/body_patches.h"
#include "geom/mesh/wall_sections.h"

namespace sterna::draw {
namespace {

/// Radius of the part of the cut that is drawn, relative to the radius of the focus, in a view along the plane's normal; it is also widened to the picture's
/// diagonal.
constexpr double k_along_normal = 1.1;
/// The same for other views, in which the drawn cells form a disc around the focus.
constexpr double k_aslant = 1.0;
/// Cosine between view direction and plane normal below which a plane is seen nearly edge-on and obscures nothing that needs to be cut off.
constexpr double k_edge_on = 0.02;
/// Number of patches listed in the legend; further ones are only counted.
constexpr std::size_t k_most_swatches = 24;

class SceneBuilder {
 public:
  SceneBuilder(const HybridMesh& mesh, bool is_surface, const DrawOptions& options, const RunContext& context)
      : mesh_(mesh), is_surface_(is_surface), options_(options), context_(context) {}

  Scene build() {
    choose_patches();
    choose_plane();
    coloring_ = coloring_of(options_.color, plane_.has_value());
    choose_view();
    if (plane_) cut_cells();
    add_faces();
    if (plane_) add_cells();
    if (plane_) add_sheets();
    if (scene_.polygons.size() == 0)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "draw",
                   .problem = "there is nothing to show",
                   .hint = "patches = \"*\" shows all patches" + std::string(plane_ ? "; a cut shows the cells that its plane crosses" : "")});
    return std::move(scene_);
  }

 private:
  const std::vector<CutLocation>& locations() {
    if (!locations_) locations_ = automatic_cuts(mesh_, context_);
    return *locations_;
  }

  void choose_patches() {
    is_shown_.assign(mesh_.patches.size(), 0);
    if (options_.patches == "none") return;
    if (options_.patches == "automatic") {
      is_shown_ = patches_of_bodies(mesh_);
      return;
    }
    std::vector<std::string> names;
    for (const Patch& patch : mesh_.patches) names.push_back(patch.name);
    std::istringstream patterns(options_.patches);
    for (std::string pattern; patterns >> pattern;) {
      bool is_used = false;
      for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == options_.patches || matches_glob(names[i], pattern)) {
          is_shown_[i] = 1;
          is_used = true;
        }
      if (!is_used)
        throw Error({.code = ErrorCode::bad_argument,
                     .attempted = "draw: option patches",
                     .problem = "no patch has a name like \"" + pattern + "\"",
                     .hint = names_hint(names, pattern)});
    }
  }

  void choose_plane() {
    scene_.focus = sphere_of(options_.focus);
    if (!scene_.focus && options_.focus != "automatic") {
      const CutLocation& location = location_of(locations(), options_.focus, "draw", "place");
      scene_.focus = Sphere{location.focus, location.radius};
    }
    if (options_.cut == "none") return;
    if (count_cells(mesh_).total() == 0)
      throw Error({.code = ErrorCode::bad_argument, .attempted = "draw: option cut", .problem = "a surface has no cells to cut", .hint = "draw a volume mesh"});
    plane_ = plane_of(options_.cut);
    if (!plane_) {
      const CutLocation& location = location_of(locations(), options_.cut, "draw", "cut");
      plane_ = location.plane;
      if (!scene_.focus) scene_.focus = Sphere{location.focus, location.radius};
    }
    if (!scene_.focus) scene_.focus = section_of_walls();
  }

  /// Returns the section of the walls with the plane; if it meets no walls, the section of the mesh.
  Sphere section_of_walls() const {
    Box box;
    for (const SectionPiece& piece : WallSections(mesh_, context_).section(plane_->origin, plane_->normal)) box.add(piece.box);
    if (box.empty())
      for (const Point& p : mesh_.points) box.add(p);
    Point center = box.center();
    center -= dot(center - plane_->origin, plane_->normal) * plane_->normal;
    return {center, 0.55 * distance(box.min, box.max)};
  }

  /// Chooses the default view: a cut is seen along its normal, from the side from which x points to the right, or from ahead.
  void choose_view() {
    const std::optional<Vec3> given = view_of(options_.view);
    const Vec3 iso = *view_of("iso");
    scene_.toward = given.value_or(iso);
    if (scene_.toward == iso && !plane_) look_from_inside();  // a side or direction in the options sets the viewpoint
    if (given || !plane_) return;
    const double side = camera_towards(plane_->normal).right.x;
    const bool is_turned = std::abs(side) > 1e-6 ? side < 0.0 : plane_->normal.x > 0.0 || plane_->normal.z < 0.0;
    scene_.toward = is_turned ? -plane_->normal : plane_->normal;
  }

  /// Turns the view of half models to the fluid side, so that the symmetry plane, or the opening of the surface there, is behind the body and not in front of
  /// it.
  void look_from_inside() {
    const Vec3 out = is_surface_ ? opening_normal() : symmetry_normal(mesh_);
    if (const double away = dot(scene_.toward, out); away > 0.0) scene_.toward -= 2.0 * away * out;
  }

  /// Returns the unit normal out of the opening of a surface; zero if the surface is closed. The area vectors of a closed surface sum to zero, those of an open
  /// surface to the missing area.
  Vec3 opening_normal() const {
    Vec3 sum;
    double area = 0.0;
    for (const BoundaryTriangle& face : mesh_.boundary_triangles) {
      const Vec3 a = area_vector(mesh_.points[face.nodes[0]], mesh_.points[face.nodes[1]], mesh_.points[face.nodes[2]]);
      sum += a;
      area += norm(a);
    }
    constexpr double k_open = 1e-3;
    return norm(sum) > k_open * area ? normalized(sum) : Vec3{};
  }

  void cut_cells() {
    const bool is_along = std::abs(dot(normalized(scene_.toward), plane_->normal)) > 0.999;
    const double widening = std::hypot(options_.width, options_.height) / std::min(options_.width, options_.height);
    plane_->limits = CutLimits{scene_.focus->center, scene_.focus->radius * (is_along ? k_along_normal * widening : k_aslant)};
    cut_ = cut_mesh(mesh_, *plane_, context_);
    if (cut_.size() == 0)
      throw Error({.code = ErrorCode::bad_argument,
                   .attempted = "draw: option cut",
                   .problem = "the plane crosses no cell within " + in_metres(scene_.focus->radius) + " of " + format_point(scene_.focus->center) +
                              ", the region shown; " + clear_plane_text(mesh_, *plane_),
                   .hint = "locations of the mesh are " + names_of_locations()});
  }

  std::string names_of_locations() {
    std::string names;
    for (const CutLocation& location : locations()) names += (names.empty() ? "" : ", ") + location.name;
    return names;
  }

  template <class Face>
  void add_face(const Face& face, std::size_t number) {
    if (is_shown_[face.patch.index()] == 0) return;
    const std::size_t start = scene_.polygons.corners.size();
    for (std::size_t k = face.nodes.size(); k-- > 0;) scene_.polygons.corners.push_back(mesh_.points[face.nodes[k]]);  // the front is on the fluid side
    if (!cut_off(start)) return;
    shown_.push_back(number);
    scene_.polygons.close({});
  }

  /// Clips the polygon that begins there to the part behind the plane; returns false if nothing is left.
  bool cut_off(std::size_t start) {
    const double facing = plane_ ? dot(normalized(scene_.toward), plane_->normal) : 0.0;
    if (std::abs(facing) < k_edge_on) return true;
    std::vector<Point>& corners = scene_.polygons.corners;
    const auto behind = [&](const Point& p) { return facing > 0.0 ? -dot(p - plane_->origin, plane_->normal) : dot(p - plane_->origin, plane_->normal); };
    piece_.assign(corners.begin() + static_cast<std::ptrdiff_t>(start), corners.end());
    corners.resize(start);
    for (std::size_t k = 0; k < piece_.size(); ++k) {
      const Point &a = piece_[k], &b = piece_[(k + 1) % piece_.size()];
      const double from = behind(a), to = behind(b);
      if (from >= 0.0) corners.push_back(a);
      if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) corners.push_back(a + (from / (from - to)) * (b - a));
    }
    if (corners.size() >= start + 3) return true;
    corners.resize(start);
    return false;
  }

  PatchId patch_of(std::size_t face) const {
    return face < mesh_.boundary_triangles.size() ? mesh_.boundary_triangles[face].patch : mesh_.boundary_quads[face - mesh_.boundary_triangles.size()].patch;
  }

  void add_faces() {
    for (std::size_t f = 0; f < mesh_.boundary_triangles.size(); ++f) add_face(mesh_.boundary_triangles[f], f);
    for (std::size_t f = 0; f < mesh_.boundary_quads.size(); ++f) add_face(mesh_.boundary_quads[f], mesh_.boundary_triangles.size() + f);
    const bool by_figure = coloring_ == Coloring::face_figure || (coloring_ == Coloring::quality && !plane_);
    if (coloring_ == Coloring::patch) color_faces_by_patch();
    else if (by_figure) color_faces_by_figure();
    else if (coloring_ == Coloring::kind && !plane_) color_faces_by_kind();
    else color_faces([](std::size_t) { return k_plain_wall; });
  }

  template <class ColorOf>
  void color_faces(const ColorOf& color_of) {
    for (std::size_t i = 0; i < shown_.size(); ++i) {
      PolygonStyle& style = scene_.polygons.styles[i];
      style.front = color_of(shown_[i]);
      const bool has_inside = !is_surface_ && mesh_.patches[patch_of(shown_[i])].kind == PatchKind::wall;
      style.back = has_inside ? k_inside : style.front;
    }
  }

  static std::string name_of(const Patch& patch) { return patch.name.empty() ? "(without a name)" : patch.name; }

  void color_faces_by_patch() {
    std::vector<std::uint8_t> is_seen(mesh_.patches.size(), 0);
    for (const std::size_t face : shown_) is_seen[patch_of(face).index()] = 1;
    const auto color_of = [&](std::size_t patch) { return patch_color(patch, mesh_.patches[PatchId(patch)].kind); };  // independent of the other patches shown
    std::size_t n_seen = 0;
    for (std::size_t i = 0; i < is_seen.size(); ++i) {
      if (is_seen[i] == 0) continue;
      if (n_seen++ < k_most_swatches) scene_.swatches.push_back({color_of(i), name_of(mesh_.patches[PatchId(i)])});
    }
    if (n_seen > k_most_swatches) scene_.swatches.push_back({{255, 255, 255}, "and " + std::to_string(n_seen - k_most_swatches) + " more"});
    color_faces([&](std::size_t face) { return color_of(patch_of(face).index()); });
    scene_.caption = "patches";
  }

  void color_faces_by_kind() {
    std::array<std::uint8_t, 7> is_seen{};
    const auto kind = [&](std::size_t face) { return mesh_.patches[patch_of(face)].kind; };
    for (const std::size_t face : shown_) is_seen[static_cast<std::size_t>(kind(face))] = 1;
    for (std::size_t k = 0; k < is_seen.size(); ++k)
      if (is_seen[k] != 0) scene_.swatches.push_back({patch_kind_color(static_cast<PatchKind>(k)), std::string(to_string(static_cast<PatchKind>(k)))});
    color_faces([&](std::size_t face) { return patch_kind_color(kind(face)); });
    scene_.caption = "kinds of patches";
  }

  void color_faces_by_figure() {
    Figure figure = face_figure(mesh_, options_.color, context_);
    std::vector<double> values;
    for (const std::size_t face : shown_) values.push_back(figure.values[face]);
    set_bar(std::move(figure.bar), values);
    color_faces([&](std::size_t face) { return scene_.bar->color_of(figure.values[face]); });
  }

  void set_bar(ColorBar bar, const std::vector<double>& values) {
    set_range(bar, values, options_.color, options_);
    scene_.has_faces_without_value = std::any_of(values.begin(), values.end(), [](double v) { return std::isnan(v); });
    scene_.caption = bar.title;
    scene_.bar = std::move(bar);
  }

  void add_cells() {
    const bool by_figure = coloring_ == Coloring::quality || coloring_ == Coloring::cell_figure;
    Figure figure;
    if (by_figure) {
      figure = cell_figure(cut_, options_.color);
      set_bar(figure.bar, figure.values);
    }
    std::array<std::uint8_t, 4> is_seen{};
    for (std::size_t i = 0; i < cut_.size(); ++i) {
      const auto corners = cut_.corners_of(i);
      const CellKind kind = cut_.polygons[i].kind;
      is_seen[static_cast<std::size_t>(kind)] = 1;
      const Rgb color = by_figure ? scene_.bar->color_of(figure.values[i]) : kind_color(kind);
      scene_.polygons.corners.insert(scene_.polygons.corners.end(), corners.begin(), corners.end());
      scene_.polygons.close({color, color, false, true});
    }
    const std::string where = plane_of(options_.cut) ? "cut at " + options_.cut : options_.cut;
    const std::string what = by_figure || coloring_ == Coloring::face_figure ? scene_.caption : "cells by kind";
    scene_.caption = where + ": " + what;
    if (by_figure) return;
    constexpr std::array<std::string_view, 4> k_plural = {"tetrahedra", "pyramids", "prisms", "hexahedra"};
    for (const std::size_t k : {2u, 0u, 1u, 3u})
      if (is_seen[k] != 0) scene_.swatches.push_back({kind_color(static_cast<CellKind>(k)), std::string(k_plural[k])});
  }

  /// Adds the lines in which the plane cuts the patches of kind interface, near the focus.
  void add_sheets() {
    const auto is_interface = [&](std::string_view name) {
      return std::ranges::any_of(mesh_.patches, [&](const Patch& patch) { return patch.kind == PatchKind::interface && patch.name == name; });
    };
    constexpr std::string_view k_back = ".back";  // suffix of the patch names of the other sides of discs
    std::vector<std::uint8_t> is_drawn;
    for (const Patch& patch : mesh_.patches)
      is_drawn.push_back(patch.kind == PatchKind::interface &&
                         !(patch.name.ends_with(k_back) && is_interface(std::string_view(patch.name).substr(0, patch.name.size() - k_back.size()))));
    const auto add = [&](const auto& face) {
      const Patch& patch = mesh_.patches[face.patch];
      if (is_drawn[face.patch.index()] == 0) return;
      std::vector<Point> ends;
      for (std::size_t k = 0; k < face.nodes.size(); ++k) {
        const Point &a = mesh_.points[face.nodes[k]], &b = mesh_.points[face.nodes[(k + 1) % face.nodes.size()]];
        const double from = dot(a - plane_->origin, plane_->normal), to = dot(b - plane_->origin, plane_->normal);
        if ((from >= 0.0) != (to >= 0.0)) ends.push_back(a + (from / (from - to)) * (b - a));
      }
      if (ends.size() != 2 || (plane_->limits && distance(0.5 * (ends[0] + ends[1]), plane_->limits->center) > plane_->limits->radius)) return;
      auto lines = std::ranges::find(scene_.lines, patch.name, &SceneLines::name);
      if (lines == scene_.lines.end()) lines = scene_.lines.insert(lines, {patch.name, patch_color(face.patch.index()), {}});
      lines->segments.push_back({ends[0], ends[1]});
    };
    std::ranges::for_each(mesh_.boundary_triangles, add);
    std::ranges::for_each(mesh_.boundary_quads, add);
    for (const SceneLines& lines : scene_.lines) scene_.swatches.push_back({lines.color, lines.name});
  }

  const HybridMesh& mesh_;
  bool is_surface_;
  const DrawOptions& options_;
  const RunContext& context_;
  Scene scene_;
  Coloring coloring_ = Coloring::patch;
  std::vector<std::uint8_t> is_shown_;  ///< by patch
  std::vector<std::size_t> shown_;      ///< boundary faces whose polygons are in the scene, in their order
  std::optional<CutPlane> plane_;
  std::optional<std::vector<CutLocation>> locations_;
  MeshCut cut_;
  std::vector<Point> piece_;
};

}  // namespace

Scene build_scene(const HybridMesh& mesh, bool is_surface, const DrawOptions& options, const RunContext& context) {
  return SceneBuilder(mesh, is_surface, options, context).build();
}

}  // namespace sterna::draw
