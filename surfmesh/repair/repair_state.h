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

  /// Records a change and draws these facets in their current state. `size` < 0: the diameter of their box.
  void note(RepairKind kind, const std::vector<std::uint32_t>& of, double size = -1.0);
  /// Records a change for a set of facets: one for each of its edge-connected parts.
  void note_parts(RepairKind kind, const std::vector<char>& is_of, const EdgeTable& edges);
};

/// Merges vertices with equal coordinates, and drops facets with a repeated vertex, without area, or duplicated. Of copies with opposite senses none stays if
/// `is_oriented`, because they enclose nothing; else one stays.
void weld_rounded(RepairState& state, bool is_oriented = false);

/// Drops parts (connected over edges) whose box is smaller than allowed.
void drop_small_parts(RepairState& state, const RepairOptions& options);
/// Drops closed parts without thickness (four facets in one plane, left over from cutting or replacing facets): they have no inside.
void drop_flat_parts(RepairState& state);

/// Joins open boundaries within a tolerance that grows from rounding to options.gap, vertices to vertices and vertices to edges; never beyond half an edge.
void zip_seams(RepairState& state, const RepairOptions& options, const RunContext& context);

/// Removes flat open parts, and open flaps on edges that are closed without them.
void remove_sheets(RepairState& state, const RunContext& context);

/// Returns closed polygons of edges with an odd number of facets, each simple; a loop runs against its facets. Chains of edges that do not close are skipped.
std::vector<std::vector<std::uint32_t>> find_loops(const RepairState& state);

/// Recognises the opening of a half model, moves its boundary into the plane and closes it with facets of mark `cap`; sets report.half.
void cap_half(RepairState& state, const RepairOptions& options);

/// Fills loops within the limits. `kind`: filled or replaced. \return loops that stay open
std::size_t fill_holes(RepairState& state, const RepairOptions& options, RepairKind kind, const RunContext& context);

/// Rounds the vertices of facets that cross to a grid of about 1e-10 of the length: planes that differ only by rounding become one.
void snap_crossings(RepairState& state, const RunContext& context);

/// Cuts facets where they cross, in rounds, until nothing crosses, the rounds are used up, or the number of crossings grows. \return true if facets were cut
bool cut_crossings(RepairState& state, const RepairOptions& options, const RunContext& context);

/// Solid regions, by winding numbers: level 0 are bodies, level 1 cavities in them, level 2 bodies in cavities. A point is solid if the deepest level that
/// encloses it is even. The components of each mesh are oriented outwards.
struct SolidReference {
  std::vector<TriMesh> levels;  ///< at least one
  bool is_by_winding = false;   ///< more than one level, or the fluid is inside: cells between facets cannot decide
};

/// Computes the levels of the components. With the fluid outside, a component is a cavity if it lies within another one and has the opposite sense in the
/// file. With the fluid inside, also if it has the same sense but does not cross the other: a body in the fluid. Contacts count as lying within.
/// \pre closed, perhaps crossing itself
SolidReference solid_reference(const RepairState& state, bool is_fluid_inside, const RunContext& context);

/// Keeps facets with solid on one side, oriented away from it. \pre nothing crosses
/// Sides are cells between facets: cells not connected to the outside are solid. Where open edges connect the outside to a region that is solid by the
/// winding numbers of `reference`, or if `reference` has cavities, winding numbers decide. Returns false, and changes nothing, if hardly any facet would
/// remain.
bool keep_outer_hull(RepairState& state, const SolidReference& reference, const RunContext& context);

/// Input for the treatment of parts that touch.
struct Contacts {
  bool is_fluid_inside = false;
  std::vector<std::string> names;  ///< names of the patches
};

/// Splits vertices and edges in which the solid touches itself, and moves the copies a little apart. Bodies that touch along edges are joined instead: the
/// vertices move into the fluid on both sides, if nothing crosses then. Else the bodies are separated, with a warning that names them.
void separate_touching(RepairState& state, const Contacts& contacts, const RunContext& context);

/// Collapses edges shorter than options.sliver, in changed regions and if no facet is inverted.
void collapse_slivers(RepairState& state, const RepairOptions& options, const RunContext& context);

/// Removes facets that still cross, are at a crowded edge or are open, with growing rings around them, and fills the holes. \pre oriented \return true if no
/// defect is left
bool replace_crossings(RepairState& state, const RepairOptions& options, const Contacts& contacts, const RunContext& context);

/// Orients the facets of each component consistently if possible: in the majority's sense.
void make_consistent(RepairState& state);

/// Samples distances in both directions. \pre the result is made of `state` without the cap
void measure_changes(RepairState& state, const std::vector<Vec3>& input_points, const std::vector<Facet>& input_facets, const RunContext& context);

}  // namespace sterna::surfmesh
