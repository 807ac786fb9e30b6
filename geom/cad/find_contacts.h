// Finds contacts of closed parts before they are united: parts that cross and at which angle, touch, lie inside another part, or are separate.
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
  touching,  ///< the distance is below the tolerance without crossing: a common face, edge or point
  inside,    ///< one part lies in the other
  apart,     ///< a group of connected parts is separate from the rest; the contact gives their nearest points; n groups have n - 1 such contacts
};
std::string_view to_string(ContactKind kind);

struct PartContact {
  std::size_t first = 0, second = 0;  ///< numbers of the parts; for `inside`, `first` lies in `second`; for `apart`, `first` is in the smaller group
  ContactKind kind = ContactKind::crossing;
  Point location;      ///< location of the smallest angle (crossing), a point of `first` (inside), or the location of the smallest distance (other contacts)
  double angle = 0.0;  ///< crossing: smallest angle between the tangent planes, radians
  bool is_crevice = false;       ///< for a crossing: true if the fluid is in the narrow angle between the surfaces, false if they blend into each other
  double gap = 0.0;              ///< apart: smallest distance, metres
  double share_inside = 0.0;     ///< crossing: fraction of the area inside the other part, for the part with the larger fraction
  bool is_first_inside = false;  ///< crossing: `share_inside` refers to `first`
};

/// Fraction of a part's surface that remains in the union, estimated from samples.
struct PartExposure {
  double outside = 1.0;  ///< fraction of the area outside all other parts
  double unsure = 0.0;   ///< fraction of the area that is nearer to another part's surface than 1e-3 of the parts' sizes: common faces, and a strip along every
                         ///< crossing
};

struct ContactReport {
  std::vector<PartContact> contacts;
  std::vector<PartExposure> exposures;  ///< one per part
};

namespace cad {

/// Surfaces that cross at a smaller angle are nearly tangent: their intersection curve is ill-conditioned and elements beside it become slivers. Radians.
inline constexpr double k_tangent_angle = 0.1;
/// A larger fraction of a part's area inside another part is probably not intended.
inline constexpr double k_mostly_inside = 0.9;

/// Finds the contacts of all pairs of parts, and the groups that are separate. Parts are triangulated to 1e-3 of their size; locations, angles and gaps are
/// then computed on the surfaces themselves. Contacts smaller than these triangles may be missed. Takes a few per cent of the time of uniting.
/// \throws Error(geometry_failed) naming the part that cannot be triangulated, Error(cancelled)
ContactReport find_contacts(std::span<const Model> parts, const RunContext& context);

/// Faces of a body that extend out of a container.
struct Overhang {
  std::string component;
  ComponentKind kind = ComponentKind::unknown;
  std::string face;       ///< name of the body's faces
  std::string wall;       ///< name of the container's face beyond which `location` lies
  Point location;         ///< point that is farthest outside
  double distance = 0.0;  ///< distance of `location` from the container, metres
};

/// Finds the overhangs of all bodies that extend out of the container by more than 1e-4 of the body's longest side (a body that stands on a wall does not),
/// from samples as in find_contacts. In the order of the bodies and their faces, one for each face name in a component.
/// \pre normals of both point out of them
/// \throws as find_contacts
std::vector<Overhang> find_overhangs(const Model& container, std::span<const Model> bodies, const RunContext& context);

/// Describes properties of a contact that make uniting or meshing difficult, with names and numbers; empty: none.
std::string doubt_of(const PartContact& contact, std::span<const Model> parts);

/// Returns the name of a part for messages: that of its first component.
std::string part_name(const Model& part);

}  // namespace cad
}  // namespace sterna
