// Steps: triangulate every part, with parameters. For each pair of parts whose boxes are near, look for crossing triangles and their angles, else for the
// nearest points, else test if one part is inside the other. Collect groups of connected parts, and find the gaps between groups. Estimate the fraction of each
// part that lies outside all others.
#include "geom/cad/find_contacts.h"

#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Poly_Triangulation.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>

#include "geom/base/number_text.h"
#include "geom/base/parallel.h"
#include "geom/cad/occt_call.h"
#include "geom/cad/occt_shape.h"
#include "geom/math/intersect.h"
#include "geom/math/nearest.h"
#include "geom/mesh/bvh.h"
#include "geom/model/projection.h"

namespace sterna::cad {
namespace {

/// Deviation of the triangles from the surface, relative to the part's longest side: a wing's thickness is twenty times larger.
constexpr double k_deflection = 1e-3;
/// Largest angle by which the surface turns within a triangle, radians: a leading edge has a few triangles around it.
constexpr double k_turn = 0.5;
/// Parts nearer than this fraction of the larger part's size touch: the first fuzzy tolerances of the union close the gap.
constexpr double k_touch = 1e-6;
/// Number of alternating projections that refine a distance; each at least halves the error on surfaces that are not parallel.
constexpr int k_rounds = 30;
/// Overhang up to which a body counts as standing on a container's wall, relative to the body's longest side.
constexpr double k_standing = 1e-4;
/// Longest side of the sampled pieces, relative to the part's longest side.
constexpr double k_sample = 1.0 / 48.0;
/// Direction of the rays of the inside test. It lies along no axis and in no plane that is common in aircraft.
constexpr Vec3 k_ray{0.2872, 0.5417, 0.7900};
/// Ray hits nearer to each other than this, relative to the part's size, count once, because a ray through an edge hits both of its triangles.
constexpr double k_same_hit = 1e-12;
/// Crossing pairs of facets per chunk.
constexpr std::size_t k_chunk = 64;
constexpr int k_digits = 4;  ///< significant digits of numbers in messages

using Facet = std::array<Point, 3>;

/// Triangulation of a part, each triangle with its face and the parameters of its corners.
struct Skin {
  const Model* model = nullptr;
  TriMesh mesh;
  std::vector<Uv> at;                      ///< parameters of the vertices
  std::vector<FaceId> face_of;             ///< face of each triangle
  std::vector<std::uint32_t> triangle_at;  ///< per vertex: one of its triangles
  std::unique_ptr<TriangleTree> tree;
  Box box;
  double deflection = 0.0;
  double area = 0.0;

  Facet facet(std::uint32_t t) const { return corners(mesh, TriangleId(t)); }
};

double area_of(const Facet& f) { return 0.5 * norm(cross(f[1] - f[0], f[2] - f[0])); }

void add_face(Skin& skin, FaceId id, const TopoDS_Face& face) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation)& triangles = BRep_Tool::Triangulation(face, location);
  const ModelFace& from = skin.model->faces[id];
  if (triangles.IsNull() || !triangles->HasUVNodes()) {
    const Point at = location_of(face);
    throw Error({.code = ErrorCode::geometry_failed,
                 .attempted = "finding the contacts of \"" + part_name(*skin.model) + "\"",
                 .problem = "OpenCASCADE cannot triangulate a face",
                 .locations = {{at, "\"" + from.name + "\""}},
                 .hint = "draw the face again in CAD, or leave its part out of the union; if memory is limited (ulimit -v), allow more"});
  }
  const auto first = static_cast<std::uint64_t>(skin.mesh.points.size());
  for (int i = 1; i <= triangles->NbNodes(); ++i) {
    const gp_Pnt2d at = triangles->UVNode(i);
    skin.at.push_back({at.X(), at.Y()});
    const gp_Pnt p = triangles->Node(i).Transformed(location.Transformation());
    skin.mesh.points.push_back({p.X(), p.Y(), p.Z()});
  }
  skin.triangle_at.resize(skin.at.size());
  for (int i = 1; i <= triangles->NbTriangles(); ++i) {
    int a = 0, b = 0, c = 0;
    triangles->Triangle(i).Get(a, b, c);
    if (from.is_reversed) std::swap(b, c);
    const auto vertex = [&](int n) { return VertexId(first + static_cast<std::uint64_t>(n - 1)); };
    for (const VertexId v : {vertex(a), vertex(b), vertex(c)}) skin.triangle_at[v.index()] = static_cast<std::uint32_t>(skin.mesh.triangles.size());
    skin.mesh.triangles.push_back({vertex(a), vertex(b), vertex(c)});
    skin.face_of.push_back(id);
  }
}

