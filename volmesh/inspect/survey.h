// Private to volmesh/inspect: the parts of an inspection, one file each, and their common output.
#pragma once

#include <algorithm>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "geom/base/borrowed.h"
#include "geom/base/parallel.h"
#include "geom/math/constants.h"
#include "geom/mesh/topology.h"
#include "volmesh/inspect/inspect.h"
#include "volmesh/layer_domain/layer_domain.h"

namespace sterna::volmesh {

/// A location beyond its limit, before the worst locations are selected.
template <class Id>
struct Suspect {
  Id id;
  double badness = 0.0;  ///< larger is worse
};

/// Returns at most `n` suspects, the worst first, and sorted by index if they are equally bad.
template <class Id>
std::vector<Suspect<Id>> worst(std::vector<Suspect<Id>> suspects, std::size_t n) {
  const auto is_worse = [](const Suspect<Id>& a, const Suspect<Id>& b) { return a.badness != b.badness ? a.badness > b.badness : a.id < b.id; };
  n = std::min(n, suspects.size());
  std::partial_sort(suspects.begin(), suspects.begin() + static_cast<std::ptrdiff_t>(n), suspects.end(), is_worse);
  suspects.resize(n);
  return suspects;
}

/// The surface, with the data that all parts of the inspection use.
struct Survey {
  const TriMesh& mesh;
  const InspectRequest& request;
  const RunContext& context;
  InspectReport& report;

  std::size_t n_locations() const { return static_cast<std::size_t>(request.limits.max_places); }
  const std::string& patch_of(TriangleId t) const { return mesh.patches[mesh.triangle_patch[t]].name; }
  Point middle(TriangleId t) const;
  /// Adds a finding whose worst locations are triangles, and sets the field "finding".
  void add(Finding finding, const std::vector<Suspect<TriangleId>>& suspects,
           const std::function<FindingLocation(const Suspect<TriangleId>&)>& location_of) const;
  void add_field(std::string name, std::string title, std::string unit, bool is_at_vertices, std::vector<float> values) const {
    report.fields.push_back({std::move(name), std::move(title), std::move(unit), is_at_vertices, std::move(values)});
  }
};

/// Appends partial lists in order. Used with parallel_reduce.
template <class T>
std::vector<T> joined_lists(std::vector<T> a, std::vector<T> b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Returns the suspects of [0, n) in ascending order. test(i, list) appends a suspect to the list.
template <class Id, class Test>
std::vector<Suspect<Id>> find_suspects(const RunContext& context, std::size_t n, const Test& test) {
  using List = std::vector<Suspect<Id>>;
  return parallel_reduce(
      context, n, List{},
      [&](std::size_t begin, std::size_t end) {
        List list;
        for (std::size_t i = begin; i < end; ++i) test(Id(static_cast<std::uint64_t>(i)), list);
        return list;
      },
      joined_lists<Suspect<Id>>);
}

/// Maps the walls with layers to the surface of which they are part.
class WallMap {
 public:
  /// Identity map, for which the wall is the surface itself.
  explicit WallMap(Borrowed<const TriMesh> surface) : wall_(surface), n_vertices_(surface->n_vertices()) {}
  WallMap(const TriMesh& surface, Borrowed<const Domain> domain);

  TriangleId triangle(TriangleId of_wall) const { return wall2surface_ ? (*wall2surface_)[of_wall] : of_wall; }
  /// Returns values at the wall's vertices as a field on the surface, with NaN at other vertices.
  std::vector<float> field(const std::vector<double>& at_wall) const;

 private:
  const TriMesh& wall_;
  const Column<TriangleId, TriangleId>* wall2surface_ = nullptr;
  Column<VertexId, VertexId> vertex_;  ///< wall vertex to surface vertex; empty: identity
  std::size_t n_vertices_;
};

/// facets.cpp: finds sliver triangles. It needs no topology.
void survey_slivers(const Survey& survey);
/// unit.cpp: checks the body length.
void survey_unit(const Survey& survey);
/// edges.cpp: finds folds, size jumps, short edges, and edges of smooth surfaces (below the feature angle) that bend too much.
void survey_edges(const Survey& survey, const Topology& topology, double feature_angle);
/// bodies.cpp: finds connected parts, and parts inside other parts.
void survey_bodies(const Survey& survey, const Topology& topology);
/// contacts.cpp: finds vertices that nearly touch another wall.
/// \pre there are no crossings
void survey_contacts(const Survey& survey, const LayerBase& base, const Collider& collider, const WallMap& map);
/// crossings.cpp: finds pairs of intersecting triangles by the exact test. Returns true if there are none.
bool survey_crossings(const Survey& survey);
/// visibility.cpp: checks the visibility of all facets of a vertex from one growth direction.
void survey_visibility(const Survey& survey, const LayerBase& base, const WallMap& map);
/// heights.cpp: predicts the layer by the first steps of its envelope.
void survey_heights(const Survey& survey, LayerDomain& layer_domain);
/// cells.cpp: compares first height and last layer with the edges.
void survey_cells(const Survey& survey, const LayerDomain& layer_domain);
/// bases.cpp: finds blunt bases that are much thinner than the layer requested on them.
void survey_bases(const Survey& survey, const LayerDomain& layer_domain);
/// wake.cpp: reports a body in a farfield without any size source.
void survey_wake(const Survey& survey);
/// cells.cpp: returns the requested height in metres of the layer at a vertex, before any reduction.
double requested_height(const LayerBase& base, const EnvelopeScale& scale, VertexId v);
/// cells.cpp: compares the first height with the flow.
void survey_y_plus(const Survey& survey);

/// Formats a count, such as "12 triangles" or "1 triangle".
std::string count_of(std::int64_t n, const std::string& one, const std::string& many);
/// Formats a fraction, such as "12.4 %" or "98 %".
std::string percent(double share);
/// Number of digits in messages. With it, lengths up to 9999 have no exponent.
inline constexpr int k_text_digits = 4;
/// Number of digits of recommended values.
inline constexpr int k_advice_digits = 2;

}  // namespace sterna::volmesh
