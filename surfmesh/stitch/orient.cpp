#include "surfmesh/stitch/orient.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "geom/base/error.h"
#include "geom/base/parallel.h"
#include "geom/math/measures.h"

namespace sterna::surfmesh {
namespace {

/// A winding number is an integer except for rounding. Half a turn separates 0 from +-1.
constexpr double k_half_turn = 0.5;
constexpr std::uint32_t k_none = 0xffffffffu;

struct Component {
  std::vector<std::uint32_t> facets;
  Box box;
  double volume = 0.0;        ///< signed volume with consistent orientation, in cubed file units
  double area_as_read = 0.0;  ///< area of the facets oriented like the first facet, minus the area of the others
  bool is_closed = true;
  std::uint32_t depth = 0;        ///< number of closed components that enclose it
  std::uint32_t parent = k_none;  ///< the innermost of the enclosing components
};

/// Returns the solid angle of a triangle as seen from p (van Oosterom & Strackee 1983).
double solid_angle(const Vec3& p, const std::array<Vec3, 3>& corners) {
  const Vec3 a = corners[0] - p, b = corners[1] - p, c = corners[2] - p;
  const double la = norm(a), lb = norm(b), lc = norm(c);
  return 2.0 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

bool is_inside(const Vec3& p, const WorkingSurface& surface, const Component& component, const std::vector<char>& is_flipped, const RunContext& context) {
  const auto turns = parallel_reduce(
      context, component.facets.size(), CompensatedSum{},
      [&](std::size_t begin, std::size_t end) {
        CompensatedSum sum;
        for (std::size_t i = begin; i < end; ++i) {
          const std::uint32_t t = component.facets[i];
          const double angle = solid_angle(p, surface.corners(t));
          sum.add(is_flipped[t] ? -angle : angle);
        }
        return sum;
      },
      [](CompensatedSum a, const CompensatedSum& b) {
        a.add(b);
        return a;
      });
  return std::abs(turns.value()) / (4.0 * std::numbers::pi) > k_half_turn;
}

bool contains(const Box& outer, const Box& inner) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (inner.min[axis] < outer.min[axis] || inner.max[axis] > outer.max[axis]) return false;
  return true;
}

std::vector<Component> measure_components(const WorkingSurface& surface, const EdgeTable& edges, const Orientation& orientation) {
  std::vector<Component> components(orientation.n_components);
  for (std::uint32_t t = 0; t < surface.n_facets(); ++t) {
    Component& component = components[orientation.component[t]];
    component.facets.push_back(t);
    for (const Vec3& p : surface.corners(t)) component.box.add(p);
    for (std::uint32_t k = 0; k < 3; ++k) component.is_closed &= edges.edge_of(3 * t + k).count == 2;
  }
  for (Component& component : components) {
    const Vec3 center = component.box.center();
    CompensatedSum volume, area;
    for (const std::uint32_t t : component.facets) {
      const auto c = surface.corners(t);
      const double sign = orientation.is_flipped[t] ? -1.0 : 1.0;
      volume.add(sign * tet_volume(center, c[0], c[1], c[2]));
      area.add(sign * triangle_area(c[0], c[1], c[2]));
    }
    component.volume = volume.value();
    component.area_as_read = area.value();
  }
  return components;
}

void find_nesting(const WorkingSurface& surface, const Orientation& orientation, std::vector<Component>& components, const RunContext& context) {
  if (components.size() < 2) return;
  for (std::uint32_t i = 0; i < components.size(); ++i) {
    context.check_stop();
    Component& inner = components[i];
    const Vec3 p = surface.points[surface.facets[inner.facets.front()][0]];
    for (std::uint32_t j = 0; j < components.size(); ++j) {
      const Component& outer = components[j];
      if (i == j || !outer.is_closed || !contains(outer.box, inner.box)) continue;
      if (!is_inside(p, surface, outer, orientation.is_flipped, context)) continue;
      ++inner.depth;
      if (inner.parent == k_none || std::abs(outer.volume) < std::abs(components[inner.parent].volume)) inner.parent = j;
    }
  }
}

/// Returns the name of the patch to which most facets of the component belong.
std::string name_of_component(const WorkingSurface& surface, const Component& component, const std::vector<std::string>& names) {
  std::map<std::uint32_t, std::size_t> n;
  for (const std::uint32_t t : component.facets) ++n[surface.patch[t]];
  std::uint32_t most = n.begin()->first;
  for (const auto& [patch, count] : n)
    if (count > n[most]) most = patch;
  return most < names.size() ? names[most] : "surface";
}

/// Returns true if, in the file, the normals of a component and of the component around it both point outwards or both point inwards.
bool is_same_sense(const std::vector<Component>& components, const Orientation& orientation, std::uint32_t i) {
  const auto is_outward = [&](const Component& component) {
    std::int64_t n_flipped = 0;
    for (const std::uint32_t t : component.facets) n_flipped += orientation.is_flipped[t];
    return (component.volume > 0.0) == (2 * n_flipped <= static_cast<std::int64_t>(component.facets.size()));
  };
  return is_outward(components[i]) == is_outward(components[components[i].parent]);
}

}  // namespace

Orientation flood_orientation(const WorkingSurface& surface, const EdgeTable& edges) {
  Orientation result;
  result.component.assign(surface.n_facets(), k_none);
  result.is_flipped.assign(surface.n_facets(), 0);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t start = 0; start < surface.n_facets(); ++start) {
    if (result.component[start] != k_none) continue;
    bool has_conflict = false;
    result.component[start] = result.n_components;
    stack.push_back(start);
    while (!stack.empty()) {
      const std::uint32_t t = stack.back();
      stack.pop_back();
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const Edge& edge = edges.edge_of(h);
        if (edge.count != 2) continue;
        const std::uint32_t g = edges.at(edge)[0] == h ? edges.at(edge)[1] : edges.at(edge)[0];
        const bool same_sense = surface.facets[h / 3][h % 3] == surface.facets[g / 3][g % 3];
        const char required = static_cast<char>(result.is_flipped[t] != same_sense);
        if (result.component[g / 3] == k_none) {
          result.component[g / 3] = result.n_components;
          result.is_flipped[g / 3] = required;
          stack.push_back(g / 3);
        } else if (result.is_flipped[g / 3] != required && !has_conflict) {
          has_conflict = true;
          result.conflicts.push_back(edge);
        }
      }
    }
    ++result.n_components;
  }
  return result;
}

