// Table of the numeric gates: the quantity each gate measures, its limits, the solver classes it affects, and the evidence for its hard limit.
// docs/quality_gates.md explains the kinds of evidence. If a measurement replaces a limit, its source here is the name of the page.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "geom/math/constants.h"
#include "geom/mesh/gates.h"

namespace sterna {
namespace {

constexpr double k_right = std::numbers::pi / 2.0;

using M = Measure;

// The coverage limit is 99 % of the whole wall. A limit of 99.5 % for the wing needs a script that identifies the wing patch.
constexpr Consumers k_of_both{};
constexpr LimitEvidence k_no_limit{Evidence::none, Evidence::none, ""};
constexpr LimitEvidence k_proposal{Evidence::cited, Evidence::cited,
                                   "a proposal of this project; runs converge beyond this limit (docs/measurements/gates.md)"};
constexpr LimitEvidence k_flat_by_runs{Evidence::measured, Evidence::cited,
                                       "docs/measurements/gates.md: runs with more than 0.1 % beyond the limit diverged or changed drag"};
constexpr double k_flat_share = 0.001;  // four flat tetrahedra in 50 000 changed drag by 0.5 %; with 0.1 % and more every run diverged or changed drag
constexpr LimitEvidence k_by_model{Evidence::definition, Evidence::definition, "the model from which the mesh was made"};

constexpr std::array<MeasureInfo, k_n_measures> k_measures = {{
    {M::scaled_jacobian,
     "G3",
     "scaled_jacobian",
     "scaled Jacobian of prisms",
     "prisms",
     false,
     true,
     {k_nan, 0.05, 0.2, 0.999},
     {0, 1, 50},
     k_of_both,
     k_no_limit},
    {M::dual_closure,
     "G4",
     "dual_closure",
     "closure of dual cells",
     "nodes",
     false,
     false,
     {1e-12, 1e-12, k_nan, 1.0},
     {0x1p-60, 0x1p-36, 48, 2},
     k_node_centred_alone,
     {Evidence::none, Evidence::definition, "an open control volume has no balance; beyond it the mesh is INVALID"}},
    {M::orthogonality,
     "G5",
     "orthogonality",
     "SU2 orthogonality",
     "nodes",
     true,
     true,
     {5 * k_degree, 20 * k_degree, 35 * k_degree, 0.999},
     {0, k_right, 45},
     k_node_centred_alone,
     {Evidence::none, Evidence::cited, "SU2: good values are near 90 degrees, poor ones typically below 20"}},
    {M::sub_volume_ratio,
     "G6",
     "sub_volume_ratio",
     "SU2 CV sub-volume ratio",
     "nodes",
     false,
     false,
     {1e5, 1e3, 200, 0.999},
     {1, 0x1p24, 48, 2},
     k_node_centred_alone,
     {Evidence::none, Evidence::cited, "reports of SU2 users: runs at 1.3e4 and 1.9e5, diverges at 1.8e8"}},
    {M::face_area_ratio,
     "G7",
     "face_area_ratio",
     "SU2 CV face area aspect ratio",
     "nodes",
     false,
     false,
     {k_nan, k_nan, k_nan, 1.0},
     {1, 0x1p24, 48, 2},
     k_node_centred_alone,
     k_no_limit},
    {M::relative_face_area_ratio,
     "G7",
     "relative_face_area_ratio",
     "CV area ratio over edge / height",
     "nodes",
     false,
     false,
     {k_nan, 1.5, k_nan, 1.0},
     {1, 0x1p12, 48, 4},
     k_node_centred_alone,
     k_no_limit},
    {M::stack_growth,
     "G8",
     "stack_growth",
     "growth ratio along growth lines",
     "area",
     false,
     false,
     {1.5, k_nan, 1.2, 0.999},
     {1, 2, 50},
     k_of_both,
     {Evidence::cited, Evidence::cited, "guidelines of the drag prediction workshops: growth below 1.25, 1.4 seen"}},
    {M::interface_height,
     "G9",
     "interface_height",
     "last height / (0.816 edge)",
     "prisms",
     false,
     false,
     {8, k_nan, 3, 0.99},
     {1, 0x1p8, 48, 6},
     k_of_both,
     k_proposal},
    {M::interface_volume,
     "G9",
     "interface_volume",
     "3 tet / prism volume",
     "prisms",
     false,
     false,
     {8, k_nan, 3, 0.99},
     {1, 0x1p8, 48, 6},
     k_of_both,
     k_proposal},
    {M::stack_angle,
     "G10",
     "stack_angle",
     "stack angle above best possible",
     "area",
     true,
     false,
     {k_nan, k_nan, 10 * k_degree, 0.995},
     {0, k_right, 45},
     k_of_both,
     k_no_limit},
    {M::first_height,
     "G11",
     "first_height",
     "deviation of the first height",
     "lines",
     false,
     false,
     {0.2, k_nan, 0.02, 0.99},
     {0, 0.5, 50},
     k_of_both,
     {Evidence::definition, Evidence::definition, "the requested first height, on 99 % of the growth lines"},
     0.01},
    {M::boundary_layer,
     "G12",
     "boundary_layer",
     "area that covers the boundary layer",
     "area",
     false,
     true,
     {0.95, 0.99, k_nan, 1.0},
     {},
     k_of_both,
     {Evidence::definition, Evidence::definition, "total_height, boundary_layer, or the flow conditions of first_height"}},
    {M::coverage, "G12", "coverage", "area at its edge-matching height", "area", false, true, {k_nan, 0.99, k_nan, 1.0}, {}, k_of_both, k_no_limit},
    {M::collapsed, "G12", "collapsed", "area without layers", "area", false, false, {k_nan, 0.0, k_nan, 1.0}, {}, k_of_both, k_no_limit},
    {M::layer_step, "G13", "layer_step", "layer difference across an edge", "edges", false, false, {1, 0, k_nan, 1.0}, {}, k_of_both, k_proposal},
    {M::min_dihedral,
     "G14",
     "min_dihedral",
     "smallest dihedral of a tet",
     "tets",
     true,
     true,
     {5 * k_degree, 12 * k_degree, k_nan, 1.0},
     {0, k_right, 45},
     k_of_both,
     k_flat_by_runs,
     k_flat_share},
    {M::max_dihedral,
     "G14",
     "max_dihedral",
     "largest dihedral of a tet",
     "tets",
     true,
     false,
     {170 * k_degree, 155 * k_degree, k_nan, 1.0},
     {60 * k_degree, 180 * k_degree, 60},
     k_of_both,
     k_flat_by_runs,
     k_flat_share},
    {M::tet_growth,
     "G15",
     "tet_growth",
     "volume ratio of tets at a face",
     "faces",
     false,
     false,
     {20, k_nan, 4, 0.999},
     {1, 0x1p8, 48, 6},
     k_of_both,
     k_flat_by_runs,
     k_flat_share},
    {M::edge_ratio,
     "G16",
     "edge_ratio",
     "edge ratio at a node",
     "nodes",
     false,
     false,
     {100, k_nan, 10, 0.999},
     {1, 0x1p10, 50, 5},
     k_node_centred_alone,
     {Evidence::none, Evidence::cited, k_proposal.source}},
    // Limits are the thresholds of checkMesh and meshQualityDict. Aspect ratios of y+ = 1 prisms exceed all their limits, so the measure is shown only.
    {M::non_orthogonality,
     "OF",
     "non_orthogonality",
     "OpenFOAM non-orthogonality",
     "inner faces",
     true,
     false,
     {88 * k_degree, 70 * k_degree, 65 * k_degree, 0.999},
     {0, k_right, 45},
     k_cell_centred_alone,
     {Evidence::measured, Evidence::none, "docs/measurements/gates.md: OpenFOAM converged up to 87.7 degrees, diverged from 88.9 degrees on"}},
    {M::skewness,
     "OF",
     "skewness",
     "OpenFOAM skewness",
     "faces",
     false,
     false,
     {20, 4, k_nan, 1.0},
     {0x1p-6, 0x1p4, 40, 4},
     k_cell_centred_alone,
     {Evidence::cited, Evidence::none, "OpenFOAM's meshQualityDict: 20 at boundaries, 4 inside"}},
    {M::face_weight,
     "OF",
     "face_weight",
     "OpenFOAM face weight",
     "inner faces",
     false,
     true,
     {0.05, 0.05, k_nan, 1.0},
     {0, 0.5, 50},
     k_cell_centred_alone,
     {Evidence::cited, Evidence::none, "OpenFOAM's meshQualityDict: minFaceWeight"}},
    {M::volume_ratio,
     "OF",
     "volume_ratio",
     "OpenFOAM volume ratio",
     "inner faces",
     false,
     true,
     {0.01, 0.01, k_nan, 1.0},
     {0, 1, 50},
     k_cell_centred_alone,
     {Evidence::cited, Evidence::none, "OpenFOAM's meshQualityDict: minVolRatio"}},
    {M::face_flatness,
     "OF",
     "face_flatness",
     "OpenFOAM flatness of quads",
     "quads",
     false,
     true,
     {k_nan, 0.8, k_nan, 1.0},
     {0.5, 1, 50},
     k_cell_centred_alone,
     k_no_limit},
    {M::cell_aspect_ratio,
     "OF",
     "cell_aspect_ratio",
     "OpenFOAM aspect ratio",
     "cells",
     false,
     false,
     {k_nan, k_nan, k_nan, 1.0},
     {1, 0x1p16, 48, 3},
     k_cell_centred_alone,
     k_no_limit},
    {M::cell_openness,
     "OF",
     "cell_openness",
     "OpenFOAM openness",
     "cells",
     false,
     false,
     {1e-6, 1e-9, k_nan, 1.0},
     {0x1p-60, 0x1p-20, 40, 1},
     k_cell_centred_alone,
     {Evidence::cited, Evidence::none, "OpenFOAM's checkMesh: 1e-6"}},
    // The limit is checkMesh's (SMALL squared): it detects inverted or flat tets and ignores their shape.
    {M::face_tets,
     "OF",
     "face_tets",
     "OpenFOAM decomposition tets",
     "faces",
     false,
     true,
     {1e-30, k_nan, k_nan, 1.0},
     {0, 1, 50},
     k_cell_centred_alone,
     {Evidence::cited, Evidence::none, "OpenFOAM's checkMesh: 1e-30"}},
    // Solver runs diverge if such faces are near the wall (docs/heights.md), but the hard limit applies to the measure over all faces.
    {M::stacked_orthogonality,
     "OF",
     "stacked_orthogonality",
     "non-orthogonality in columns",
     "faces",
     true,
     false,
     {k_nan, 85 * k_degree, 70 * k_degree, 0.999},
     {0, k_right, 45},
     k_cell_centred_alone,
     k_no_limit},
    {M::stacked_skewness,
     "OF",
     "stacked_skewness",
     "skewness in columns",
     "faces",
     false,
     false,
     {k_nan, 20, 4, 0.999},
     {0x1p-6, 0x1p4, 40, 4},
     k_cell_centred_alone,
     k_no_limit},
    // First cells of y+ = 1 are beyond checkMesh's limit here, too, so the measure is shown only.
    {M::cell_determinant,
     "OF",
     "cell_determinant",
     "OpenFOAM cell determinant",
     "cells",
     false,
     true,
     {k_nan, k_nan, k_nan, 1.0},
     {0, 2, 50},
     k_cell_centred_alone,
     k_no_limit},
    {M::cad_distance,
     "G17",
     "cad_distance",
     "wall nodes off the CAD, / length",
     "nodes",
     false,
     false,
     {1e-6, 1e-9, k_nan, 1.0},
     {0x1p-60, 0x1p-12, 48, 1},
     k_of_both,
     k_by_model},
    {M::cad_normal,
     "G18",
     "cad_normal",
     "wall facets against the CAD",
     "facets",
     true,
     false,
     {30 * k_degree, 10 * k_degree, k_nan, 1.0},
     {0, k_right, 45},
     k_of_both,
     k_by_model},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < k_n_measures; ++i)
    if (k_measures[i].classes.n > HistogramClasses::k_most || k_measures[i].measure != static_cast<Measure>(i)) return false;
  return true;
}
static_assert(is_in_order());

}  // namespace

const std::array<MeasureInfo, k_n_measures>& measures() { return k_measures; }
double in_report_unit(const MeasureInfo& info, double value) { return info.is_angle ? value / k_degree : value; }
const MeasureInfo* find_measure(std::string_view name) {
  const auto found = std::find_if(k_measures.begin(), k_measures.end(), [&](const MeasureInfo& info) { return info.name == name; });
  return found == k_measures.end() ? nullptr : &*found;
}

const MeasureInfo& info_of(Measure measure) { return k_measures[static_cast<std::size_t>(measure)]; }

std::string_view trouble_of(Measure measure) {
  switch (measure) {
    case M::scaled_jacobian: return "prisms are nearly folded";
    case M::dual_closure: return "control volumes do not close";
    case M::orthogonality: return "faces of control volumes are nearly parallel to their edges";
    case M::sub_volume_ratio: return "parts of one control volume differ too much in size";
    case M::face_area_ratio: return "faces of one control volume differ too much in area";
    case M::relative_face_area_ratio: return "faces of one control volume differ more in area than a layer requires";
    case M::stack_growth: return "heights of layers jump";
    case M::interface_height: return "the heights of the last layer cells do not match the tetrahedra on them";
    case M::interface_volume: return "the volumes of the last layer cells do not match the tetrahedra on them";
    case M::stack_angle: return "growth lines lean away from the wall normal";
    case M::first_height: return "first cells do not have the requested height";
    case M::boundary_layer: return "the layer is lower than the boundary layer";
    case M::coverage: return "the layer is lower than the geometry permits, so that its last cells do not match the edges of the tetrahedra";
    case M::collapsed: return "parts of the wall have no layer";
    case M::layer_step: return "numbers of layers differ too much across an edge";
    case M::min_dihedral: return "tetrahedra are flat: sharp angles";
    case M::max_dihedral: return "tetrahedra are flat: obtuse angles";
    case M::tet_growth: return "adjacent tetrahedra differ too much in size";
    case M::edge_ratio: return "edges at one node differ too much in length";
    case M::non_orthogonality: return "faces are oblique to the line between the centres of their cells";
    case M::skewness: return "lines between centres of cells miss the face between them";
    case M::face_weight: return "faces are much closer to one of their cells than to the other";
    case M::volume_ratio: return "adjacent cells differ too much in volume";
    case M::face_flatness: return "quadrilaterals are warped";
    case M::cell_aspect_ratio: return "cells are long and thin";
    case M::cell_openness: return "faces of cells do not close";
    case M::face_tets: return "faces cannot be cut into triangles that OpenFOAM's particles and mappings accept";
    case M::stacked_orthogonality: return "the corners of flat prisms grow by different ratios";
    case M::stacked_skewness: return "the corners of flat prisms have different heights above the wall";
    case M::cell_determinant: return "cells are nearly flat";
    case M::cad_distance: return "wall nodes do not lie on the model";
    case M::cad_normal: return "normals of wall triangles differ from the model";
  }
  return "";
}

std::string_view remedy_of(Measure measure) {
  switch (measure) {
    case M::scaled_jacobian:
    case M::dual_closure:
    case M::sub_volume_ratio:
    case M::face_area_ratio:
    case M::relative_face_area_ratio:
    case M::min_dihedral:
    case M::max_dihedral:
    case M::tet_growth:
    case M::edge_ratio:
    case M::face_weight:
    case M::volume_ratio:
    case M::face_flatness:
    case M::cell_aspect_ratio:
    case M::cell_openness:
    case M::face_tets:
    case M::cell_determinant:
      return "remesh the wall there with triangles that change slowly in size, without slivers, in gaps with gap_cells; where a layer collapses at a sharp "
             "edge, "
             "give the "
             "edge a width or use fewer layers";
    case M::orthogonality:
    case M::stack_angle:
    case M::non_orthogonality: return "give the sharp edge a width (trailing_edge of a wing), or round it";
    case M::skewness: return "several normals at the sharp edge (open_ridges = \"always\"), or a width of the edge (trailing_edge of a wing)";
    case M::stacked_orthogonality:
    case M::stacked_skewness: return "growth = \"uniform\", a smaller max_growth, and shorter edges of the wall where heights differ";
    case M::stack_growth:
    case M::interface_height:
    case M::interface_volume:
      return "more layers or a larger max_growth; in corners and narrow places less refinement along them (narrow = 20, intersection_factor = 1), or truncate "
             "= \"auto\"";
    case M::first_height: return "truncate = \"auto\" or fewer layers; where parts meet, narrow = 20. A smaller first_height does not help";
    case M::boundary_layer: return "total_height = boundary_layer{ ... }, more layers or a larger max_growth; in gaps shorter edges of the walls (gap_cells)";
    case M::coverage: return "shorter edges of the wall there, or fewer layers";
    case M::collapsed:
    case M::layer_step: return "give the sharp edge there a width (trailing_edge of a wing), or fewer layers";
    case M::cad_distance: return "mesh the model itself (surface_mesh, sterna mesh model.step), not its triangles";
    case M::cad_normal: return "a smaller chord_error or curvature_angle of surface_mesh";
  }
  return "";
}

}  // namespace sterna
