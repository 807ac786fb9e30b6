#include "volmesh/domain/complete_boundary.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/number_text.h"
#include "geom/math/measures.h"
#include "geom/mesh/bvh.h"
#include "geom/mesh/half.h"
#include "geom/mesh/topology.h"
#include "volmesh/case/ignored_requests.h"
#include "volmesh/domain/end_planes.h"
#include "volmesh/domain/farfield.h"
#include "volmesh/domain/flatten_borders.h"
#include "volmesh/domain/floor.h"
#include "volmesh/domain/shape_sizes.h"

namespace sterna::volmesh {
namespace {

constexpr const char* k_completing_attempt = "completing the boundary";
constexpr double k_shape_snap = 0.3;  ///< for HalfOptions::snap: good triangles at the open boundary of the shape matter more than keeping its own triangles

bool is_changed(const FarfieldOptions& options) {
  FarfieldOptions defaults, copy = options;
  const OptionTable table = sterna::options_of(copy), of_defaults = sterna::options_of(defaults);
  for (std::size_t i = 0; i < table.size(); ++i) {
    if (table[i].name == "farfield_sides") continue;                             // this option also applies to planes
    if (table[i].name == "farfield_edge" && copy.farfield_edge < 0.0) continue;  // such a value is a multiple of the automatic edge
    const OptionValue value = table[i].get();
    if (const auto* number = std::get_if<double>(&value)) {
      if (!is_automatic(*number)) return true;
    } else if (value != of_defaults[i].get()) {
      return true;
    }
  }
  return false;
}

/// Returns the components that reach farthest along some axis that no plane cuts. Nothing encloses these components.
std::vector<std::uint32_t> outermost(const TriMesh& mesh, const Components& components, std::span<const EndPlane> ends) {
  std::vector<std::uint32_t> result;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::any_of(ends.begin(), ends.end(), [&](const EndPlane& end) { return end.axis == k; })) continue;
    for (const double sense : {-1.0, 1.0}) {
      TriangleId farthest(0);
      double most = -1e300;
      for (const TriangleId t : mesh.triangles.ids())
        for (const Point& p : corners(mesh, t))
          if (sense * p[k] > most) {
            most = sense * p[k];
            farthest = t;
          }
      result.push_back(components.component[farthest]);
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Returns true if the surface encloses its fluid. \throws if some of the outermost components enclose the fluid and others do not
bool is_enclosing(const TriMesh& mesh, const Topology& topology, std::span<const EndPlane> ends) {
  const Components components = connected_components(mesh, topology);
  const std::vector<double> volumes = volumes_of(mesh, components, ends);
  const std::vector<std::uint32_t> outer = outermost(mesh, components, ends);
  const auto is_domain = [&](std::uint32_t c) { return volumes[c] < 0.0; };
  const auto n_domains = std::count_if(outer.begin(), outer.end(), is_domain);
  if (n_domains == 0 || n_domains == static_cast<std::ptrdiff_t>(outer.size())) return n_domains > 0;
  ErrorInfo info{.code = ErrorCode::bad_argument,
                 .attempted = k_completing_attempt,
                 .problem = "of the " + std::to_string(outer.size()) + " outermost parts " + std::to_string(n_domains) +
                            " have normals that point inwards, as the boundary of a domain; the other parts have normals that point outwards, as bodies",
                 .hint = "reverse the triangles of the wrong parts"};
  for (const TriangleId t : mesh.triangles.ids())
    if (std::find(outer.begin(), outer.end(), components.component[t]) != outer.end() && is_domain(components.component[t])) {
      info.locations.push_back({corners(mesh, t)[0], "normals inwards"});
      break;
    }
  throw Error(std::move(info));
}

/// Checks one vertex of each part that is not in the planes. This is sufficient, because preflight finds intersections.
void check_encloses(const TriMesh& surface, const Topology& topology, std::span<const EndPlane> ends, const TriMesh& shape, const RunContext& context) {
  const Components components = connected_components(surface, topology);
  const TriangleTree tree(shape, context);
  std::vector<std::uint8_t> is_seen(components.count, 0);
  ErrorInfo info{.code = ErrorCode::bad_argument,
                 .attempted = k_completing_attempt,
                 .problem = "the farfield surface does not enclose the bodies",
                 .hint = "the farfield surface must enclose all bodies; for half models it may be cut at the symmetry plane or not"};
  for (const TriangleId t : surface.triangles.ids()) {
    if (is_seen[components.component[t]] != 0) continue;
    const Point p = corners(surface, t)[0];
    if (std::any_of(ends.begin(), ends.end(), [&](const EndPlane& end) { return p[end.axis] == end.at; })) continue;
    is_seen[components.component[t]] = 1;
    if (std::abs(tree.winding_number(p)) < 0.5) info.locations.push_back({p, "this part is outside the farfield surface"});
  }
  if (!info.locations.empty()) throw Error(std::move(info));
}

void turn(TriMesh& mesh) {
  for (TriangleVertices& t : mesh.triangles) std::swap(t[1], t[2]);
}

/// Returns the user's surface with normals into the fluid. Patches of unknown kind get kind farfield.
TriMesh shape_of_user(const TriMesh& surface, const Topology& topology, const OuterOptions& options, std::span<const EndPlane> ends,
                      const RunContext& context) {
  if (!options.surface || options.surface->n_triangles() == 0)
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_completing_attempt,
                 .problem = "the farfield shape is \"surface\", but there is no surface",
                 .hint = "give farfield_surface, or farfield = a surface; .sterna files do not store the farfield surface"});
  TriMesh shape = *options.surface;
  const Topology of_shape(shape, context);
  const bool is_closed = of_shape.n_boundary_halfedges() == 0;
  const std::vector<EndPlane> its_ends = is_closed ? std::vector<EndPlane>{} : std::vector<EndPlane>(ends.begin(), ends.end());
  const Components components = connected_components(shape, of_shape);
  const std::vector<double> volumes = volumes_of(shape, components, its_ends);
  if (volumes[outermost(shape, components, its_ends).front()] > 0.0) turn(shape);
  if (is_closed) check_encloses(surface, topology, ends, shape, context);
  const bool is_unknown = options.farfield.farfield_sides.empty() &&
                          std::all_of(shape.patches.begin(), shape.patches.end(), [](const Patch& patch) { return patch.kind == PatchKind::wall; });
  if (is_unknown) {
    context.info("the farfield surface has only patches of kind wall: they become farfield; farfield_sides sets other kinds");
    for (Patch& patch : shape.patches) patch.kind = PatchKind::farfield;
  }
  return shape;
}

TriMesh make_shape(const TriMesh& surface, const Topology& topology, const OuterOptions& options, std::span<const EndPlane> ends, const RunContext& context) {
  const std::string& shape = options.farfield.farfield_shape;
  if (shape == "box") return farfield_box(surface, options.farfield, ends, context);
  if (shape == "cylinder") return farfield_cylinder(surface, options.farfield, ends, context);
  if (shape == "surface") return shape_of_user(surface, topology, options, ends, context);
  return farfield_sphere(surface, options.farfield, context, ends);
}

/// Applies the side rules to the patches of the shape. Sides without a rule are merged into one patch "farfield". Sides of equal name and kind become one
/// patch.
void apply_rules(std::span<const SideRule> rules, bool has_sides, TriMesh& shape) {
  Column<PatchId, Patch> patches;
  Column<PatchId, PatchId> old2new;
  for (Patch patch : shape.patches) {
    const auto rule = std::find_if(rules.begin(), rules.end(), [&](const SideRule& r) { return r.side == patch.name; });
    if (rule != rules.end() && (rule->has_kind || !rule->name.empty())) {
      if (rule->has_kind) patch.kind = rule->kind;
      if (!rule->name.empty()) patch.name = rule->name;
      else if (has_sides) patch.name = std::string(to_string(patch.kind));
    } else if (has_sides) {
      patch = {"farfield", PatchKind::farfield};
    }
    const auto same = std::find(patches.begin(), patches.end(), patch);
    old2new.push_back(same == patches.end() ? patches.push_back(patch) : PatchId(static_cast<std::uint64_t>(same - patches.begin())));
  }
  shape.patches = std::move(patches);
  for (PatchId& patch : shape.triangle_patch) patch = old2new[patch];
}

/// Returns the patch of the shape that covers most of a plane, unless it is a farfield patch.
const Patch* patch_in_plane(const TriMesh& shape, const EndPlane& end) {
  const double tolerance = k_coincident * bounding_box(shape).longest_side();
  std::vector<double> area(shape.patches.size(), 0.0);
  for (const TriangleId t : shape.triangles.ids()) {
    const auto [a, b, c] = corners(shape, t);
    if (std::abs(a[end.axis] - end.at) <= tolerance && std::abs(b[end.axis] - end.at) <= tolerance && std::abs(c[end.axis] - end.at) <= tolerance)
      area[shape.triangle_patch[t].index()] += triangle_area(a, b, c);
  }
  if (area.empty()) return nullptr;
  const auto most = std::max_element(area.begin(), area.end());
  const Patch& patch = shape.patches[PatchId(static_cast<std::uint64_t>(most - area.begin()))];
  return *most > 0.0 && patch.kind != PatchKind::farfield ? &patch : nullptr;
}

std::vector<Patch> default_patches(std::span<const EndPlane> ends) {
  std::vector<Patch> patches;
  for (const EndPlane& end : ends) {
    std::string name = "symmetry";
    if (ends.size() > 1) name += std::string("_") + "xyz"[end.axis];
    if (std::count_if(ends.begin(), ends.end(), [&](const EndPlane& other) { return other.axis == end.axis; }) > 1) name += end.inward > 0.0 ? "_min" : "_max";
    patches.push_back({name, PatchKind::symmetry});
  }
  return patches;
}

std::string side_of(const EndPlane& end) { return std::string(1, "xyz"[end.axis]) + (end.inward > 0.0 ? "_min" : "_max"); }

/// Merges rules for a box. A plane in which bodies end is one of the box's sides, and a rule may name either of them. \throws if rules name both
std::vector<SideRule> rules_for_box(std::vector<SideRule> rules, std::span<const EndPlane> ends) {
  const std::vector<Patch> planes = default_patches(ends);
  for (SideRule& rule : rules)
    for (std::size_t i = 0; i < ends.size(); ++i) {
      if (rule.side != planes[i].name) continue;
      const std::string side = side_of(ends[i]);
      if (std::ranges::find(rules, side, &SideRule::side) != rules.end())
        throw_bad_argument("farfield_sides", "\"" + rule.side + "\" and \"" + side + "\" are the same plane", {}, "leave one of the two rules out");
      rule.side = side;
      // The default is the same as for a plane of another shape: a plane of symmetry, unless specified otherwise.
      if (!rule.has_kind) rule.kind = PatchKind::symmetry;
      if (!rule.has_kind && rule.name.empty()) rule.name = planes[i].name;
      rule.has_kind = true;
    }
  return rules;
}

/// Patches and edge lengths of the planes. They come from the rules for the plane or for the side of the box in that plane. Without rules they come from the
/// patch of the shape in that plane; without such a patch the plane is a symmetry plane.
struct PlaneRequests {
  std::vector<Patch> patches;
  std::vector<double> edges;  ///< m, automatic if no rule sets it
};

PlaneRequests requests_of_planes(std::span<const EndPlane> ends, std::span<const SideRule> rules, const TriMesh* shape, bool is_box) {
  PlaneRequests planes{default_patches(ends), std::vector<double>(ends.size(), k_automatic)};
  for (std::size_t i = 0; i < ends.size(); ++i) {
    Patch& patch = planes.patches[i];
    const std::string name = patch.name;
    if (const Patch* in_plane = shape ? patch_in_plane(*shape, ends[i]) : nullptr) patch = *in_plane;
    for (const SideRule& rule : rules) {
      if (rule.side != name && !(is_box && rule.side == side_of(ends[i]))) continue;
      if (rule.has_kind) patch.kind = rule.kind;
      if (!rule.name.empty()) patch.name = rule.name;
      else if (rule.has_kind) patch.name = std::string(to_string(rule.kind));
      planes.edges[i] = rule.edge;
      break;
    }
  }
  return planes;
}

/// Checks that every rule names an existing side, and that edge lengths are given only for sides that are triangulated here.
void check_rules(std::span<const SideRule> rules, const TriMesh* shape, std::span<const Patch> planes, bool has_own_edges) {
  std::vector<std::string> known;
  if (shape)
    for (const Patch& patch : shape->patches) known.push_back(patch.name);
  for (const Patch& patch : planes) known.push_back(patch.name);
  for (const SideRule& rule : rules) {
    if (std::find(known.begin(), known.end(), rule.side) == known.end()) {
      std::string names;
      for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
      const std::string nearest = nearest_name(rule.side, known);
      throw_bad_argument("farfield_sides", "there is no side \"" + rule.side + "\"" + (nearest.empty() ? "" : ", did you mean \"" + nearest + "\"?"), {},
                         names.empty() ? "the surface is closed and encloses its fluid: nothing is added" : "the sides are " + names);
    }
    if (is_automatic(rule.edge) || has_own_edges || std::ranges::find(planes, rule.side, &Patch::name) != planes.end()) continue;
    throw_bad_argument("farfield_sides", "the edge length of \"" + rule.side + "\" has no effect on the triangles of this farfield", {},
                       "give farfield_edge for a sphere; a farfield surface keeps its triangles");
  }
}

/// Returns true if two of the planes are a periodic pair. Their boundary edges on a sphere would not be images of each other.
bool has_periodic_planes(std::span<const EndPlane> ends, std::span<const PeriodicNames> pairs) {
  const std::vector<Patch> planes = default_patches(ends);
  const auto is_plane = [&](const std::string& name) { return std::ranges::find(planes, name, &Patch::name) != planes.end(); };
  return std::ranges::any_of(pairs, [&](const PeriodicNames& pair) { return is_plane(pair.first) && is_plane(pair.second); });
}

/// Replaces the default sphere by a box with the same centre and extent.
void choose_box(const TriMesh& surface, std::span<const EndPlane> ends, FarfieldOptions& farfield, const RunContext& context) {
  const Vec3 middle = bounding_box(surface).center();
  const double reach = is_automatic(farfield.farfield_radius) ? k_default_radius * body_length(surface) : farfield.farfield_radius;
  const std::array center = {&farfield.farfield_center_x, &farfield.farfield_center_y, &farfield.farfield_center_z};
  const std::array from = {&farfield.farfield_from_x, &farfield.farfield_from_y, &farfield.farfield_from_z};
  const std::array to = {&farfield.farfield_to_x, &farfield.farfield_to_y, &farfield.farfield_to_z};
  for (std::size_t k = 0; k < 3; ++k) {
    const double at = is_automatic(*center[k]) ? middle[k] : *center[k];
    const auto ends_at = [&](double sense) { return std::ranges::any_of(ends, [&](const EndPlane& end) { return end.axis == k && end.inward == sense; }); };
    if (is_automatic(*from[k]) && !ends_at(1.0)) *from[k] = at - reach;
    if (is_automatic(*to[k]) && !ends_at(-1.0)) *to[k] = at + reach;
    *center[k] = k_automatic;
  }
  farfield.farfield_radius = k_automatic;
  farfield.farfield_shape = "box";
  context.info("the farfield is a box, " + in_metres(reach) +
               " around the middle of the walls: the planes are periodic sides, and their borders on a sphere would not match");
}

TriMesh cut(TriMesh shape, std::span<const EndPlane> ends, const RunContext& context) {
  for (const EndPlane& end : ends)
    shape = half_of(shape, {.axis = std::string(1, "xyz"[end.axis]), .at = end.at, .keep = end.inward > 0.0 ? "+" : "-", .snap = k_shape_snap}, context, false);
  return shape;
}

/// Appends a number to the name if the surface already has a patch of this name but of another kind.
void make_names_new(const TriMesh& surface, Patch& patch) {
  const std::string name = patch.name;
  const auto is_taken = [&] {
    return std::any_of(surface.patches.begin(), surface.patches.end(),
                       [&](const Patch& other) { return other.name == patch.name && other.kind != patch.kind; });
  };
  for (int n = 2; is_taken(); ++n) patch.name = name + "_" + std::to_string(n);
}

/// Moves open-boundary vertices exactly into the planes. A vertex on two planes is moved into both.
void snap_borders(const Constraints& borders, std::span<const EndPlane> ends, TriMesh& mesh) {
  for (const VertexId v : borders.vertex.ids())
    for (const std::int32_t k : borders.vertex[v].on)
      if (k >= 0) mesh.points[v][ends[static_cast<std::size_t>(k)].axis] = ends[static_cast<std::size_t>(k)].at;
}

void require_fluid(const FarfieldOptions& farfield, bool is_enclosed) {
  if (is_enclosed && farfield.farfield_shape != "none" && is_changed(farfield))
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_completing_attempt,
                 .problem = "a farfield is given, but the surface already encloses its fluid: the normals of its outermost part point inwards",
                 .hint = "leave the farfield out, or reverse the normals of the surface if it is a body"});
  if (!is_enclosed && farfield.farfield_shape == "none")
    throw Error({.code = ErrorCode::bad_argument,
                 .attempted = k_completing_attempt,
                 .problem = "farfield_shape is \"none\", but the surface encloses no fluid: the normals of its outermost parts point outwards, as on bodies",
                 .hint = "give a farfield; if the surface is to enclose the fluid, its normals must point inwards"});
}

