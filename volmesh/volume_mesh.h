// The driver: from a wall to a hybrid mesh. A list of steps, nothing else.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/mesh/check.h"
#include "geom/mesh/hybrid_mesh.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/family_options.h"
#include "volmesh/case/farfield_options.h"
#include "volmesh/case/first_heights.h"
#include "volmesh/case/patch_rule.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/case/prism_options.h"
#include "volmesh/domain/actuator_disc.h"
#include "volmesh/domain/periodic_sides.h"
#include "volmesh/envelope/certificate.h"
#include "volmesh/improve/improve.h"
#include "volmesh/layer/first_node.h"
#include "volmesh/layer/true_surface.h"
#include "volmesh/parts/part_envelope.h"
#include "volmesh/rims/end_surface.h"
#include "volmesh/tetra/size_field.h"
#include "volmesh/tetra/tetra.h"

namespace sterna::volmesh {

struct VolumeMeshOptions {
  FamilyOptions family;
  EnvelopeOptions envelope;
  std::shared_ptr<const FirstHeights>
      first_heights;               ///< by place, where rules of patches say nothing else; null: envelope.first_height. With them that is the least of them
  std::vector<PatchRule> patches;  ///< what patches ask for instead; of several rules that match the last counts (sort_by_pattern)
  PrismOptions prisms;
  FarfieldOptions farfield;
  std::shared_ptr<const TriMesh> farfield_surface;  ///< for its shape "surface"
  EndOptions ends;
  SizeFieldOptions size;
  std::vector<SizeSource> sources;      ///< of the size field
  std::vector<ActuatorDisc> discs;      ///< in the fluid
  std::vector<PeriodicNames> periodic;  ///< pairs of patches, also of those that are added, that are to match node by node and face by face
  TetraOptions tetrahedra;
  ImproveOptions improve;
  double smooth_angle =
      k_automatic;                  ///< rad: largest dihedral turn of the wall where it is smooth, where its maker knows it; decides the default feature angle
  std::vector<PlacedPart> parts;    ///< of the wall, that were meshed elsewhere and moved: their envelopes are made there, too, and moved (joint_envelope.h)
  PartEnvelopeMaker part_envelope;  ///< makes these; empty: part_envelope()
  WallEnvelopeMaker wall_envelope;  ///< makes the envelope of a wall without such parts; empty: build_envelope()
  TrueSurface true_surface;         ///< where new wall vertices go when boundary triangles are split; empty: they stay on their triangle
};

/// All options of all stages but the rules of patches, in stage order, for Lua, the command line, help and the manifest. `options` must outlive the table.
OptionTable options_of(VolumeMeshOptions& options);
/// The same; first_height is not required where rules of patches give it, as then each patch with layers is asked for its own (layers_of_patches).
OptionTable required_options_of(VolumeMeshOptions& options);

/// Shares of a patch's area, by its triangles' corners. The rest has less than its full height, but its first height.
struct PatchCoverage {
  std::string name;
  double area = 0.0;                                      ///< m^2
  double full = 0.0;                                      ///< h >= 0.9 h_target
  double compressed = 0.0;                                ///< 0 < normal_height < n h0: equally spaced, h0 not met
  double collapsed = 0.0;                                 ///< no layer
  std::vector<std::pair<std::string, double>> lost_area;  ///< share below 0.9 h_target by reason, largest first
};

inline constexpr std::array<double, 4> k_visibility_limits_deg = {30.0, 45.0, 60.0, 80.0};

/// Visibility angle of a vertex: between the direction that sees the worst of its faces best and that face's normal, rad.
struct VisibilityReport {
  Column<VertexId, double> angle;
  double max_angle = 0.0;
  std::array<double, 4> share_above{};  ///< of the vertices, above k_visibility_limits_deg
  std::vector<ErrorPlace> hardest;      ///< the worst ten above the first of these limits
};

/// Last prism's height over that of a regular tetrahedron on its top, 0.816 times the mean edge there: shares of the envelope's area.
struct InterfaceReport {
  double within = 0.0;          ///< ratio in [1/3, 3]
  double below = 0.0;           ///< thinner
  double above = 0.0;           ///< thicker
  double within_of_full = 0.0;  ///< `within` of the triangles with full height at all corners: elsewhere the layer had to be compressed
};

/// What became of the layer; see method.md §2 for h_target.
struct LayerReport {
  double body_length = 0.0;        ///< m
  double coverage = 0.0;           ///< share of wall area with h >= 0.9 h_target
  double target_over_eq1 = 0.0;    ///< area mean of h_target over eq. (1)
  double mean_height_share = 0.0;  ///< area mean h over area mean h_target
  double mean_height = 0.0;        ///< m, area-weighted
  double feature_angle = 0.0;      ///< rad, the user's or the one found
  VisibilityReport visibility;
  std::int64_t n_vertices = 0;
  std::int64_t n_compressed = 0;                          ///< normal_height < n h0: equally spaced, h0 not met
  std::vector<std::pair<std::string, double>> lost_area;  ///< share of wall area below 0.9 h_target by reason, largest first
  double compressed_area = 0.0;                           ///< share of the wall area
  double collapsed_area = 0.0;                            ///< share of the wall area
  std::vector<PatchCoverage> patches;                     ///< in the wall's order
  std::vector<ErrorPlace> collapsed;                      ///< each collapsed vertex: place, patch and reason
  std::vector<ErrorPlace> compressed;  ///< the lowest standing vertices below n h0 (k_listed_compressed at most): place, patch, height and reason
  FirstNodeReport first_node;          ///< how far the first nodes are off the wall
  InterfaceReport interface;
  std::array<std::int64_t, 5> reduced_curving{};  ///< lines with less than wall_perpendicularity, by share of it: 0, up to 1/4, 1/2, 3/4, below 1
  std::vector<std::string> warnings;              ///< what looks like a mistake in the settings, each a sentence; logged too
};

inline constexpr std::size_t k_listed_compressed = 20;

struct VolumeMeshResult {
  HybridMesh mesh;
  LayerReport layer;
  EnvelopeCertificate certificate;
  CheckReport check;
  ImproveReport improvement;
  std::string tetra_engine;                 ///< "tetgen", "tetgen in two passes" or "hxt"
  std::vector<std::string> tetra_failures;  ///< of the attempts before it, in order
  std::int64_t n_split_triangles = 0;       ///< of wall and outer boundary, by which the mesh has more than were given
  bool is_reproducible = true;              ///< false when a time or memory limit decided what was done
  double tetra_engine_seconds = 0.0;        ///< inside the engine alone; log only
  double tetra_engine_peak_bytes = 0.0;     ///< log only
};

/// Steps: farfield, envelope (build_envelope.h), extrude and repair, certificate, tetrahedra, improve, assemble, check. Where the tetrahedra's engine was to
/// split triangles of its boundary (tetra.h), wall, envelope and farfield of the mesh are split with them (split_layer.h); where all engines fail, the envelope
/// is repaired and everything from the extrusion on is done again (repair_envelope.h), 3 times at most. \pre wall closed, manifold, free of self-intersection,
/// normals into the fluid. \throws Error of the stages; mesh_invalid when the final check finds violations.
VolumeMeshResult volume_mesh(const TriMesh& wall, const VolumeMeshOptions& options, const RunContext& context);

}  // namespace sterna::volmesh
