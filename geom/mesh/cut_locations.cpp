#include "geom/mesh/cut_locations.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geom/math/measures.h"
#include "geom/mesh/wall_sections.h"

namespace sterna {
namespace {

/// Fraction of the half span at which a wing is cut: outboard of engines and kinks, inboard of the tip.
constexpr double k_station = 0.55;
/// Fraction of the half span to the neighbouring sections that give the direction of the wing's edges.
constexpr double k_station_step = 0.02;
/// Smallest cosine between a wing's edge and the span. If the line between edges of two sections has a smaller one, the sections belong to different bodies.
constexpr double k_most_swept = 0.3;
/// Largest thickness over length of a wing section; airfoils have up to 0.25, nacelles and fuselages more.
constexpr double k_wing_thickness = 0.4;
/// Thinner sections belong to plates without a free edge, such as a tunnel floor.
constexpr double k_plate_thickness = 1e-3;
/// Sections shorter than this fraction of the longest one at the station belong to pylons, flap tracks, antennas.
constexpr double k_least_chord = 0.3;
/// Edges that turn by more than this angle are sharp, radians.
constexpr double k_sharp_cut = std::numbers::pi / 6.0;
/// Distance of the cut from the symmetry plane, inwards, over the walls' longest side. It is above the rounding of coordinates and far below an edge length.
constexpr double k_hair = 1e-7;
/// Radius of the region of interest around a focus: k_layers_seen times the layer height, and at least k_edges_seen times the wall edge length.
constexpr double k_layers_seen = 3.0, k_edges_seen = 6.0;
/// A body is complete if the offset of its box from the plane y = 0 is less than this fraction of its width.
constexpr double k_whole = 0.02;

class LocationFinder {
 public:
  LocationFinder(const HybridMesh& mesh, const WallSections& walls) : mesh_(mesh), walls_(walls) {
    const Vec3 extent = walls.box().max - walls.box().min;
    size_ = walls.box().longest_side();
    span_ = extent.z > extent.y ? 2 : 1;
    flow_ = extent.x > 0.0 ? 0 : span_;
  }

  std::vector<CutLocation> find() {
    add_symmetry();
    add_wing();
    if (!add_chain("junction", true, true)) add_chain("junction", true, false);
    if (!has_wing_) add_chain("sharp edge", false, false);
    add_nose();
    for (const double share : {0.25, 0.5, 0.75}) add_section(share);
    return std::move(locations_);
  }

 private:
  static Vec3 unit(std::size_t axis) {
    Vec3 v;
    v[axis] = 1.0;
    return v;
  }
  double low(std::size_t axis) const { return walls_.box().min[axis]; }
  double high(std::size_t axis) const { return walls_.box().max[axis]; }

  /// Adds a plane if it crosses walls, with the whole section in view.
  bool add_whole(std::string name, const Point& origin, const Vec3& normal) {
    Box box;
    for (const SectionPiece& piece : walls_.section(origin, normal)) box.add(piece.box);
    if (box.empty()) return false;
    Point focus = box.center();
    focus -= dot(focus - origin, normal) * normal;
    locations_.push_back({std::move(name), {origin, normal, std::nullopt}, focus, 0.5 * distance(box.min, box.max) + k_layers_seen * walls_.layer_near(focus)});
    return true;
  }

  /// Adds a plane through a point of the walls, with the surroundings of the point in view.
  bool add_close(std::string name, const Point& at, const Vec3& normal) {
    for (const double sense : {1.0, -1.0}) {
      if (walls_.section(at, sense * normal).empty()) continue;
      const double radius = std::max(k_layers_seen * walls_.layer_near(at), k_edges_seen * walls_.edge_near(at));
      locations_.push_back({std::move(name), {at, sense * normal, std::nullopt}, at, std::min(radius, size_)});
      return true;
    }
    return false;
  }

  void add_symmetry() {
    Vec3 normal, middle;
    double area = 0.0;
    const auto add = [&](const auto& face, const Vec3& vector) {
      if (face.patch.index() >= mesh_.patches.size() || mesh_.patches[face.patch].kind != PatchKind::symmetry) return;
      if (area > 0.0 && dot(vector, normal) < 0.5 * norm(vector) * norm(normal)) return;  // this face belongs to a different plane than the first one
      normal += vector;
      middle += norm(vector) * mesh_.points[face.nodes[0]];
      area += norm(vector);
    };
    const auto& p = mesh_.points;
    for (const BoundaryTriangle& face : mesh_.boundary_triangles) add(face, area_vector(p[face.nodes[0]], p[face.nodes[1]], p[face.nodes[2]]));
    for (const BoundaryQuad& face : mesh_.boundary_quads) add(face, 0.5 * cross(p[face.nodes[2]] - p[face.nodes[0]], p[face.nodes[3]] - p[face.nodes[1]]));
    if (area > 0.0) {
      const Vec3 out = normalized(normal);
      if (add_whole("symmetry plane", middle / area - k_hair * size_ * out, out)) return;
    }
    Point at = walls_.box().center();
    if (is_whole()) at[span_] = 0.0;
    add_whole("middle plane", at, unit(span_));
  }

  /// Returns true if the walls extend equally to both sides of the plane span = 0.
  bool is_whole() const { return std::abs(low(span_) + high(span_)) < k_whole * (high(span_) - low(span_)); }