/// Returns the patch of a side of the box: from the rules, otherwise a farfield patch.
Patch patch_of_side(std::span<const SideRule> rules, const std::string& side) {
  const auto rule = std::ranges::find(rules, side, &SideRule::side);
  if (rule == rules.end() || (!rule->has_kind && rule->name.empty())) return {"farfield", PatchKind::farfield};
  return {rule->name.empty() ? std::string(to_string(rule->kind)) : rule->name, rule->kind};
}

/// Adds a lid above an open sheet, and sides between the open boundary of the sheet and the lid.
TriMesh complete_over_floor(const TriMesh& surface, const Topology& topology, const FarfieldOptions& options, const RunContext& context,
                            std::vector<AddedPlane>* planes) {
  TriMesh mesh = surface;
  const FloorBox floor = fit_floor(topology, options, mesh);
  const std::vector<SideRule>& rules = options.farfield_sides;
  const std::size_t lid_side = 2 * floor.up + 1;
  TriMesh lid = box_side(floor.box, floor.edges, lid_side, context);
  std::vector<Patch> patches;
  std::vector<Patch> known = {{k_box_sides[lid_side], PatchKind::farfield}};
  std::vector<double> edges;
  for (const EndPlane& side : floor.sides) {
    const std::string name = side_of(side);
    known.push_back({name, PatchKind::farfield});
    patches.push_back(patch_of_side(rules, name));
    edges.push_back(floor.edges[2 * side.axis + (side.inward > 0.0 ? 0 : 1)]);
  }
  check_rules(rules, nullptr, known, true);
  lid.patches[PatchId(0)] = patch_of_side(rules, k_box_sides[lid_side]);
  make_names_new(surface, lid.patches[PatchId(0)]);
  for (Patch& patch : patches) make_names_new(surface, patch);
  append(mesh, lid);
  fill_ends(mesh, floor.sides, patches, edges, context);
  check_bodies_above(floor, mesh, context);
  if (planes)
    for (std::size_t i = 0; i < floor.sides.size(); ++i) planes->push_back({floor.sides[i].axis, floor.sides[i].at, floor.sides[i].inward, edges[i]});
  return mesh;
}

}  // namespace