void orient_outward(WorkingSurface& surface, const EdgeTable& edges, const Orientation& orientation, bool is_fluid_inside,
                    const std::vector<std::string>& names, StitchReport& report, const RunContext& context) {
  std::vector<Component> components = measure_components(surface, edges, orientation);
  find_nesting(surface, orientation, components, context);
  report.n_components = orientation.n_components;
  std::int64_t n_inconsistent = 0, n_inverted = 0, n_inverted_facets = 0;
  const auto plain_name = [&](std::uint32_t i) { return name_of_component(surface, components[i], names); };
  const auto name_of = [&](std::uint32_t i) { return "\"" + plain_name(i) + "\""; };
  for (std::uint32_t i = 0; i < components.size(); ++i) {
    const Component& component = components[i];
    std::int64_t n_minority = 0;
    for (const std::uint32_t t : component.facets) n_minority += orientation.is_flipped[t];
    const auto n = static_cast<std::int64_t>(component.facets.size());
    const bool is_hollow = (component.depth % 2 == 1) != is_fluid_inside;  // the component encloses the fluid, or a region that the fluid does not reach
    const bool is_inside_out = component.is_closed ? (component.volume > 0.0) == is_hollow : component.area_as_read < 0.0;
    const std::int64_t n_turned = is_inside_out ? n - n_minority : n_minority;
    // More than half of the facets are reversed: the file was inside out, and the rest was inconsistent.
    if (2 * n_turned > n) {
      ++n_inverted;
      n_inverted_facets += n;
      n_inconsistent += n - n_turned;
    } else {
      n_inconsistent += n_turned;
    }
    report.n_flipped += n_turned;
    for (const std::uint32_t t : component.facets)
      if (is_inside_out != static_cast<bool>(orientation.is_flipped[t])) std::swap(surface.facets[t][1], surface.facets[t][2]);
    if (is_hollow && component.depth > 0 && component.is_closed && is_same_sense(components, orientation, i))
      report.warnings.push_back(
          "part " + name_of(i) + " (" + count_of(n, "facet", "facets") + " near " + format_point(surface.metres(component.box.center())) +
          ") lies inside part " + name_of(component.parent) +
          ", both with outward normals: the inner part is turned inside out and treated as a cavity, which the outer flow does not reach. If \"" +
          plain_name(component.parent) + "\" is not a solid, leave it out, or make it a source or an interface");
    if (is_hollow && component.depth > 0 && component.is_closed)
      report.messages.push_back("component " + std::to_string(i + 1) + " (" + count_of(n, "facet", "facets") + " near " +
                                format_point(surface.metres(component.box.center())) + ") lies inside component " + std::to_string(component.parent + 1) +
                                ": treated as a cavity, which the outer flow does not reach");
  }
  if (n_inverted > 0)
    report.messages.push_back(count_of(n_inverted, "component", "components") + " (" + count_of(n_inverted_facets, "facet", "facets") + ") " +
                              (n_inverted == 1 ? "was" : "were") + " inside out: orientation reversed");
  if (n_inconsistent > 0)
    report.messages.push_back("turned " + count_of(n_inconsistent, "facet", "facets") + " with an orientation opposite to that of the neighbours");
}

}  // namespace sterna::surfmesh