Skin skin_of(const Model& part, const RunContext& context) {
  Skin skin;
  skin.model = &part;
  const std::shared_ptr<const CadShape> shape = shape_of(part, context);
  const CadShape::Content& content = shape->content();
  run_occt({.attempted = "finding the contacts of \"" + part_name(part) + "\""}, context, [&](const Message_ProgressRange&) {
    skin.deflection = k_deflection * longest_side(content.shape);
    BRepBuilderAPI_Copy copy(content.shape, false, false);  // triangulations are stored in the shape: the copy leaves ours unchanged
    const BRepMesh_IncrementalMesh mesher(copy.Shape(), skin.deflection, false, k_turn, context.threads() > 1);
    for (const FaceId f : part.faces.ids()) add_face(skin, f, TopoDS::Face(copy.ModifiedShape(content.faces[f.index()])));
  });
  skin.tree = std::make_unique<TriangleTree>(skin.mesh, context);
  skin.box = bounding_box(skin.mesh);
  for (std::uint32_t t = 0; t < skin.mesh.n_triangles(); ++t) skin.area += area_of(skin.facet(t));
  return skin;
}

Box widened(Box box, double by) {
  box.min -= Vec3{by, by, by};
  box.max += Vec3{by, by, by};
  return box;
}

Box box_of(const Facet& facet) {
  Box box;
  for (const Point& p : facet) box.add(p);
  return box;
}

/// Returns the parameters of a point near a triangle, interpolated from those of its corners.
Uv parameters(const Skin& skin, std::uint32_t t, const Point& p) {
  const Facet f = skin.facet(t);
  const TriangleVertices& v = skin.mesh.triangles[TriangleId(t)];
  const Vec3 normal = cross(f[1] - f[0], f[2] - f[0]);
  const double n2 = norm2(normal);
  if (n2 == 0.0) return skin.at[v[0].index()];
  const double b = dot(cross(p - f[0], f[2] - f[0]), normal) / n2, c = dot(cross(f[1] - f[0], p - f[0]), normal) / n2;
  const Uv &p0 = skin.at[v[0].index()], &p1 = skin.at[v[1].index()], &p2 = skin.at[v[2].index()];
  return {p0.u + b * (p1.u - p0.u) + c * (p2.u - p0.u), p0.v + b * (p1.v - p0.v) + c * (p2.v - p0.v)};
}

/// Returns the outward unit normal of the surface; empty at a pole.
std::optional<Vec3> normal_at(const Skin& skin, std::uint32_t t, const Point& p) {
  const ModelFace& face = skin.model->faces[skin.face_of[t]];
  const SurfaceDerivatives d = face.surface->derivatives(parameters(skin, t, p));
  const Vec3 n = cross(d.du, d.dv);
  if (norm2(n) <= 1e-20 * norm2(d.du) * norm2(d.dv) || norm2(n) == 0.0) return std::nullopt;
  return face.is_reversed ? -normalized(n) : normalized(n);
}