TriMesh complete_boundary(const TriMesh& surface, const OuterOptions& options, const RunContext& context, std::vector<AddedPlane>* planes) {
  if (surface.n_triangles() == 0) throw Error({.code = ErrorCode::empty_surface, .attempted = k_completing_attempt, .problem = "the surface has no triangles"});
  const Topology topology(surface, context);
  if (!options.farfield.farfield_floor.empty()) return complete_over_floor(surface, topology, options.farfield, context, planes);
  TriMesh mesh = surface;
  flatten_borders(topology, mesh, context);
  const Constraints borders = constraints_of_borders(mesh, topology);
  const std::vector<EndPlane> ends = end_planes_of(borders);
  snap_borders(borders, ends, mesh);
  const bool is_enclosed = is_enclosing(mesh, topology, ends);
  require_fluid(options.farfield, is_enclosed);
  OuterOptions outer = options;
  if (!is_enclosed && outer.farfield.farfield_shape == "automatic" && has_periodic_planes(ends, options.periodic))
    choose_box(mesh, ends, outer.farfield, context);
  require_used_farfield(outer.farfield);
  const bool is_box = outer.farfield.farfield_shape == "box", has_sides = is_box || outer.farfield.farfield_shape == "cylinder";
  std::vector<SideRule>& rules = outer.farfield.farfield_sides;
  if (is_box) rules = rules_for_box(std::move(rules), ends);
  TriMesh shape;
  if (!is_enclosed) shape = make_shape(mesh, topology, outer, ends, context);
  check_rules(rules, &shape, default_patches(ends), has_sides);
  if (!is_enclosed) apply_rules(rules, has_sides, shape);
  PlaneRequests of_planes = requests_of_planes(ends, rules, &shape, is_box);
  shape = is_enclosed ? TriMesh{} : cut(std::move(shape), ends, context);
  for (Patch& patch : shape.patches) make_names_new(surface, patch);
  for (Patch& patch : of_planes.patches) make_names_new(surface, patch);
  append(mesh, shape);
  if (!ends.empty()) fill_ends(mesh, ends, of_planes.patches, of_planes.edges, context);
  if (planes)
    for (std::size_t i = 0; i < ends.size(); ++i) planes->push_back({ends[i].axis, ends[i].at, ends[i].inward, of_planes.edges[i]});
  return mesh;
}

