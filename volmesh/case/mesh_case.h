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
#include "volmesh/case/patch_rule.h"
#include "volmesh/case/periodic_names.h"
#include "volmesh/case/placed_part.h"
#include "volmesh/case/prism_options.h"
#include "volmesh/case/size_options.h"
#include "volmesh/case/size_sources.h"
#include "volmesh/case/tetra_options.h"

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
      k_automatic;                ///< rad: largest dihedral turn of the wall where it is smooth, where its maker knows it; decides the default feature angle
  std::vector<PlacedPart> parts;  ///< of the wall, that were meshed elsewhere and moved: their envelopes are made there, too, and moved (joint_envelope.h)
};

/// All options of all stages but the rules of patches, in stage order, for Lua, the command line, help and the manifest. `options` must outlive the table.
OptionTable options_of(VolumeMeshOptions& options);
/// The same; first_height is not required where rules of patches give it, as then each patch with layers is asked for its own (layers_of_patches).
OptionTable required_options_of(VolumeMeshOptions& options);

}  // namespace sterna::volmesh
