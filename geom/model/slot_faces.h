// Faces of slots between a wing and its moving parts: coves and noses, walls at the ends. Internal to the wing's builders.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "geom/model/model_builder.h"

namespace sterna {

/// How a cove or nose bulges in a section: an arc about `centre` from the upper to the lower corner through centre + radius * ahead.
struct Bulge {
  Point centre;
  Vec3 ahead;  ///< unit
  double radius = 0.0;
};

/// Place along the span where a cove or nose has a cross section.
struct SlotStation {
  CornerId upper, lower;
  std::optional<Bulge> bulge;  ///< nothing: straight; the same for all stations of a strip
};

/// Cross section of a cove or nose: from the upper corner to the lower one; two edges that meet at the foremost point, or one.
SplitCurve slot_section(ModelBuilder& builder, const SlotStation& station);

/// Faces of a cove or nose: between neighbouring stations bounded by upper[i] and lower[i], which lead from station i to i + 1, and by their sections.
void slot_strip(ModelBuilder& builder, const std::vector<SplitCurve>& sections, const std::vector<SlotStation>& stations, const std::vector<EdgeId>& upper,
                const std::vector<EdgeId>& lower, FaceRole role, const std::string& name);

/// Wall between the parts of an upper and a lower side's cross section (over their own parameters, both from the slot's section away from it or both towards
/// it): ruled, and closed by the section at one end, by `end` (an edge between the other ends; nothing: they meet there) at the other.
struct SlotWall {
  SplitCurve upper, lower;
  bool is_slot_at_start = false;  ///< the slot's section is at the start of both curves
  std::optional<EdgeId> end;
};
void slot_wall(ModelBuilder& builder, const SlotWall& wall, const SplitCurve& section, FaceRole role, const std::string& name);

/// Ruled face between two curves over their whole ranges; `start` and `end` join their starts and their ends.
void ruled_wall(ModelBuilder& builder, const SplitCurve& upper, const SplitCurve& lower, EdgeId start, EdgeId end, FaceRole role, const std::string& name);

/// The pieces of a split curve between two of its places.
SplitCurve pieces(const SplitCurve& split, double from, double to);

}  // namespace sterna
