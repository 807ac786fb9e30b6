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
  given,   ///< a facet of the input, or a piece of such a facet
  filled,  ///< a facet that fills a hole
  cap      ///< a facet that closes a half model in its plane during the repair; not part of the result
};

struct FacetInfo {
  std::uint32_t patch = 0;  ///< patch number as in WorkingSurface
  FacetMark mark = FacetMark::given;
  bool is_touched = false;  ///< the facet is new, or was cut or moved
};

struct RepairState {
  std::vector<Vec3> points;  ///< m
  std::vector<Facet> facets;
  std::vector<FacetInfo> info;  ///< data of each facet
  double length = 0.0;          ///< m, body length L
  RepairReport report;

  std::array<Vec3, 3> corners(std::size_t t) const { return {points[facets[t][0]], points[facets[t][1]], points[facets[t][2]]}; }
  EdgeTable edges() const { return EdgeTable(facets, points.size()); }
  void keep(const std::vector<char>& is_kept);
  void add(const Facet& facet, const FacetInfo& of);

  /// Records a change, and draws these facets in their current state. If `size` < 0, the size is the diameter of the box of the facets.
  void note(RepairKind kind, const std::vector<std::uint32_t>& of, double size = -1.0);
  /// Records changes for a set of facets: one change for each edge-connected part of the set.
  void note_parts(RepairKind kind, const std::vector<char>& is_of, const EdgeTable& edges);
};

/// Merges vertices with equal coordinates. Drops facets with a repeated vertex, without area, or duplicated. Of several equal facets one stays. If
/// `is_oriented` is set and they have opposite orientations, none stays, because they enclose nothing.
void weld_rounded(RepairState& state, bool is_oriented = false);

/// Drops parts (connected across edges) whose box is smaller than allowed.
void drop_small_parts(RepairState& state, const RepairOptions& options);
/// Drops closed parts without thickness, because they have no inside. Such parts are left over from cutting or replacing facets (four facets in one plane).
void drop_flat_parts(RepairState& state);

/// Joins open boundaries within a tolerance that grows from rounding to options.gap. Vertices are joined to vertices and to edges, but never over more than
/// half an edge.
void zip_seams(RepairState& state, const RepairOptions& options, const RunContext& context);

/// Removes flat open parts, and open flaps on edges that are closed without the flap.
void remove_sheets(RepairState& state, const RunContext& context);

/// Returns closed simple polygons of edges with an odd number of facets. A polygon runs against its facets. Chains of edges that do not close are skipped.
std::vector<std::vector<std::uint32_t>> find_loops(const RepairState& state);

/// Recognises the opening of a half model. Moves its boundary into the plane and closes it with facets marked `cap`. Sets report.half.
void cap_half(RepairState& state, const RepairOptions& options);

/// Fills loops within the limits. `kind` is filled or replaced. \return number of loops that stay open
std::size_t fill_holes(RepairState& state, const RepairOptions& options, RepairKind kind, const RunContext& context);

/// Rounds the vertices of crossing facets to a grid of about 1e-10 of the length. Planes that differ only by rounding become equal.
void snap_crossings(RepairState& state, const RunContext& context);

/// Cuts facets where they cross, in rounds. Ends when nothing crosses, when the rounds are used up, or when the number of crossings grows. \return true if
/// facets were cut
bool cut_crossings(RepairState& state, const RepairOptions& options, const RunContext& context);

/// Solid regions, defined by winding numbers. Level 0 contains bodies, level 1 cavities in them, level 2 bodies in cavities, and so on. A point is solid if the
/// deepest level that encloses it is even. The components of each mesh are oriented outwards.
struct SolidReference {
  std::vector<TriMesh> levels;  ///< at least one mesh
  bool is_by_winding = false;   ///< true if there is more than one level, or if the fluid is inside: cells between facets are then not sufficient
};

/// Computes the levels of the components. With the fluid outside, a component is a cavity if it lies within another component and has the opposite orientation
/// in the input. With the fluid inside, a component with the same orientation that does not cross the other one is also one level deeper: it is a body in the
/// fluid. A contact counts as lying within.
/// \pre the surface is closed; it may cross itself
SolidReference solid_reference(const RepairState& state, bool is_fluid_inside, const RunContext& context);

/// Keeps facets with solid on one side, oriented away from the solid. Sides form cells between facets; cells that are not connected to the outside are solid.
/// In two cases the winding numbers of `reference` are used instead: if `reference` has cavities, or if open edges connect the outside to a region that is
/// solid by its winding number. Returns false and changes nothing if hardly any facet would remain.
/// \pre nothing crosses
bool keep_outer_hull(RepairState& state, const SolidReference& reference, const RunContext& context);

/// Input of separate_touching for the treatment of parts that touch.
struct Contacts {
  bool is_fluid_inside = false;
  std::vector<std::string> names;  ///< names of the patches
};

/// Splits vertices and edges in which the solid touches itself, and moves the copies slightly apart. Bodies that touch along edges are joined instead, if
/// nothing crosses then: the vertices move into the fluid on both sides. Otherwise the bodies are separated, with a warning that names them.
void separate_touching(RepairState& state, const Contacts& contacts, const RunContext& context);

/// Collapses edges shorter than options.sliver in changed regions, unless a facet would be inverted.
void collapse_slivers(RepairState& state, const RepairOptions& options, const RunContext& context);

/// Removes facets that still cross, that are at a crowded edge, or that are open, with growing rings around them. Fills the holes. \pre the facets are oriented
/// \return true if no defect remains
bool replace_crossings(RepairState& state, const RepairOptions& options, const Contacts& contacts, const RunContext& context);

/// Orients the facets of each component consistently if that is possible, in the direction of the majority.
void make_consistent(RepairState& state);

/// Samples distances in both directions. \pre the result was made of `state` without the cap
void measure_changes(RepairState& state, const std::vector<Vec3>& input_points, const std::vector<Facet>& input_facets, const RunContext& context);

}  // namespace sterna::surfmesh