std::vector<OpenBorderPlane> open_border_planes_of(const TriMesh& surface, const RunContext& context) {
  const Topology topology(surface, context);
  TriMesh mesh = surface;
  flatten_borders(topology, mesh, context);
  const Constraints borders = constraints_of_borders(mesh, topology);
  const std::vector<EndPlane> ends = end_planes_of(borders);
  std::vector<OpenBorderPlane> planes;
  const Box box = bounding_box(mesh);
  for (const EndPlane& end : ends) planes.push_back({.axis = end.axis, .at = end.at, .is_above = end.inward > 0.0, .border = {}, .covered = 0.0});
  for (const VertexId v : borders.vertex.ids())
    for (const std::int32_t k : borders.vertex[v].on)
      if (k >= 0) planes[static_cast<std::size_t>(k)].border.add(mesh.points[v]);
  const double tolerance = k_border_tolerance * box.longest_side();
  for (const TriangleId t : mesh.triangles.ids()) {
    const auto c = corners(mesh, t);
    for (OpenBorderPlane& plane : planes)
      if (std::ranges::all_of(c, [&](const Point& p) { return std::abs(p[plane.axis] - plane.at) <= tolerance; }))
        plane.covered += triangle_area(c[0], c[1], c[2]);
  }
  return planes;
}