  /// Returns the flattest piece of the section at a station that may be a wing section.
  std::optional<SectionPiece> wing_at(double station) const {
    Point at = walls_.box().center();
    at[span_] = station;
    const std::vector<SectionPiece> pieces = walls_.section(at, unit(span_));
    double longest = 0.0;
    for (const SectionPiece& piece : pieces) longest = std::max(longest, chord(piece));
    const SectionPiece* wing = nullptr;
    for (const SectionPiece& piece : pieces) {
      if (chord(piece) < k_least_chord * longest || thickness(piece) > k_wing_thickness * chord(piece) || thickness(piece) < k_plate_thickness * chord(piece))
        continue;
      if (wing == nullptr || thickness(piece) * chord(*wing) < thickness(*wing) * chord(piece)) wing = &piece;
    }
    return wing && longest > 0.0 ? std::optional(*wing) : std::nullopt;
  }
  static double chord(const SectionPiece& piece) { return piece.box.max.x - piece.box.min.x; }
  double thickness(const SectionPiece& piece) const { return piece.box.max[3 - span_] - piece.box.min[3 - span_]; }

  /// Returns the wing's first (sense -1) or last point along x.
  static Point end_of(const SectionPiece& wing, double sense) {
    Point best = wing.segments.front()[0];
    for (const auto& segment : wing.segments)
      for (const Point& p : segment)
        if (sense * p.x > sense * best.x) best = p;
    return best;
  }

  void add_wing() {
    const bool is_left = !is_whole() && std::abs(low(span_)) > std::abs(high(span_));
    const double root = is_whole() ? 0.0 : is_left ? high(span_) : low(span_), tip = is_left ? low(span_) : high(span_);
    const double station = root + k_station * (tip - root), step = k_station_step * (tip - root);
    const auto wing = wing_at(station), before = wing_at(station - step), behind = wing_at(station + step);
    if (!wing) return;
    has_wing_ = true;
    const auto add_edge = [&](std::string name, double sense) {
      Point at = end_of(*wing, sense);
      at[span_] = station;
      // The plane is perpendicular to the edge, along which cells are stretched: a plane along the flow would cut swept edges obliquely.
      const Vec3 along = before && behind ? end_of(*behind, sense) - end_of(*before, sense) : unit(span_);
      add_close(std::move(name), at, std::abs(normalized(along)[span_]) > k_most_swept ? normalized(along) : unit(span_));
    };
    add_edge("leading edge", -1.0);
    add_edge("trailing edge", 1.0);
    add_close("tip", walls_.point(walls_.extreme_node(is_left ? -unit(span_) : unit(span_))), unit(0));
  }

  /// Adds a plane perpendicular to the middle edge of a chain. The middle is found by x.
  bool add_chain(std::string name, bool is_concave, bool between_patches) {
    EdgeChain chain = walls_.longest_chain(k_sharp_cut, is_concave, between_patches);
    if (chain.edges.empty()) return false;
    const auto middle = [&](const std::array<std::uint32_t, 2>& edge) { return 0.5 * (walls_.point(edge[0]) + walls_.point(edge[1])); };
    const auto half = chain.edges.begin() + static_cast<std::ptrdiff_t>(chain.edges.size() / 2);
    std::nth_element(chain.edges.begin(), half, chain.edges.end(), [&](const auto& a, const auto& b) {
      const Point p = middle(a), q = middle(b);
      return p.x != q.x ? p.x < q.x : a < b;
    });
    return add_close(std::move(name), middle(*half), normalized(walls_.point((*half)[1]) - walls_.point((*half)[0])));
  }

  void add_nose() {
    const Point at = walls_.point(walls_.extreme_node(-unit(flow_)));
    add_close("nose", at, unit(flow_ == span_ ? 3 - span_ : span_));
  }

  void add_section(double share) {
    const std::string name = "section " + std::to_string(static_cast<int>(100.0 * share)) + "%";
    Point at = walls_.box().center();
    at[flow_] = low(flow_) + share * (high(flow_) - low(flow_));
    if (!add_whole(name, at, unit(flow_))) add_whole(name, walls_.nearest_to(at, unit(flow_)), unit(flow_));
  }

  const HybridMesh& mesh_;
  const WallSections& walls_;
  std::size_t span_ = 1, flow_ = 0;
  double size_ = 0.0;
  bool has_wing_ = false;
  std::vector<CutLocation> locations_;
};

}  // namespace

std::vector<CutLocation> automatic_cuts(const HybridMesh& mesh, const RunContext& context) {
  const WallSections walls(mesh, context);
  if (walls.empty()) return {};
  return LocationFinder(mesh, walls).find();
}

Vec3 symmetry_normal(const HybridMesh& mesh) {
  Vec3 out;
  const auto add = [&](const auto& face, const Vec3& area) {
    if (mesh.patches[face.patch].kind == PatchKind::symmetry) out += area;
  };
  const auto& p = mesh.points;
  for (const BoundaryTriangle& face : mesh.boundary_triangles) add(face, area_vector(p[face.nodes[0]], p[face.nodes[1]], p[face.nodes[2]]));
  for (const BoundaryQuad& face : mesh.boundary_quads) add(face, 0.5 * cross(p[face.nodes[2]] - p[face.nodes[0]], p[face.nodes[3]] - p[face.nodes[1]]));
  return norm(out) > 0.0 ? normalized(out) : out;
}

}  // namespace sterna