/// Returns the centre of the intersection of two crossing triangles, estimated from the piercing edges.
Point common_location(const Facet& a, const Facet& b) {
  Point sum;
  int n = 0;
  const auto add = [&](const Facet& edges, const Facet& plane) {
    const Vec3 normal = cross(plane[1] - plane[0], plane[2] - plane[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const Point &p = edges[i], &q = edges[(i + 1) % 3];
      const double from = dot(normal, p - plane[0]), to = dot(normal, q - plane[0]);
      if (from == to || (from > 0.0) == (to > 0.0)) continue;
      const Point at = p + from / (from - to) * (q - p);
      if (norm2(nearest_on_triangle(at, plane) - at) > 1e-12 * norm2(q - p)) continue;
      sum += at;
      ++n;
    }
  };
  add(a, b);
  add(b, a);
  return n > 0 ? sum / n : (a[0] + a[1] + a[2]) / 3.0;  // coplanar
}

/// The crossing with the smallest angle among some triangles.
struct Flattest {
  bool is_found = false;  ///< at least one crossing exists
  double angle = 0.5 * std::numbers::pi;
  bool is_crevice = false;
  Point location;
  void add(const Flattest& other) {
    if (other.is_found && (!is_found || other.angle < angle)) *this = other;
  }
};

Flattest crossings(const Skin& a, const Skin& b, const RunContext& context) {
  return parallel_reduce(
      context, a.mesh.n_triangles(), Flattest{},
      [&](std::size_t begin, std::size_t end) {
        Flattest flattest;
        for (std::size_t i = begin; i < end; ++i) {
          const auto t = static_cast<std::uint32_t>(i);
          const Facet facet = a.facet(t);
          b.tree->boxes().for_each_overlap(box_of(facet), [&](std::uint32_t s) {
            const Facet other = b.facet(s);
            if (!triangles_intersect(facet, other)) return true;
            const Point location = common_location(facet, other);
            const std::optional<Vec3> n = normal_at(a, t, location), m = normal_at(b, s, location);
            Flattest here{.is_found = true, .location = location};
            if (n && m) {
              const double between = angle_between(*n, *m);
              here.is_crevice = between > 0.5 * std::numbers::pi;
              here.angle = std::min(between, std::numbers::pi - between);
            }
            flattest.add(here);
            return true;
          });
        }
        return flattest;
      },
      [](Flattest one, const Flattest& other) {
        one.add(other);
        return one;
      },
      k_chunk);
}

/// Calls visit(middle, area) for pieces of a triangle whose longest sides are at most `size`.
template <class Visit>
void visit_pieces(const Facet& facet, double size, const Visit& visit) {
  std::vector<Facet> stack{facet};
  while (!stack.empty()) {
    const Facet f = stack.back();
    stack.pop_back();
    std::size_t longest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (norm2(f[(i + 1) % 3] - f[i]) > norm2(f[(longest + 1) % 3] - f[longest])) longest = i;
    const Point &p = f[longest], &q = f[(longest + 1) % 3], &r = f[(longest + 2) % 3];
    if (norm2(q - p) <= size * size) {
      visit((p + q + r) / 3.0, area_of(f));
      continue;
    }
    const Point middle = 0.5 * (p + q);
    stack.push_back({p, middle, r});
    stack.push_back({middle, q, r});
  }
}

/// Returns true if a ray from the point leaves the part more often than it enters it. May be wrong where rays graze the part.
bool is_inside(const Skin& skin, const Point& p) {
  const double same = k_same_hit * skin.deflection / k_deflection;
  int depth = 0, last_sign = 0;
  double last = -1.0;
  for (const TriangleTree::RayHit& hit : skin.tree->ray(p, k_ray)) {
    const Facet f = corners(skin.mesh, hit.triangle);
    const int sign = dot(cross(f[1] - f[0], f[2] - f[0]), k_ray) > 0.0 ? 1 : -1;
    if (sign == last_sign && hit.t - last < same) continue;
    depth += sign;
    last = hit.t;
    last_sign = sign;
  }
  return depth > 0;
}

/// The face of a container nearest to an outside point.
struct WayOut {
  FaceId face;
  double distance = 0.0;
};

/// Returns the way from the container's surface to a point outside. Returns nothing if the point is inside the container, also if it is only inside the exact
/// surface but outside the triangulation.
std::optional<WayOut> way_out(const Skin& container, const Point& p) {
  if (is_inside(container, p)) return std::nullopt;
  const NearestHit hit = container.tree->nearest(p);
  const std::uint32_t t = hit.triangle.value();
  const FaceId id = container.face_of[t];
  const Vec3 out = p - container.model->faces[id].surface->derivatives(parameters(container, t, hit.point)).point;
  if (norm(p - hit.point) <= container.deflection) {
    const std::optional<Vec3> normal = normal_at(container, t, hit.point);
    if (normal && dot(out, *normal) <= 0.0) return std::nullopt;
  }
  return WayOut{id, norm(out)};
}

/// Areas of a part: outside all other parts, inside each of them, and too near to a surface to decide.
struct Shares {
  double outside = 0.0, unsure = 0.0;
  std::vector<double> inside;  ///< per other part: area inside it
  void add(const Shares& other) {
    outside += other.outside;
    unsure += other.unsure;
    for (std::size_t i = 0; i < inside.size(); ++i) inside[i] += other.inside[i];
  }
};

/// Samples part i; `near`: the parts whose boxes overlap its box.
Shares shares_of(const std::vector<Skin>& skins, std::size_t i, const std::vector<std::size_t>& near, const RunContext& context) {
  const Skin& skin = skins[i];
  const double size = k_sample * skin.deflection / k_deflection;
  Shares none;
  none.inside.assign(skins.size(), 0.0);
  Shares total = parallel_reduce(
      context, skin.mesh.n_triangles(), none,
      [&](std::size_t begin, std::size_t end) {
        Shares sum = none;
        for (std::size_t t = begin; t < end; ++t) {
          const Facet facet = skin.facet(static_cast<std::uint32_t>(t));
          const Box box = box_of(facet);
          if (std::none_of(near.begin(), near.end(), [&](std::size_t j) { return overlap(box, skins[j].box); })) {
            sum.outside += area_of(facet);
            continue;
          }
          visit_pieces(facet, size, [&](const Point& middle, double area) {
            bool is_within = false, is_near = false;
            for (const std::size_t j : near) {
              if (!overlap(skins[j].box, {middle, middle})) continue;
              if (is_inside(skins[j], middle)) {
                sum.inside[j] += area;
                is_within = true;
              }
              if (skins[j].tree->nearest(middle, skin.deflection + skins[j].deflection).triangle.is_valid()) is_near = true;
            }
            if (is_near) sum.unsure += area;
            else if (!is_within) sum.outside += area;
          });
        }
        return sum;
      },
      [](Shares one, const Shares& other) {
        one.add(other);
        return one;
      },
      k_chunk);
  return total;
}

struct Nearest {
  double distance = std::numeric_limits<double>::infinity();
  Point a, b;
  std::uint32_t triangle_a = 0, triangle_b = 0;
};

/// Returns the box of the parameters of all corners of a face's triangles.
ParameterBox box_of_face(const Skin& skin, FaceId face) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  ParameterBox box{{inf, -inf}, {inf, -inf}};
  for (std::uint32_t t = 0; t < skin.mesh.n_triangles(); ++t) {
    if (skin.face_of[t] != face) continue;
    for (const VertexId v : skin.mesh.triangles[TriangleId(t)]) {
      const Uv& at = skin.at[v.index()];
      box.u = {std::min(box.u.from, at.u), std::max(box.u.to, at.u)};
      box.v = {std::min(box.v.from, at.v), std::max(box.v.to, at.v)};
    }
  }
  return box;
}

