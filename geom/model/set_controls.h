// Applies deflections to the control surfaces of an aircraft description from sumo or CPACS files.
#pragma once

#include <string>
#include <vector>

#include "geom/model/aircraft.h"

namespace sterna {

struct ControlSetting {
  std::string names;   ///< name of a control surface, or of a control that moves several surfaces; or a pattern with * and ?
  double angle = 0.0;  ///< radians, with the sign of Deflection; the angle of a control is multiplied by the factor of each participating surface
  ControlGap gap = ControlGap::sealed;
  double fairing = Deflection::k_automatic_fairing;  ///< m
  OtherSide other_side = OtherSide::same;            ///< for surfaces that have an image
};

/// Returns the description with its control surfaces deflected. Exact names of surfaces take precedence over controls, and controls over patterns of surface
/// names. Contributions of several controls to one surface are added. If a control moves single segments of a surface, the surface becomes one surface per
/// segment. Neighbours whose fairings would overlap are shortened at their ends (with_room_between). Surfaces without a setting are unchanged.
/// \throws Error(bad_argument) for unknown names (with the existing ones), a surface set twice, surfaces of wings that do not exist
Aircraft with_controls_set(const Aircraft& aircraft, const std::vector<ControlSetting>& settings);

}  // namespace sterna
