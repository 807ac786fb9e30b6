// At an edge with four or more facets, the two facets beside one wedge of the solid stay connected. Each fan of facets connected in this way at a vertex gets
// its own copy of the vertex. All copies move slightly into their solid, so that they no longer touch.
#include <algorithm>
#include <array>
#include <map>

#include "geom/base/error.h"
#include "geom/math/measures.h"
#include "geom/math/predicates.h"
#include "geom/mesh/find_crossings.h"
#include "surfmesh/repair/repair_state.h"
#include "surfmesh/stitch/orient.h"

namespace sterna::surfmesh {
namespace {

constexpr double k_apart_share = 1e-5;    ///< relative to L: distance by which copies are moved apart
constexpr double k_apart_of_edge = 0.02;  ///< upper limit of that distance relative to the shortest edge at the vertex, so that no facet is inverted
constexpr double k_join_share = 1e-4;     ///< relative to L: half the width of the bridge between bodies that touch along a line
constexpr std::size_t k_most_named = 5;   ///< largest number of pairs of bodies named in warnings
constexpr std::uint32_t k_no_partner = 0xffffffffu;

/// Returns the twins of half-edges. At crowded edges, twins are the facets beside one wedge of the solid; at edges in `is_of_fluid`, those beside one wedge of
/// the fluid. \pre normals point out of the solid
std::vector<std::uint32_t> wedge_twins(const RepairState& state, const EdgeTable& edges, const std::vector<char>& is_of_fluid) {
  std::vector<std::uint32_t> twin(3 * state.facets.size(), k_no_partner);
  for (std::size_t i = 0; i < edges.edges().size(); ++i) {
    const Edge& edge = edges.edges()[i];
    const auto at = edges.at(edge);
    if (at.size() == 2) {
      twin[at[0]] = at[1];
      twin[at[1]] = at[0];
      continue;
    }
    // The solid is behind a facet, clockwise around the direction in which the facet runs along the edge; the fluid is in front. The partner is the first facet
    // in the searched direction that runs against this facet.
    const Vec3 &u = state.points[edge.low], &v = state.points[edge.high];
    const Vec3 axis = normalized(v - u);
    for (const std::uint32_t h : at) {
      const bool is_along = state.facets[h / 3][h % 3] == edge.low;
      const Vec3 own = state.points[state.facets[h / 3][previous_halfedge(h) % 3]] - u;
      const Vec3 e1 = normalized(own - dot(own, axis) * axis), e2 = cross(axis, e1);
      double best = 1e300;
      for (const std::uint32_t g : at) {
        if (g == h || (state.facets[g / 3][g % 3] == edge.low) == is_along) continue;
        const Vec3 other = state.points[state.facets[g / 3][previous_halfedge(g) % 3]] - u;
        double angle = std::atan2(dot(other, e2), dot(other, e1));  // angle counter-clockwise around the axis
        if (is_along != (!is_of_fluid.empty() && is_of_fluid[i])) angle = -angle;
        if (angle <= 0.0) angle += 6.283185307179586;
        if (angle < best) {
          best = angle;
          twin[h] = g;
        }
      }
    }
    for (const std::uint32_t h : at)
      if (twin[h] != k_no_partner && twin[twin[h]] != h) twin[h] = k_no_partner;  // facets do not alternate; the final check reports such edges
  }
  return twin;
}

/// Returns the half-edges that start at each vertex.
std::vector<std::vector<std::uint32_t>> corners_of(const RepairState& state) {
  std::vector<std::vector<std::uint32_t>> corners_at(state.points.size());
  for (std::uint32_t h = 0; h < 3 * state.facets.size(); ++h) corners_at[state.facets[h / 3][h % 3]].push_back(h);
  return corners_at;
}

/// Returns the fans at a vertex: the corners that are connected through twins.
std::vector<std::vector<std::uint32_t>> fans_at(const RepairState& state, const std::vector<std::uint32_t>& twin,
                                                const std::vector<std::uint32_t>& corners_at_v, std::uint32_t v) {
  std::map<std::uint32_t, std::uint32_t> fan;  // fan number by half-edge
  std::vector<std::vector<std::uint32_t>> fans;
  for (const std::uint32_t start : corners_at_v) {
    if (fan.count(start)) continue;
    auto& members = fans.emplace_back();
    std::vector<std::uint32_t> stack{start};
    fan[start] = 1;
    while (!stack.empty()) {
      const std::uint32_t h = stack.back();
      stack.pop_back();
      members.push_back(h);
      // The neighbours across both edges of this corner, whatever their orientation.
      for (const std::uint32_t over : {previous_halfedge(h), h}) {
        if (twin[over] == k_no_partner) continue;
        const std::uint32_t facet = twin[over] / 3;
        for (std::uint32_t g = 3 * facet; g < 3 * facet + 3; ++g) {
          if (state.facets[facet][g % 3] != v || fan.count(g)) continue;
          fan[g] = 1;
          stack.push_back(g);
        }
      }
    }
  }
  return fans;
}

/// Returns the body number of each facet. The facets of a body are connected through twins.
std::vector<std::uint32_t> bodies_over(const RepairState& state, const std::vector<std::uint32_t>& twin) {
  std::vector<std::uint32_t> body(state.facets.size(), k_no_partner);
  std::vector<std::uint32_t> stack;
  std::uint32_t n = 0;
  for (std::uint32_t start = 0; start < state.facets.size(); ++start) {
    if (body[start] != k_no_partner) continue;
    body[start] = n;
    stack.push_back(start);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (twin[h] == k_no_partner || body[twin[h] / 3] != k_no_partner) continue;
        body[twin[h] / 3] = n;
        stack.push_back(twin[h] / 3);
      }
    }
    ++n;
  }
  return body;
}