/// Finds the nearest points of two parts: first among the corners of the triangles, then by alternating projections between the surfaces.
Nearest nearest_locations(const Skin& a, const Skin& b, double limit, const RunContext& context) {
  Nearest best;
  const auto look = [&](const Skin& from, const Skin& to, bool is_swapped) {
    for (const VertexId v : from.mesh.points.ids()) {
      if (v.index() % 1024 == 0) context.check_stop();
      const Point& p = from.mesh.points[v];
      const NearestHit hit = to.tree->nearest(p, std::min(limit, best.distance));
      if (!hit.triangle.is_valid() || hit.distance >= best.distance) continue;
      const std::uint32_t own = from.triangle_at[v.index()];
      const auto other = static_cast<std::uint32_t>(hit.triangle.index());
      best = is_swapped ? Nearest{hit.distance, hit.point, p, other, own} : Nearest{hit.distance, p, hit.point, own, other};
    }
  };
  look(a, b, false);
  look(b, a, true);
  if (!std::isfinite(best.distance)) return best;
  const FaceId face_a = a.face_of[best.triangle_a], face_b = b.face_of[best.triangle_b];
  const SurfaceProjector on_a(a.model->faces[face_a].surface, box_of_face(a, face_a)), on_b(b.model->faces[face_b].surface, box_of_face(b, face_b));
  SurfaceProjection projection_a{parameters(a, best.triangle_a, best.a), best.a, 0.0}, projection_b{parameters(b, best.triangle_b, best.b), best.b, 0.0};
  for (int i = 0; i < k_rounds; ++i) {
    projection_b = on_b.seeded(projection_a.point, projection_b.at);
    projection_a = on_a.seeded(projection_b.point, projection_a.at);
  }
  best.a = projection_a.point;
  best.b = projection_b.point;
  best.distance = distance(best.a, best.b);
  return best;
}