bool is_farfield_given(const FarfieldOptions& options) { return options.farfield_shape != "none" && is_changed(options); }

std::int64_t turn_to_bodies(TriMesh& surface, const RunContext& context) {
  const Topology topology(surface, context);
  if (topology.n_boundary_halfedges() == 0) return 0;
  TriMesh mesh = surface;
  flatten_borders(topology, mesh, context);
  const Constraints borders = constraints_of_borders(mesh, topology);
  const std::vector<EndPlane> ends = end_planes_of(borders);
  snap_borders(borders, ends, mesh);
  const Components components = connected_components(mesh, topology);
  const std::vector<double> volumes = volumes_of(mesh, components, ends);
  const std::vector<std::uint32_t> outer = outermost(mesh, components, ends);
  std::vector<std::uint8_t> is_turned(components.count, 0);
  std::int64_t n = 0;
  for (const std::uint32_t c : outer) {
    is_turned[c] = volumes[c] < 0.0;
    n += is_turned[c];
  }
  if (n == 0) return 0;
  std::vector<Box> boxes(components.count);
  for (const TriangleId t : mesh.triangles.ids())
    for (const Point& p : corners(mesh, t)) boxes[components.component[t]].add(p);
  for (std::uint32_t inner = 0; inner < components.count; ++inner)
    for (const std::uint32_t c : outer) {
      if (is_turned[c] == 0 || inner == c) continue;
      bool is_within = true;
      for (std::size_t k = 0; k < 3; ++k) is_within &= boxes[inner].min[k] >= boxes[c].min[k] && boxes[inner].max[k] <= boxes[c].max[k];
      if (is_within) return 0;
    }
  for (const TriangleId t : surface.triangles.ids())
    if (is_turned[components.component[t]] != 0) std::swap(surface.triangles[t][1], surface.triangles[t][2]);
  return n;
}

}  // namespace sterna::volmesh
