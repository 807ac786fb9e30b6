// Parametric shapes with named options: boxes, cylinders, test sections, and the bodies and wings that represent nacelles, pylons, booms, fairings and stings.
#pragma once

#include <string>
#include <vector>

#include "geom/base/schema.h"
#include "geom/model/aircraft.h"
#include "geom/model/model.h"

namespace sterna {

/// Returns an axis-parallel box as a solid body.
/// \throws Error(bad_argument) if its size is zero
Model make_box(const std::string& name, const Point& from, const Point& to);

/// Returns a solid cylinder between two points.
/// \throws Error(bad_argument) if its length or radius is zero
Model make_cylinder(const std::string& name, const Point& from, const Point& to, double radius);

/// Wind-tunnel test section around the x axis, with the fluid inside and the model at the origin. The section is rectangular (width and height given), with the
/// walls <wall>_floor, <wall>_right at starboard, <wall>_ceiling and <wall>_left, or round (diameter given), with one wall.
struct TestSectionOptions {
  double length = k_automatic;
  double width = k_automatic;
  double height = k_automatic;
  double diameter = k_automatic;
  double upstream = k_automatic;
  double contraction_length = 0.0;
  double contraction_ratio = 1.0;
  double diffuser_length = 0.0;
  double diffuser_angle = 0.0;
  std::string inflow = "inflow";
  std::string outflow = "outflow";
  std::string wall = "tunnel";
};
template <>
struct Schema<TestSectionOptions> {
  using O = TestSectionOptions;
  static constexpr std::string_view stage = "test_section";
  static constexpr std::array fields = {
      Field<O>{.name = "length", .member = &O::length, .unit = Unit::metre, .min = 1e-9, .help = "length of the straight part", .required = true},
      Field<O>{
          .name = "width", .member = &O::width, .unit = Unit::metre, .min = 1e-9, .help = "width along y", .automatic = "required unless the section is round"},
      Field<O>{.name = "height",
               .member = &O::height,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "height along z",
               .automatic = "required unless the section is round"},
      Field<O>{.name = "diameter",
               .member = &O::diameter,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "diameter of a round section, without contraction and diffuser",
               .automatic = "the section is rectangular"},
      Field<O>{.name = "upstream",
               .member = &O::upstream,
               .unit = Unit::metre,
               .help = "length of the straight part upstream of x = 0",
               .automatic = "half the length"},
      Field<O>{.name = "contraction_length",
               .member = &O::contraction_length,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "length of a contraction upstream of the straight part; 0 = none"},
      Field<O>{
          .name = "contraction_ratio", .member = &O::contraction_ratio, .min = 1.0, .max = 100.0, .help = "ratio of the areas at both ends of the contraction"},
      Field<O>{.name = "diffuser_length",
               .member = &O::diffuser_length,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "length of a diffuser downstream of the straight part; 0 = none"},
      Field<O>{.name = "diffuser_angle",
               .member = &O::diffuser_angle,
               .unit = Unit::radian,
               .min = 0.0,
               .max = 0.7853981633974483,
               .help = "angle of each wall of the diffuser to x"},
      Field<O>{.name = "inflow", .member = &O::inflow, .help = "name of the inflow patch"},
      Field<O>{.name = "outflow", .member = &O::outflow, .help = "name of the outflow patch"},
      Field<O>{
          .name = "wall",
          .member = &O::wall,
          .help = "prefix of the names of the walls: tunnel_floor, tunnel_right (starboard), tunnel_ceiling, tunnel_left; of a round section: the name itself"},
  };
};
/// \throws Error(bad_argument)
Model make_test_section(const TestSectionOptions& options);

/// Nacelle of circular sections with an inlet lip down to a fan face and a flat nozzle; its front is at `position`.
struct NacelleOptions {
  double length = k_automatic;
  double diameter = k_automatic;
  double highlight_ratio = 0.82;
  double fan_ratio = 0.78;
  double fan_depth = 0.25;
  double exit_ratio = 0.6;
  double thickest = 0.35;
};
template <>
struct Schema<NacelleOptions> {
  using O = NacelleOptions;
  static constexpr std::string_view stage = "nacelle";
  static constexpr std::array fields = {
      Field<O>{.name = "length", .member = &O::length, .unit = Unit::metre, .min = 1e-9, .help = "length along x", .required = true},
      Field<O>{.name = "diameter", .member = &O::diameter, .unit = Unit::metre, .min = 1e-9, .help = "largest outer diameter", .required = true},
      Field<O>{.name = "highlight_ratio",
               .member = &O::highlight_ratio,
               .min = 0.3,
               .max = 0.99,
               .help = "diameter of the front edge, relative to the largest diameter"},
      Field<O>{.name = "fan_ratio",
               .member = &O::fan_ratio,
               .min = 0.1,
               .max = 0.98,
               .help = "diameter of the fan face, relative to the largest diameter; below highlight_ratio"},
      Field<O>{
          .name = "fan_depth", .member = &O::fan_depth, .min = 0.01, .max = 0.8, .help = "distance of the fan face behind the front, relative to the length"},
      Field<O>{
          .name = "exit_ratio", .member = &O::exit_ratio, .min = 0.1, .max = 0.99, .help = "diameter of the nozzle plane, relative to the largest diameter"},
      Field<O>{.name = "thickest", .member = &O::thickest, .min = 0.1, .max = 0.8, .help = "position of the largest diameter, relative to the length"},
  };
};
/// \throws Error(bad_argument)
Body nacelle_body(const std::string& name, const Point& position, const NacelleOptions& options);

/// Pylon between a wing and a nacelle below or above it. It extends from just below the cowl's surface to inside the wing.
struct PylonOptions {
  double thickness = 0.1;
  double nacelle_from = 0.2;
  double nacelle_to = 0.95;
  double wing_from = 0.1;
  double wing_to = 0.7;
};
template <>
struct Schema<PylonOptions> {
  using O = PylonOptions;
  static constexpr std::string_view stage = "pylon";
  static constexpr std::array fields = {
      Field<O>{.name = "thickness", .member = &O::thickness, .min = 0.005, .max = 0.5, .help = "thickness of the sections, relative to their chord"},
      Field<O>{.name = "nacelle_from",
               .member = &O::nacelle_from,
               .min = 0.0,
               .max = 1.0,
               .help = "position of the leading edge at the cowl, relative to the nacelle's length"},
      Field<O>{.name = "nacelle_to",
               .member = &O::nacelle_to,
               .min = 0.0,
               .max = 1.5,
               .help = "position of the pylon's trailing edge on the nacelle, as a fraction of the nacelle's length; above 0.98 the trailing edge lies behind "
                       "the nozzle, above the jet"},
      Field<O>{.name = "wing_from",
               .member = &O::wing_from,
               .min = -0.5,
               .max = 0.9,
               .help = "position of the leading edge in the wing, relative to the local chord"},
      Field<O>{
          .name = "wing_to", .member = &O::wing_to, .min = 0.0, .max = 1.0, .help = "position of the trailing edge in the wing, relative to the local chord"},
  };
};
/// The lower end of the pylon follows the outer surface that faces the wing. The pylon leaves the nacelle only through that surface, not through the nozzle
/// plane.
/// \throws Error(bad_argument) if the nacelle is not within the wing's span, is narrower than the pylon is thick, or the trailing edge still passes through the
/// nozzle plane
Wing pylon_wing(const std::string& name, const Wing& wing, const Body& nacelle, const PylonOptions& options);

/// Returns the placement of a body whose axis points from one point to another; no roll.
/// \throws Error(bad_argument) if the points coincide
Placement placement_along(const Point& from, const Point& to);

/// Body of circular sections through profile points: u = x along the axis of `placement`, v = radius; ascending x. The radius may be 0 (a point) only at the
/// ends; ends with a positive radius are flat. Smooth without overshoot of the given radii, or straight between the points.
/// \throws Error(bad_argument) naming the point
Body body_of_revolution(const std::string& name, const Placement& placement, const std::vector<Uv>& profile, bool is_straight = false,
                        ComponentKind kind = ComponentKind::body);

/// Round tube between two points, with half-elliptic ends within its length.
struct BoomOptions {
  double diameter = k_automatic;
  double nose_length = k_automatic;
  double tail_length = k_automatic;
};
template <>
struct Schema<BoomOptions> {
  using O = BoomOptions;
  static constexpr std::string_view stage = "boom";
  static constexpr std::array fields = {
      Field<O>{.name = "diameter", .member = &O::diameter, .unit = Unit::metre, .min = 1e-9, .help = "diameter of the tube", .required = true},
      Field<O>{.name = "nose_length",
               .member = &O::nose_length,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "length of the rounded front end; 0 = flat",
               .automatic = "one diameter"},
      Field<O>{.name = "tail_length",
               .member = &O::tail_length,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "length of the rounded rear end; 0 = flat",
               .automatic = "two diameters"},
  };
};
/// \throws Error(bad_argument) if both ends together are not shorter than the boom
Body boom_body(const std::string& name, const Point& from, const Point& to, const BoomOptions& options);

/// Streamlined body of superelliptic sections, pointed at the rear, round at the front; its front is at `position`.
struct FairingOptions {
  double length = k_automatic;
  double width = k_automatic;
  double height = k_automatic;
  double thickest = 0.4;
  double exponent = 2.5;
};
template <>
struct Schema<FairingOptions> {
  using O = FairingOptions;
  static constexpr std::string_view stage = "fairing";
  static constexpr std::array fields = {
      Field<O>{.name = "length", .member = &O::length, .unit = Unit::metre, .min = 1e-9, .help = "length along x", .required = true},
      Field<O>{.name = "width", .member = &O::width, .unit = Unit::metre, .min = 1e-9, .help = "width of the largest section, along y", .required = true},
      Field<O>{.name = "height", .member = &O::height, .unit = Unit::metre, .min = 1e-9, .help = "height of the largest section, along z", .required = true},
      Field<O>{.name = "thickest", .member = &O::thickest, .min = 0.1, .max = 0.8, .help = "position of the largest section, relative to the length"},
      Field<O>{
          .name = "exponent", .member = &O::exponent, .min = 1.2, .max = 8.0, .help = "exponent of the sections: 2 = ellipses, larger = closer to rectangles"},
  };
};
/// \throws Error(bad_argument)
Body fairing_body(const std::string& name, const Point& position, const FairingOptions& options);

/// Sting of a wind-tunnel model: a cylinder that starts inside the model, then a cone; both ends flat.
struct StingOptions {
  double diameter = k_automatic;
  double cone_start = k_automatic;
  double end_diameter = k_automatic;
};
template <>
struct Schema<StingOptions> {
  using O = StingOptions;
  static constexpr std::string_view stage = "sting";
  static constexpr std::array fields = {
      Field<O>{.name = "diameter", .member = &O::diameter, .unit = Unit::metre, .min = 1e-9, .help = "diameter of the cylinder", .required = true},
      Field<O>{.name = "cone_start",
               .member = &O::cone_start,
               .unit = Unit::metre,
               .min = 0.0,
               .help = "distance of the cone from the front end; 0 = the whole sting is a cone",
               .automatic = "no cone"},
      Field<O>{.name = "end_diameter",
               .member = &O::end_diameter,
               .unit = Unit::metre,
               .min = 1e-9,
               .help = "diameter of the rear end",
               .automatic = "diameter of the cylinder"},
  };
};
/// \throws Error(bad_argument)
Body sting_body(const std::string& name, const Point& from, const Point& to, const StingOptions& options);

}  // namespace sterna
