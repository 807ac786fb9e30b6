// Faces of slots between a wing and its moving parts: coves, noses, and walls at the ends. Internal to the wing's builders.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geom/model/model_builder.h"

namespace sterna {

/// Shape of a cove or nose in a section: an arc about `centre` from the upper to the lower corner through centre + radius * ahead.
struct Bulge {
  Point centre;
  Vec3 ahead;  ///< unit
  double radius = 0.0;
};

/// Location along the span where a cove or nose has a cross section.
struct SlotStation {
  CornerId upper, lower;
  std::optional<Bulge> bulge;  ///< empty: straight; the same for all stations of a strip
};

/// Creates the cross section of a cove or nose, from the upper corner to the lower one: two edges that meet at the foremost point, or one edge.
SplitCurve slot_section(ModelBuilder& builder, const SlotStation& station);

/// Creates the faces of a cove or nose between neighbouring stations. They are bounded by upper[i] and lower[i], which lead from station i to i + 1, and by the
/// sections of these stations.
void slot_strip(ModelBuilder& builder, const std::vector<SplitCurve>& sections, const std::vector<SlotStation>& stations, const std::vector<EdgeId>& upper,
                const std::vector<EdgeId>& lower, FaceRole role, const std::string& name);

/// Wall between parts of the cross sections of an upper and a lower side. Each curve has its own parameter, but both run away from the slot's section or both
/// towards it. The wall is ruled. At one end it is closed by the section, at the other by `end`, an edge between the other ends of the curves (empty: they meet
/// there).
struct SlotWall {
  SplitCurve upper, lower;
  bool is_slot_at_start = false;  ///< the slot's section is at the start of both curves
  std::optional<EdgeId> end;
};
void slot_wall(ModelBuilder& builder, const SlotWall& wall, const SplitCurve& section, FaceRole role, const std::string& name);

/// Creates a ruled face between two curves over their whole ranges; `start` and `end` join their starts and their ends.
void ruled_wall(ModelBuilder& builder, const SplitCurve& upper, const SplitCurve& lower, EdgeId start, EdgeId end, FaceRole role, const std::string& name);

/// Returns the pieces of a split curve between two parameters.
SplitCurve pieces(const SplitCurve& split, double from, double to);

}  // namespace sterna
