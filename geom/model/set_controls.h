// Deflections asked of the control surfaces that an aircraft's description has: files of sumo and CPACS.
#pragma once

#include <string>
#include <vector>

#include "geom/model/aircraft.h"

namespace sterna {

struct ControlSetting {
  std::string names;   ///< of control surfaces or of a control that moves some; a pattern (* and ?)
  double angle = 0.0;  ///< radians; as of Deflection; of a control: times the factor of each of its participations
  ControlGap gap = ControlGap::sealed;
  double fairing = Deflection::k_automatic_fairing;  ///< m
  OtherSide other_side = OtherSide::same;            ///< of surfaces that have an image
};

/// The description with its control surfaces turned: exact names of surfaces count before controls, those before patterns over surfaces; controls that move one
/// surface together add up. Surfaces of which a control moves single segments become one surface for each segment. Neighbours whose fairings would overlap are
/// drawn in at their ends (with_room_between). Surfaces that no setting names keep what they have.
/// \throws Error(bad_argument) for names that nothing has (with those that exist), one surface asked for twice, surfaces of wings that are not there
Aircraft with_controls_set(const Aircraft& aircraft, const std::vector<ControlSetting>& settings);

}  // namespace sterna
