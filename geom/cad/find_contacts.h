// How closed parts meet, before anything is united: which cross and at which angle, which only touch, lie inside another, or stay apart.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/model/model.h"

namespace sterna {

enum class ContactKind {
  crossing,  ///< the surfaces intersect
  touching,  ///< they come nearer than the tolerance without crossing: a common face, edge or point
  inside,    ///< one lies in the other
  apart,     ///< nearest places of a group of connected parts and the rest: as many as there are groups, less one
};
std::string_view to_string(ContactKind kind);

struct PartContact {
  std::size_t first = 0, second = 0;  ///< numbers of the parts; inside: `first` lies in `second`; apart: `first` is of the lesser group
  ContactKind kind = ContactKind::crossing;
  Point place;                   ///< crossing: where the angle is least; else where they are nearest; inside: a point of `first`
  double angle = 0.0;            ///< crossing: least angle between the tangent planes, radians
  bool is_crevice = false;       ///< crossing: there the fluid is between the surfaces, else they run into each other smoothly
  double gap = 0.0;              ///< apart: least distance, metres
  double share_inside = 0.0;     ///< crossing: share of the area of that part that is more inside the other
  bool is_first_inside = false;  ///< crossing: `share_inside` is of `first`
};

/// How much of a part's surface the union will have, by samples.
struct PartExposure {
  double outside = 1.0;  ///< share of the area that is outside of all other parts
  double unsure = 0.0;   ///< share that is within 1e-3 of the parts' sizes of another part's surface: common faces, and a strip along every crossing
};

struct ContactReport {
  std::vector<PartContact> contacts;
  std::vector<PartExposure> exposures;  ///< of the parts
};

namespace cad {

/// Surfaces that cross at less than this are nearly tangent: the curve where they meet is badly defined, elements beside it become slivers. Radians.
inline constexpr double k_tangent_angle = 0.1;
/// A part with more of its area inside another is hardly meant so.
inline constexpr double k_mostly_inside = 0.9;

/// Contacts of all pairs of parts, and those groups that are apart. Parts are triangulated to 1e-3 of their size; places, angles and gaps are then taken from
/// the surfaces themselves. Contacts smaller than these triangles may be missed. Takes a few per cent of the time of uniting.
/// \throws Error(geometry_failed) naming the part that cannot be triangulated, Error(cancelled)
ContactReport find_contacts(std::span<const Model> parts, const RunContext& context);

/// Patches of a body that reach out of a container.
struct Overhang {
  std::string component;
  ComponentKind kind = ComponentKind::unknown;
  std::string face;       ///< name of the body's faces
  std::string wall;       ///< name of the container's face beyond which `place` lies
  Point place;            ///< that is farthest out
  double distance = 0.0;  ///< of it from the container, metres
};

/// Those of all bodies that reach out of the container by more than 1e-4 of the body's longest side (what stands on a wall does not), by samples as
/// find_contacts takes them; in the order of the bodies and their faces, one for each name of faces in a component.
/// \pre normals of both point out of them
/// \throws as find_contacts
std::vector<Overhang> find_overhangs(const Model& container, std::span<const Model> bodies, const RunContext& context);

/// What a contact has that makes uniting or meshing hard, in words with names and numbers; empty: nothing.
std::string doubt_of(const PartContact& contact, std::span<const Model> parts);

/// Name of a part for messages: that of its first component.
std::string part_name(const Model& part);

}  // namespace cad
}  // namespace sterna
