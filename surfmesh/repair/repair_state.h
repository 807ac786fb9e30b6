// Private to surfmesh/repair: the surface between two steps.
#pragma once

#include <cstdint>
#include <vector>

#include "geom/base/run_context.h"
#include "surfmesh/repair/repair_surface.h"
#include "surfmesh/stitch/edge_table.h"
#include "surfmesh/stitch/working_surface.h"

namespace sterna::surfmesh {

enum class FacetMark : std::uint8_t {
  given,   ///< a facet of the input, or a piece of one
  filled,  ///< fills a hole
  cap      ///< closes half a model in its plane while the surface is repaired; not part of the result
};

struct FacetInfo {
  std::uint32_t patch = 0;  ///< as in WorkingSurface
  FacetMark mark = FacetMark::given;
  bool is_touched = false;  ///< new, cut or moved
};

struct RepairState {
  std::vector<Vec3> points;  ///< m
  std::vector<Facet> facets;
  std::vector<FacetInfo> info;  ///< per facet
  double length = 0.0;          ///< m, L
  RepairReport report;

  std::array<Vec3, 3> corners(std::size_t t) const { return {points[facets[t][0]], points[facets[t][1]], points[facets[t][2]]}; }
  EdgeTable edges() const { return EdgeTable(facets, points.size()); }
  void keep(const std::vector<char>& is_kept);
  void add(const Facet& facet, const FacetInfo& of);

  /// Notes a change and draws these facets as they are now. `size` < 0: the diameter of their box.
  void note(RepairKind kind, const std::vector<std::uint32_t>& of, double size = -1.0);
  /// The same for a set of facets: one change for each of its parts that hang together over edges.
  void note_parts(RepairKind kind, const std::vector<char>& is_of, const EdgeTable& edges);
};

/// Vertices with equal coordinates become one; facets with a repeated vertex, without area, or written twice are dropped. Of copies with opposite senses none
/// stays where `is_oriented`, for there is nothing between them; else one does.
void weld_rounded(RepairState& state, bool is_oriented = false);

/// Parts (connected over edges) whose box is smaller than allowed are dropped.
void drop_small_parts(RepairState& state, const RepairOptions& options);
/// Closed parts without thickness (of four facets in one plane, left over where facets were cut or replaced) are dropped: they have no inside.
void drop_flat_parts(RepairState& state);

/// Rims within a tolerance that grows from rounding to options.gap are joined, vertices to vertices and vertices to edges; never beyond half an edge.
void zip_seams(RepairState& state, const RepairOptions& options, const RunContext& context);

/// Flat open parts, and open flaps on edges that are closed without them.
void remove_sheets(RepairState& state, const RunContext& context);

/// Closed polygons of edges with an odd number of facets, each simple; a loop runs against its facets. Edges that end nowhere are left out.
std::vector<std::vector<std::uint32_t>> find_loops(const RepairState& state);

/// Recognises the opening of half a model, puts its rim into the plane and closes it with facets of mark `cap`; sets report.half.
void cap_half(RepairState& state, const RepairOptions& options);

/// Fills loops within the limits. `kind`: filled or replaced. \return loops that stay open
std::size_t fill_holes(RepairState& state, const RepairOptions& options, RepairKind kind, const RunContext& context);

/// Vertices of facets that cross go to a grid of about 1e-10 of the length: planes that were meant to be one and are not, by rounding, become one.
void snap_crossings(RepairState& state, const RunContext& context);

/// Cuts facets where they cross, in rounds, until nothing crosses, the rounds are over, or there are more crossings than before. \return whether something was
/// cut
bool cut_crossings(RepairState& state, const RepairOptions& options, const RunContext& context);

/// What is solid, by winding numbers: level 0 are bodies, level 1 cavities in them, level 2 bodies in cavities. A place is solid where the deepest level that
/// encloses it is even. Each mesh has its components turned outwards.
struct SolidReference {
  std::vector<TriMesh> levels;  ///< at least one
  bool is_by_winding = false;   ///< more than one level, or the fluid is inside: cells between facets do not tell
};

/// The levels of the components. With the fluid outside a component is a cavity where it lies within another and has the opposite sense in the file; with the
/// fluid inside also where it has the same sense but does not cross the other: a body in the fluid. Contacts count as lying within.
/// \pre closed, perhaps crossing itself
SolidReference solid_reference(const RepairState& state, bool is_fluid_inside, const RunContext& context);

/// Keeps facets with solid on one side, turned away from it; \pre nothing crosses. Sides are cells between facets: what the outside does not reach is solid.
/// Where open edges make the outside leak into what is solid by the winding numbers of `reference`, or that has cavities, winding numbers decide. Returns
/// false, and changes nothing, when hardly anything would be left.
bool keep_outer_hull(RepairState& state, const SolidReference& reference, const RunContext& context);

/// What decides about parts that touch.
struct Contacts {
  bool is_fluid_inside = false;
  std::vector<std::string> names;  ///< of the patches
};

/// Vertices and edges in which the solid touches itself become several, a little apart. Where bodies touch along edges they are joined instead: the vertices
/// move into the fluid on both sides, if nothing crosses then; else the bodies are separated, with a warning that names them.
void separate_touching(RepairState& state, const Contacts& contacts, const RunContext& context);

/// Edges shorter than options.sliver become a vertex, where something was changed and that turns no facet.
void collapse_slivers(RepairState& state, const RepairOptions& options, const RunContext& context);

/// What still crosses, crowds an edge or is open is taken out with growing rings around it, and filled. \pre oriented \return whether nothing is left
bool replace_crossings(RepairState& state, const RepairOptions& options, const Contacts& contacts, const RunContext& context);

/// Facets of each component get one sense where that is possible: the majority's.
void make_consistent(RepairState& state);

/// Samples distances both ways. \pre result made of `state` without the cap
void measure_changes(RepairState& state, const std::vector<Vec3>& input_points, const std::vector<Facet>& input_facets, const RunContext& context);

}  // namespace sterna::surfmesh