/// Returns a flag for each edge: true if it has four or more facets that belong to several bodies.
std::vector<char> contacts_of(const EdgeTable& edges, const std::vector<std::uint32_t>& body) {
  std::vector<char> is_contact(edges.edges().size(), 0);
  for (std::size_t i = 0; i < is_contact.size(); ++i) {
    const auto at = edges.at(edges.edges()[i]);
    is_contact[i] = at.size() >= 4 && std::ranges::any_of(at, [&](std::uint32_t h) { return body[h / 3] != body[at[0] / 3]; });
  }
  return is_contact;
}

std::size_t count_crowded(const EdgeTable& edges) {
  return static_cast<std::size_t>(std::ranges::count_if(edges.edges(), [](const Edge& edge) { return edge.count > 2; }));
}

/// Adds a vertex in the middle of each of these edges, so that the edge can be opened or joined there while its ends stay unchanged.
void split_edges(RepairState& state, const EdgeTable& edges, const std::vector<char>& is_split) {
  std::vector<std::uint32_t> middle(3 * state.facets.size(), k_no_partner);  // vertex in the middle of each half-edge
  for (std::size_t i = 0; i < is_split.size(); ++i) {
    if (!is_split[i]) continue;
    const Edge& edge = edges.edges()[i];
    const auto number = static_cast<std::uint32_t>(state.points.size());
    state.points.push_back(0.5 * (state.points[edge.low] + state.points[edge.high]));
    for (const std::uint32_t h : edges.at(edge)) middle[h] = number;
  }
  for (std::size_t t = 0, n = state.facets.size(); t < n; ++t) {
    // Pieces are cut off at corners between two sides with a middle vertex. Cutting ends when no side has a middle; the rest keeps the number of the facet.
    std::vector<std::uint32_t> polygon;
    for (std::size_t k = 0; k < 3; ++k) {
      polygon.push_back(state.facets[t][k]);
      if (middle[3 * t + k] != k_no_partner) polygon.push_back(middle[3 * t + k]);
    }
    if (polygon.size() == 3) continue;
    state.info[t].is_touched = true;
    const FacetInfo info = state.info[t];
    if (polygon.size() == 4) {  // cut from the middle vertex to the opposite corner
      const auto m = static_cast<std::size_t>(
          std::ranges::find_if(polygon, [&](std::uint32_t v) { return v != state.facets[t][0] && v != state.facets[t][1] && v != state.facets[t][2]; }) -
          polygon.begin());
      const auto at = [&](std::size_t k) { return polygon[(m + k) % 4]; };
      state.facets[t] = {at(0), at(1), at(2)};
      state.add({at(0), at(2), at(3)}, info);
      continue;
    }
    const Facet corners = state.facets[t];
    const std::array<std::uint32_t, 3> m = {middle[3 * t], middle[3 * t + 1], middle[3 * t + 2]};
    if (polygon.size() == 6) {
      state.facets[t] = {m[0], m[1], m[2]};
      for (std::size_t k = 0; k < 3; ++k) state.add({corners[k], m[k], m[(k + 2) % 3]}, info);
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {  // the two sides at corner k + 1
      if (m[k] == k_no_partner || m[(k + 1) % 3] == k_no_partner) continue;
      state.facets[t] = {m[k], corners[(k + 1) % 3], m[(k + 1) % 3]};
      state.add({corners[k], m[k], m[(k + 1) % 3]}, info);
      state.add({corners[k], m[(k + 1) % 3], corners[(k + 2) % 3]}, info);
    }
  }
}

/// Returns a flag for each edge. It is true if the edge is crowded and the facets at the edge do not have separate fans at either end, so that opening the ends
/// would leave the edge crowded.
std::vector<char> closed_contacts(const RepairState& state, const EdgeTable& edges, const std::vector<std::uint32_t>& twin) {
  std::vector<char> is_closed(edges.edges().size(), 0);
  if (count_crowded(edges) == 0) return is_closed;
  const std::vector<std::vector<std::uint32_t>> corners_at = corners_of(state);
  for (std::size_t i = 0; i < is_closed.size(); ++i) {
    const Edge& edge = edges.edges()[i];
    is_closed[i] =
        edge.count > 2 && fans_at(state, twin, corners_at[edge.low], edge.low).size() < 2 && fans_at(state, twin, corners_at[edge.high], edge.high).size() < 2;
  }
  return is_closed;
}

/// Logs a warning with the names of parts that touch at a crowded edge of one body, such as a cavity at the outer shell, or a body in a duct at its wall.
void warn_of_tangent(RepairState& state, const EdgeTable& edges, const std::vector<char>& is_contact, const Contacts& contacts) {
  if (count_crowded(edges) == 0) return;
  WorkingSurface surface;
  surface.points = state.points;
  surface.facets = state.facets;
  const std::vector<std::uint32_t> part = flood_orientation(surface, edges).component;
  struct Contact {
    Vec3 location;
    std::array<std::uint32_t, 2> patch{};
  };
  std::map<std::array<std::uint32_t, 2>, Contact> pairs;  // by the numbers of the two parts
  for (std::size_t i = 0; i < is_contact.size(); ++i) {
    const Edge& edge = edges.edges()[i];
    if (is_contact[i] || edge.count < 4) continue;
    for (const std::uint32_t h : edges.at(edge))
      for (const std::uint32_t g : edges.at(edge))
        if (part[h / 3] < part[g / 3])
          pairs.try_emplace({part[h / 3], part[g / 3]},
                            Contact{0.5 * (state.points[edge.low] + state.points[edge.high]), {state.info[h / 3].patch, state.info[g / 3].patch}});
  }
  const auto name = [&](std::uint32_t p) { return p < contacts.names.size() ? "\"" + contacts.names[p] + "\"" : std::string("the surface"); };
  std::size_t n = 0;
  for (const auto& [pair, contact] : pairs) {
    if (++n > k_most_named) break;
    std::vector<std::string>& warnings = state.report.stitch.warnings;
    const std::string who = contact.patch[0] == contact.patch[1] ? "repair: two parts of " + name(contact.patch[0])
                                                                 : "repair: " + name(contact.patch[0]) + " and " + name(contact.patch[1]);
    const std::string text = who + " touch along a line at " + format_point(contact.location);
    if (std::ranges::any_of(warnings, [&](const std::string& known) { return known.starts_with(who); })) continue;
    warnings.push_back(text + ", where the gap between them narrows to zero; the contact is closed over a width of at most " +
                       short_number(2.0 * k_apart_share * state.length) + " m. Move one part into the other by a few percent of its size, or away from it." +
                       (contacts.is_fluid_inside ? "" : " If the fluid is between them, give fluid = \"inside\" (--fluid inside)"));
  }
}

/// Moves one fan of facets at a vertex to a location. If another fan keeps the vertex, this fan gets a copy.
void move_fan(const std::vector<std::uint32_t>& fan, std::uint32_t v, const Vec3& to, bool is_copy, RepairState& state) {
  std::uint32_t own = v;
  if (is_copy) {
    own = static_cast<std::uint32_t>(state.points.size());
    state.points.push_back(to);
  } else {
    state.points[v] = to;
  }
  for (const std::uint32_t h : fan) {
    state.facets[h / 3][h % 3] = own;
    state.info[h / 3].is_touched = true;
  }
}

/// Joins bodies across the crevice at these edges. Facets beside one wedge of the fluid stay connected, and the vertices move into that wedge.
void join_over(RepairState& state, const EdgeTable& edges, const std::vector<char>& is_contact) {
  const std::vector<std::uint32_t> twin = wedge_twins(state, edges, is_contact);
  std::vector<char> is_at_contact(3 * state.facets.size(), 0);  // flag of each half-edge
  for (std::size_t i = 0; i < is_contact.size(); ++i)
    if (is_contact[i])
      for (const std::uint32_t h : edges.at(edges.edges()[i])) is_at_contact[h] = 1;
  const std::vector<std::vector<std::uint32_t>> corners_at = corners_of(state);
  const std::vector<Vec3> before = state.points;
  const std::vector<Facet> facets = state.facets;
  // Returns the direction from a side into its facet, at right angles to the side.
  const auto into = [&](std::uint32_t h) {
    const Vec3 &a = before[facets[h / 3][h % 3]], &b = before[facets[h / 3][next_halfedge(h) % 3]], &c = before[facets[h / 3][previous_halfedge(h) % 3]];
    const Vec3 axis = normalized(b - a);
    return normalized((c - a) - dot(c - a, axis) * axis);
  };
  for (std::uint32_t v = 0; v < before.size(); ++v) {
    const std::vector<std::uint32_t>& corners = corners_at[v];
    if (std::ranges::none_of(corners, [&](std::uint32_t h) { return is_at_contact[h] || is_at_contact[previous_halfedge(h)]; })) continue;
    const std::vector<std::vector<std::uint32_t>> fans = fans_at(state, twin, corners, v);
    if (fans.size() < 2) continue;
    double farthest = 0.0;
    std::vector<std::uint32_t> concerned;
    for (std::size_t i = 0; i < fans.size(); ++i) {
      Vec3 way;
      double shortest = 1e300;
      for (const std::uint32_t h : fans[i]) {
        for (const std::uint32_t side : {h, previous_halfedge(h)})
          if (is_at_contact[side]) way += into(side);
        shortest = std::min(
            {shortest, distance(before[v], before[facets[h / 3][next_halfedge(h) % 3]]), distance(before[v], before[facets[h / 3][previous_halfedge(h) % 3]])});
      }
      const double by = norm(way) > 0.0 ? std::min(k_join_share * state.length, k_apart_of_edge * shortest) : 0.0;
      const Vec3 to = by > 0.0 ? before[v] + by * normalized(way) : before[v];
      farthest = std::max(farthest, by);
      move_fan(fans[i], v, to, i > 0, state);
      for (const std::uint32_t h : fans[i]) concerned.push_back(h / 3);
    }
    state.note(RepairKind::joined, concerned, farthest);
  }
}

/// Returns the name of the patch to which most facets of a body belong.
std::string name_of_body(const RepairState& state, const std::vector<std::uint32_t>& body, std::uint32_t number, const std::vector<std::string>& names) {
  std::map<std::uint32_t, std::size_t> n;
  for (std::size_t t = 0; t < body.size(); ++t)
    if (body[t] == number) ++n[state.info[t].patch];
  const auto most = std::ranges::max_element(n, [](const auto& a, const auto& b) { return a.second < b.second; });
  return most != n.end() && most->first < names.size() ? names[most->first] : "surface";
}

/// Logs a warning with the names of the bodies that touch at these edges and will be separated.
void warn_of_opened(RepairState& state, const EdgeTable& edges, const std::vector<char>& is_contact, const std::vector<std::uint32_t>& body,
                    const std::vector<std::string>& names) {
  std::map<std::array<std::uint32_t, 2>, Vec3> pairs;
  for (std::size_t i = 0; i < is_contact.size(); ++i) {
    if (!is_contact[i]) continue;
    const Edge& edge = edges.edges()[i];
    for (const std::uint32_t h : edges.at(edge))
      for (const std::uint32_t g : edges.at(edge))
        if (body[h / 3] < body[g / 3]) pairs.try_emplace({body[h / 3], body[g / 3]}, 0.5 * (state.points[edge.low] + state.points[edge.high]));
  }
  std::size_t n = 0;
  for (const auto& [pair, location] : pairs) {
    if (++n > k_most_named) break;
    state.report.stitch.warnings.push_back("repair: \"" + name_of_body(state, body, pair[0], names) + "\" and \"" + name_of_body(state, body, pair[1], names) +
                                           "\" touch along a line at " + format_point(location) + " and are separated by a gap of at most " +
                                           short_number(2.0 * k_apart_share * state.length) +
                                           " m: each part is a separate body. Let one part extend into the other, or move them apart");
  }
}

/// Joins bodies that touch along edges. \return true if nothing touches there afterwards, and nothing new crosses
bool join_contacts(RepairState& state, const EdgeTable& edges, const std::vector<char>& is_contact, const RunContext& context) {
  RepairState joined = state;
  split_edges(joined, edges, is_contact);
  const EdgeTable halves = joined.edges();
  join_over(joined, halves, contacts_of(halves, bodies_over(joined, wedge_twins(joined, halves, {}))));
  if (count_crowded(joined.edges()) >= count_crowded(edges)) return false;
  if (find_crossings(joined.points, joined.facets, context).total > find_crossings(state.points, state.facets, context).total) return false;
  state = std::move(joined);
  return true;
}

void open_contacts(RepairState& state, const std::vector<std::uint32_t>& twin) {
  const std::vector<std::vector<std::uint32_t>> corners_at = corners_of(state);
  const std::size_t n_points = state.points.size();
  const std::vector<Vec3> before = state.points;
  for (std::uint32_t v = 0; v < n_points; ++v) {
    const std::vector<std::vector<std::uint32_t>> fans = fans_at(state, twin, corners_at[v], v);
    if (fans.size() < 2) continue;
    double farthest = 0.0;
    std::vector<std::uint32_t> concerned;
    for (std::size_t i = 0; i < fans.size(); ++i) {
      Vec3 normal;
      double shortest = 1e300;
      bool is_cap = false;
      for (const std::uint32_t h : fans[i]) {
        const Facet& f = state.facets[h / 3];
        normal += normalized(area_vector(before[f[0] < n_points ? f[0] : v], before[f[1] < n_points ? f[1] : v], before[f[2] < n_points ? f[2] : v]));
        shortest = std::min({shortest, distance(state.points[f[h % 3]], state.points[f[next_halfedge(h) % 3]]),
                             distance(state.points[f[h % 3]], state.points[f[previous_halfedge(h) % 3]])});
        is_cap |= state.info[h / 3].mark == FacetMark::cap;
      }
      if (is_cap && state.report.half) normal[static_cast<std::size_t>(state.report.half->axis[0] - 'x')] = 0.0;
      const double by = std::min(k_apart_share * state.length, k_apart_of_edge * shortest);
      const Vec3 to = before[v] - by * normalized(normal);
      farthest = std::max(farthest, distance(to, before[v]));
      move_fan(fans[i], v, to, i > 0, state);
      for (const std::uint32_t h : fans[i]) concerned.push_back(h / 3);
    }
    state.note(RepairKind::separated, concerned, farthest);
  }
}

}  // namespace

void separate_touching(RepairState& state, const Contacts& contacts, const RunContext& context) {
  {
    const EdgeTable edges = state.edges();
    const std::vector<std::uint32_t> body = bodies_over(state, wedge_twins(state, edges, {}));
    const std::vector<char> is_contact = contacts_of(edges, body);
    warn_of_tangent(state, edges, is_contact, contacts);
    if (!contacts.is_fluid_inside && std::ranges::find(is_contact, 1) != is_contact.end() && !join_contacts(state, edges, is_contact, context))
      warn_of_opened(state, edges, is_contact, body, contacts.names);
  }
  {
    const EdgeTable edges = state.edges();
    split_edges(state, edges, closed_contacts(state, edges, wedge_twins(state, edges, {})));
  }
  open_contacts(state, wedge_twins(state, state.edges(), {}));
}

}  // namespace sterna::surfmesh
