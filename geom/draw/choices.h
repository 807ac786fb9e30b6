// Parsers for the string values of DrawOptions: views, planes, spheres.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "geom/draw/draw_options.h"
#include "geom/mesh/cut_locations.h"

namespace sterna::draw {

struct Sphere {
  Point center;
  double radius = 0.0;  ///< m
};

/// Returns the direction from the mesh to the eye, not normalised; empty for "automatic".
/// \throws Error(bad_argument)
std::optional<Vec3> view_of(const std::string& text);

/// Parses "x=1.2", "point=0,0,0 normal=0,1,0"; returns nothing if the text is a name.
/// \throws Error(bad_argument) for an incomplete plane
std::optional<CutPlane> plane_of(const std::string& text);

/// Parses "1,2,0 radius=0.5"; returns nothing if the text is a name.
/// \throws Error(bad_argument)
std::optional<Sphere> sphere_of(const std::string& text);

/// Returns the location of that name (case-insensitive).
/// \throws Error(bad_argument) with the existing names; `attempted` is the caller ("draw"), `what` the purpose ("cut")
const CutLocation& location_of(std::span<const CutLocation> locations, const std::string& name, std::string_view attempted, std::string_view what);

/// Throws for an unknown name. \throws Error(unknown_option) with the known names and a suggestion
[[noreturn]] void throw_unknown(std::string_view attempted, std::string_view what, const std::string& given, std::span<const std::string> known,
                                std::string_view more = {});

}  // namespace sterna::draw
