// The complete request for a volume mesh except the surface: options of every stage, and inputs that are not options.
#pragma once

#include <memory>
#include <vector>

#include "geom/base/rules.h"
#include "geom/mesh/periodic_names.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/actuator_disc.h"
#include "volmesh/case/end_options.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/family_options.h"
#include "volmesh/case/farfield_options.h"
#include "volmesh/case/first_heights.h"
#include "volmesh/case/improve_options.h"
#include "volmesh/case/limit_options.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/case/prism_options.h"
#include "volmesh/case/ridge_options.h"
#include "volmesh/case/size_options.h"
#include "volmesh/case/size_sources.h"
#include "volmesh/case/sliver_options.h"
#include "volmesh/case/tetra_options.h"
#include "volmesh/case/wake_sheet.h"

namespace sterna::volmesh {

/// Options of all stages, in the order of the stages. Each struct has a Schema.
struct MeshOptions {
  FamilyOptions family;
  SliverOptions needles;
  RidgeOptions ridges;
  EnvelopeOptions envelope;
  PrismOptions prisms;
  FarfieldOptions farfield;
  EndOptions ends;
  SizeFieldOptions size;
  TetraOptions tetrahedra;
  ImproveOptions improve;
  LimitOptions limits;
};

/// Inputs that are not options, and known properties of the surface.
struct MeshFacts {
  /// First heights that depend on the location, for patches whose rules set none. Null: envelope.first_height applies. If set, envelope.first_height is their
  /// minimum.
  std::shared_ptr<const FirstHeights> first_heights;
  std::vector<Rule> patches;                        ///< options of patches (layer_rules.h); if several rules match, the last one is used (sort_by_pattern)
  std::shared_ptr<const TriMesh> farfield_surface;  ///< outer boundary for the farfield shape "surface"
  std::vector<SizeSource> sources;                  ///< sources of the size field
  std::vector<ActuatorDisc> discs;                  ///< actuator discs in the fluid
  std::vector<WakeSheet> wakes;                     ///< wake sheets behind trailing edges of the walls
  std::vector<PeriodicNames> periodic;              ///< pairs of patches, including added patches, that must match node by node and face by face
  /// Rad: largest dihedral turn in the smooth part of the wall, if the surface mesher provides it. The default feature angle follows from it.
  double smooth_angle = k_automatic;
  /// Parts of the wall that were meshed in their own frame and moved; their envelopes are also made in that frame and moved (joint_envelope.h).
  std::vector<PlacedPart> parts;
};

/// The complete request. It must have no members of its own, because no option list would contain them.
struct MeshCase : MeshOptions, MeshFacts {};

/// Returns all options of all stages, for Lua, the command line, help and the manifest. `options` must outlive the table.
OptionTable options_of(MeshOptions& options);
/// Returns the options that may be given at one of the steps.
OptionTable options_of(MeshOptions& options, MeshSteps steps);
/// Returns all options. first_height is not required if patch rules give it (layers_of_patches then checks each patch with layers), nor if no patch has layers.
OptionTable required_options_of(MeshCase& mesh_case);

}  // namespace sterna::volmesh