/// Returns the contact of two parts whose boxes are near; nothing if they are apart.
std::optional<PartContact> contact_of(const std::vector<Skin>& skins, std::size_t i, std::size_t j, const RunContext& context) {
  const Skin &a = skins[i], &b = skins[j];
  const double reach = 2.0 * (a.deflection + b.deflection);
  if (!overlap(widened(a.box, reach), b.box)) return std::nullopt;
  PartContact contact{.first = i, .second = j};
  if (const Flattest flattest = crossings(a, b, context); flattest.is_found) {
    contact.location = flattest.location;
    contact.angle = flattest.angle;
    contact.is_crevice = flattest.is_crevice;
    return contact;
  }
  const double touch = k_touch * std::max(a.deflection, b.deflection) / k_deflection;
  if (const Nearest nearest = nearest_locations(a, b, reach, context); nearest.distance <= touch) {
    contact.kind = ContactKind::touching;
    contact.location = 0.5 * (nearest.a + nearest.b);
    return contact;
  }
  for (const bool is_swapped : {false, true}) {
    const Skin &inner = is_swapped ? b : a, &outer = is_swapped ? a : b;
    const Point p = inner.facet(0)[0];
    if (outer.tree->winding_number(p) <= 0.5) continue;
    contact.kind = ContactKind::inside;
    contact.location = p;
    if (is_swapped) std::swap(contact.first, contact.second);
    return contact;
  }
  return std::nullopt;
}

/// Returns for each part the first part of its group.
std::vector<std::size_t> groups_of(std::size_t n, const std::vector<PartContact>& contacts) {
  std::vector<std::size_t> group(n);
  std::iota(group.begin(), group.end(), std::size_t{0});
  for (const PartContact& contact : contacts) {
    const std::size_t a = group[contact.first], b = group[contact.second];
    for (std::size_t& g : group)
      if (g == std::max(a, b)) g = std::min(a, b);
  }
  return group;
}

/// Connects group by group with its nearest neighbour, starting with the first group that does not contain the largest part, until all are one.
void add_gaps(const std::vector<Skin>& skins, std::vector<PartContact>& contacts, const RunContext& context) {
  const auto largest =
      static_cast<std::size_t>(std::max_element(skins.begin(), skins.end(), [](const Skin& a, const Skin& b) { return a.area < b.area; }) - skins.begin());
  for (;;) {
    const std::vector<std::size_t> group = groups_of(skins.size(), contacts);
    const auto apart = std::find_if(group.begin(), group.end(), [&](std::size_t g) { return g != group[largest]; });
    if (apart == group.end()) return;
    PartContact contact{.kind = ContactKind::apart, .gap = std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < skins.size(); ++i)
      for (std::size_t j = 0; j < skins.size() && group[i] == *apart; ++j) {
        if (group[j] == *apart) continue;
        const Nearest nearest = nearest_locations(skins[i], skins[j], contact.gap, context);
        if (nearest.distance >= contact.gap) continue;
        contact.first = i;
        contact.second = j;
        contact.gap = nearest.distance;
        contact.location = 0.5 * (nearest.a + nearest.b);
      }
    contacts.push_back(contact);
  }
}

