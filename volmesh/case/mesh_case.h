// All that is asked of a volume mesh but the surface: options of every stage, and what is no option.
#pragma once

#include <memory>
#include <vector>

#include "geom/base/schema.h"
#include "geom/mesh/tri_mesh.h"
#include "volmesh/case/actuator_disc.h"
#include "volmesh/case/end_options.h"
#include "volmesh/case/envelope_options.h"
#include "volmesh/case/family_options.h"
#include "volmesh/case/farfield_options.h"
#include "volmesh/case/first_heights.h"
#include "volmesh/case/improve_options.h"
#include "volmesh/case/limit_options.h"
#include "volmesh/case/needle_options.h"
#include "volmesh/case/patch_rule.h"
#include "volmesh/case/periodic_names.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/case/prism_options.h"
#include "volmesh/case/ridge_options.h"
#include "volmesh/case/size_options.h"
#include "volmesh/case/size_sources.h"
#include "volmesh/case/tetra_options.h"
#include "volmesh/case/wake_sheet.h"

namespace sterna::volmesh {

/// Options of all stages, in stage order; each has a Schema.
struct MeshOptions {
  FamilyOptions family;
  NeedleOptions needles;
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

/// What is asked for and is no option, and what is known of the surface.
struct MeshFacts {
  /// By place, where rules of patches say nothing else; null: envelope.first_height. With them that is the least of them.
  std::shared_ptr<const FirstHeights> first_heights;
  std::vector<PatchRule> patches;                   ///< what patches ask for instead; of several rules that match the last counts (sort_by_pattern)
  std::shared_ptr<const TriMesh> farfield_surface;  ///< for its shape "surface"
  std::vector<SizeSource> sources;                  ///< of the size field
  std::vector<ActuatorDisc> discs;                  ///< in the fluid
  std::vector<WakeSheet> wakes;                     ///< behind trailing edges of the walls
  std::vector<PeriodicNames> periodic;              ///< pairs of patches, also of those that are added, that are to match node by node and face by face
  /// rad: largest dihedral turn of the wall where it is smooth, where its maker knows it; decides the default feature angle.
  double smooth_angle = k_automatic;
  std::vector<PlacedPart> parts;  ///< of the wall, that were meshed elsewhere and moved: their envelopes are made there, too, and moved (joint_envelope.h)
};

/// The whole request; members of its own would be in no list.
struct MeshCase : MeshOptions, MeshFacts {};

/// All options of all stages, for Lua, the command line, help and the manifest. `options` must outlive the table.
OptionTable options_of(MeshOptions& options);
/// Those that may be given at one of the steps.
OptionTable options_of(MeshOptions& options, MeshSteps steps);
/// All; first_height is not required where rules of patches give it, as then each patch with layers is asked for its own (layers_of_patches), and where no
/// patch is to have layers.
OptionTable required_options_of(MeshCase& mesh_case);

}  // namespace sterna::volmesh