void add_exposures(const std::vector<Skin>& skins, ContactReport& report, const RunContext& context) {
  for (std::size_t i = 0; i < skins.size(); ++i) {
    std::vector<std::size_t> near;
    for (std::size_t j = 0; j < skins.size(); ++j)
      if (j != i && overlap(skins[i].box, skins[j].box)) near.push_back(j);
    const Shares shares = shares_of(skins, i, near, context);
    const double area = std::max(skins[i].area, std::numeric_limits<double>::min());
    report.exposures.push_back({shares.outside / area, shares.unsure / area});
    for (PartContact& contact : report.contacts) {
      if (contact.kind != ContactKind::crossing || (contact.first != i && contact.second != i)) continue;
      const double share = shares.inside[contact.first == i ? contact.second : contact.first] / area;
      if (share <= contact.share_inside) continue;
      contact.share_inside = share;
      contact.is_first_inside = contact.first == i;
    }
  }
}

}  // namespace

std::string part_name(const Model& part) { return part.components.empty() ? std::string("unnamed") : part.components.raw().front().name; }

ContactReport find_contacts(std::span<const Model> parts, const RunContext& context) {
  std::vector<Skin> skins;
  for (const Model& part : parts) skins.push_back(skin_of(part, context));
  ContactReport report;
  for (std::size_t i = 0; i < skins.size(); ++i)
    for (std::size_t j = i + 1; j < skins.size(); ++j) {
      context.check_stop();
      if (const std::optional<PartContact> contact = contact_of(skins, i, j, context)) report.contacts.push_back(*contact);
    }
  add_exposures(skins, report, context);
  add_gaps(skins, report.contacts, context);
  return report;
}

std::vector<Overhang> find_overhangs(const Model& container, std::span<const Model> bodies, const RunContext& context) {
  const Skin around = skin_of(container, context);
  std::vector<Overhang> found;
  for (const Model& body : bodies) {
    const Skin skin = skin_of(body, context);
    const double tolerance = k_standing * skin.deflection / k_deflection, size = k_sample * skin.deflection / k_deflection;
    std::map<std::pair<ComponentId, std::string>, Overhang> of_body;
    for (std::uint32_t t = 0; t < skin.mesh.n_triangles(); ++t) {
      context.check_stop();
      const ModelFace& face = body.faces[skin.face_of[t]];
      const auto look = [&](const Point& p) {
        const std::optional<WayOut> out = way_out(around, p);
        if (!out || out->distance <= tolerance) return;
        Overhang& most = of_body[{face.component, face.name}];
        if (out->distance <= most.distance) return;
        const Component& component = body.components[face.component];
        most = {component.name, component.kind, face.name, container.faces[out->face].name, p, out->distance};
      };
      const Facet facet = skin.facet(t);
      for (const Point& p : facet) look(p);
      visit_pieces(facet, size, [&](const Point& middle, double) { look(middle); });
    }
    for (auto& [where, overhang] : of_body) found.push_back(std::move(overhang));
  }
  return found;
}

std::string doubt_of(const PartContact& contact, std::span<const Model> parts) {
  const std::string first = "\"" + part_name(parts[contact.first]) + "\"", second = "\"" + part_name(parts[contact.second]) + "\"";
  const std::string both = first + " and " + second;
  switch (contact.kind) {
    case ContactKind::apart: return both + " are apart by " + number_text(contact.gap, k_digits) + " m";
    case ContactKind::touching: return both + " only touch";
    case ContactKind::inside: return first + " lies inside " + second;
    case ContactKind::crossing: break;
  }
  std::string doubt;
  if (contact.angle < k_tangent_angle) {
    const std::string angle = number_text(contact.angle * 180.0 / std::numbers::pi, k_digits) + " degrees";
    doubt = contact.is_crevice ? both + " form a crevice of " + angle : both + " are nearly tangent where they cross, at " + angle;
  }
  if (contact.share_inside > k_mostly_inside) {
    const std::string share = number_text(100.0 * contact.share_inside, k_digits) + " % of the surface of " + (contact.is_first_inside ? first : second) +
                              " lies inside " + (contact.is_first_inside ? second : first);
    doubt += (doubt.empty() ? "" : "; ") + share;
  }
  return doubt;
}

}  // namespace sterna::cad

namespace sterna {

std::string_view to_string(ContactKind kind) {
  switch (kind) {
    case ContactKind::crossing: return "crossing";
    case ContactKind::touching: return "touching";
    case ContactKind::inside: return "inside";
    case ContactKind::apart: return "apart";
  }
  return {};
}

}  // namespace sterna
