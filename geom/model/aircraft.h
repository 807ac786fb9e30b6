// An aircraft as data, as described by .smx and CPACS files and scripts, before any surface is built from it. The data are plain structs in metres and radians,
// with x aft, y to the right wing and z up.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/model/frame.h"
#include "geom/model/model.h"
#include "geom/model/nurbs_form.h"

namespace sterna {

/// Position and orientation of a component. It is first rotated about the fixed axes x, then y, then z, and then translated to `origin`.
struct Placement {
  Point origin;
  Vec3 rotation;  ///< radians
  friend constexpr bool operator==(const Placement&, const Placement&) = default;
};

/// Returns the transformation from component axes to those of the aircraft.
Transform transform_of(const Placement& placement);

enum class CapShape { strip, dome };  ///< half-elliptic strip over the end (sumo: LongCap); polar dome with continuous slope (RingCap)

/// End of a body or wing.
struct EndCap {
  CapShape shape = CapShape::dome;
  double height = 0.0;  ///< relative to the half thickness; 0 = flat
  friend bool operator==(const EndCap&, const EndCap&) = default;
};

/// Limits of surface edge lengths given in a file; lengths in metres. NaN: not given.
struct RefinementRegion {
  bool is_ellipse = false;
  Uv lower, upper;  ///< rectangle in the component's (u, v)
  Uv center;        ///< ellipse
  double radius_u = 0.0, radius_v = 0.0;
  double factor = 1.0;  ///< multiple of the longest edge
  friend bool operator==(const RefinementRegion&, const RefinementRegion&) = default;
};
struct MeshCriterion {
  bool is_automatic = false;  ///< the limits below are only results of an earlier run
  bool is_wing = false;
  bool is_stretched = false;  ///< edge lengths are anisotropic along the span (sumo: xcoarse)
  std::optional<double> max_edge, min_edge;
  std::optional<double> max_normal_angle;  ///< radians between normals of a triangle
  std::optional<double> max_stretch;
  std::optional<std::int64_t> max_vertices;
  double leading_edge_factor = 1.0, trailing_edge_factor = 1.0;
  std::vector<RefinementRegion> regions;
  std::vector<double> scale, breaks;  ///< sumo's local chord scaling; sumo rebuilds it if the lengths differ
  std::vector<double> kinks;
  std::vector<Vec3> kink_tangents;
  friend bool operator==(const MeshCriterion&, const MeshCriterion&) = default;
};

// ---------------------------------------------------------------------------------------------------------------------- bodies

enum class FrameShape { points, circle, ellipse, double_ellipse, egg, isikveren, loop };

/// Cross section of a body in a plane x = const. A section of shape `loop` may be any closed curve in space.
struct BodyFrame {
  std::string name;
  Point center;         ///< m, in component axes
  double height = 1.0;  ///< m, full height
  double width = 1.0;
  FrameShape shape = FrameShape::circle;
  bool is_symmetric = true;
  int n_points = 7;                               ///< spline points sampled from a formula on the half section
  double exponent = 2.0;                          ///< ellipse: |y|^n + |z|^n = 1
  double offset = 0.0;                            ///< double ellipse: height of the widest point, relative to the half height
  double distortion = 0.0;                        ///< Huegelschaeffer's egg
  double zp = 0.0, a0 = 0.0, a1 = 0.0, b1 = 0.0;  ///< parameters of Isikveren's section, as in CEASIOM
  /// Shape `points`: right half from the bottom (0, -1) to the top (0, 1), u = y / (width / 2), v = z / (height / 2).
  std::vector<Uv> points;
  /// Shape `loop`: the whole section in component axes, from the bottom over the right side, the top and the left side; not closed by a repeated point.
  std::vector<Point> loop;
  friend bool operator==(const BodyFrame&, const BodyFrame&) = default;
};

/// Inner lip of an inlet that replaces the front cap and leads down to a flat fan face.
struct InletLip {
  double axial_offset = 0.4;   ///< depth of the fan face behind the front frame, in mean front radii
  double radial_offset = 0.2;  ///< reduction of the fan face radius, in mean front radii
  double shape = 1.0;          ///< fullness of the lip
  friend bool operator==(const InletLip&, const InletLip&) = default;
};

/// Interpolation of a body along its frames, named as in SplineTangents. With two frames only, all kinds are straight.
enum class BodyTangents {
  bessel,    ///< .smx, CPACS
  akima,     ///< .smx: straight parts stay straight
  monotone,  ///< never overshoots the two frames of an interval
  linear,    ///< straight between frames, with an edge at each
};

struct Body {
  std::string name;
  ComponentKind kind = ComponentKind::body;  ///< components with an inlet lip are always nacelles
  Placement placement;
  BodyTangents tangents = BodyTangents::bessel;  ///< from frame to frame
  bool has_mirror_image = false;                 ///< a mirror image exists on the other side of y = 0
  std::vector<BodyFrame> frames;                 ///< ascending x; at least 2
  std::optional<InletLip> lip;
  EndCap nose, tail;
  std::optional<MeshCriterion> criterion;
  friend bool operator==(const Body&, const Body&) = default;
};

// ---------------------------------------------------------------------------------------------------------------------- wings

/// Control surface at the trailing edge or at the leading edge, or of the whole chord.
enum class ControlKind { trailing_edge, leading_edge, all_moving };
std::string_view to_string(ControlKind kind);

/// Named part of a wing's surface: the location of a control surface. It lies behind (or ahead of) a border across sections, or is the whole chord.
struct WingPatch {
  struct Location {
    double section = 0.0;  ///< number of the section, counted from tip to tip (both halves of a symmetric wing); fractions: between two sections
    double upper = 1.0;    ///< where the border crosses the upper side: parameter of rows (section_rows.h), from 0 at the trailing edge to 1 at the leading
                           ///< edge
    double lower = 1.0;
    friend bool operator==(const Location&, const Location&) = default;
  };
  /// The moving part is a separate solid. The rest of the wing has a cut-out with a cove and side walls, and ends at the patch's border.
  struct Slot {
    std::vector<Location> hinge;  ///< points at the sections of the border where the hinge crosses the upper and lower side
    double from = 0.0, to = 0.0;  ///< sections between which the moving part extends, within those of the border
    bool is_flat = false;         ///< nose of the moving part is flat
    Transform motion;             ///< motion of the moving part, component axes
    friend bool operator==(const Slot&, const Slot&) = default;
  };
  std::string name;
  ControlKind kind = ControlKind::trailing_edge;
  std::vector<Location> border;  ///< at least 2, by ascending section; between them the border is straight in the parameters of the sides
  std::optional<Slot> slot;
  friend bool operator==(const WingPatch&, const WingPatch&) = default;
};

struct WingSection {
  std::string name;
  Point leading_edge;  ///< component axes
  double chord = 1.0;
  double twist = 0.0;      ///< rotation about +y (nose up)
  double dihedral = 0.0;   ///< rotation about +x
  double yaw = 0.0;        ///< rotation about +z
  std::string airfoil;     ///< label
  std::vector<Uv> points;  ///< unit chord, u = x, v = z: trailing edge, upper side, leading edge, lower side, trailing edge
  /// If not empty, the points of the airfoil in component axes, in the same order; chord and angles above are ignored.
  std::vector<Point> loop;
  bool is_row = false;       ///< `loop` holds exactly the points that surfaces are splined through (section_rows.h); they are not resampled
  bool is_break = false;     ///< the wing has a kink here
  bool is_reversed = false;  ///< airfoil upside down
  int n_approximation = -1;  ///< number of points of sumo's least-squares airfoil; -1: the airfoil is interpolated
  std::string naca;          ///< designation given in a file in place of points
  std::optional<double> extend_leading_x, extend_leading_y, extend_trailing_x, extend_trailing_y;  ///< sumo's fairing airfoils; kept, not applied
  friend bool operator==(const WingSection&, const WingSection&) = default;
};

/// Sections in order along the span, right tip first. In a symmetric wing the last one lies in the plane of symmetry and the other half follows.
struct Wing {
  std::string name;
  Placement placement;
  bool is_symmetric = false;
  bool has_winglet = false;       ///< elliptic arcs replace the wing just inboard of the winglet's root, if there is a winglet (winglet_blend.h)
  bool has_mirror_image = false;  ///< a mirror image exists on the other side of y = 0, for a wing that does not reach that plane
  bool is_pylon = false;
  bool is_cubic = false;                ///< cubic along the span between breaks; else straight
  std::vector<WingSection> sections;    ///< at least 2
  std::optional<double> trailing_edge;  ///< thickness in metres, 0 = sharp; empty: as given by the airfoils
  EndCap right_tip{CapShape::strip, 1.0};
  EndCap left_tip{CapShape::strip, 1.0};  ///< cap of the last section if not symmetric
  std::optional<MeshCriterion> criterion;
  std::vector<WingPatch> patches;  ///< see deflection.h; patches do not overlap
  friend bool operator==(const Wing&, const Wing&) = default;
};

// ---------------------------------------------------------------------------------------------------------------------- nacelles

/// Profile of a cowl at an angle about the axis.
struct CowlSection {
  std::string name;
  double angle = 0.0;       ///< radians, right-hand rule about +x from the top: towards the left wing
  std::vector<Uv> profile;  ///< u = x, v = distance from the axis: trailing edge, inner side, leading edge, outer side, trailing edge
  friend bool operator==(const CowlSection&, const CowlSection&) = default;
};
/// Ring about the axis x. With one section it is a body of revolution.
struct Cowl {
  std::string name;
  std::vector<CowlSection> sections;  ///< ascending angle
  friend bool operator==(const Cowl&, const Cowl&) = default;
};
struct CowlNacelle {
  std::string name;
  Transform placement;
  std::vector<Cowl> cowls;  ///< fan cowl, core cowl
  bool has_mirror_image = false;
  std::vector<Uv> center_body;  ///< u = x, v = radius, from the nose; empty: none
  friend bool operator==(const CowlNacelle&, const CowlNacelle&) = default;
};

// ---------------------------------------------------------------------------------------------------------------------- systems

struct HingePoint {
  double span = 0.0;   ///< fraction of the wing's length along the mid-chord line, from 0 at the right tip to 1 at the left tip; values beyond are over the tip
  double chord = 0.0;  ///< fraction from the leading edge
  friend bool operator==(const HingePoint&, const HingePoint&) = default;
};
struct ControlSurface {
  std::string name;
  std::string wing;
  ControlKind kind = ControlKind::trailing_edge;
  std::vector<HingePoint> hinge;  ///< at least 2, by ascending span; if there are several segments between them, they are named <name>Segment0, 1, ...
  bool has_image = false;  ///< true if an image exists on the wing's other half or on its mirror image; false if the file describes that surface separately
  friend bool operator==(const ControlSurface&, const ControlSurface&) = default;
};

enum class ControlGap {
  sealed,  ///< the wing's skin bends
  open,    ///< a separate solid behind a slot
};
/// Motion of the image of a control surface on the wing's other half (or on the wing's mirror image).
enum class OtherSide { none, same, opposite };
/// Deflection of a control surface. With zero angle it is a patch with the surface's name.
struct Deflection {
  ControlSurface surface;
  double angle = 0.0;                    ///< radians; positive: trailing edge down (leading edge flaps: leading edge down; all-moving: nose up)
  double fairing = k_automatic_fairing;  ///< sealed: metres along the span beside each end over which the deflection fades to zero; must be positive
  ControlGap gap = ControlGap::sealed;
  double slot = k_automatic_slot;                      ///< open: metres between the wing's cove and the nose of the moving part
  double end_gap = k_automatic_slot;                   ///< open: metres along the span between the moving part and each end
  bool has_flat_nose = false;                          ///< open: flat nose; else round about the hinge
  OtherSide other_side = OtherSide::none;              ///< motion of the image; its name follows the rule of make_components for mirror images ("aileron" ->
                                                       ///< "aileronLeft")
  static constexpr double k_automatic_fairing = -1.0;  ///< a tenth of the mean chord at its ends
  static constexpr double k_automatic_slot = -1.0;     ///< a hundredth of the mean chord at its ends
  friend bool operator==(const Deflection&, const Deflection&) = default;
};
struct ControlParticipation {
  std::string segment;
  double factor = 1.0;
  friend bool operator==(const ControlParticipation&, const ControlParticipation&) = default;
};
struct Control {
  std::string name;
  std::vector<ControlParticipation> participations;
  friend bool operator==(const Control&, const Control&) = default;
};

struct EngineRegion {
  std::string body;
  bool is_nose = true;  ///< else the tail
  friend bool operator==(const EngineRegion&, const EngineRegion&) = default;
};
struct Turbofan {
  std::string name;
  double bypass_ratio = 0.0;
  double fan_pressure_ratio = 1.0;
  double total_pressure_ratio = 1.0;
  double turbine_temperature = 0.0;  ///< kelvin
  std::optional<double> inlet_efficiency, nozzle_efficiency, spool_efficiency, combustor_efficiency, polytropic_efficiency, combustor_pressure_loss;
  friend bool operator==(const Turbofan&, const Turbofan&) = default;
};
struct JetEngine {
  std::string name;
  std::optional<double> mass_flow;                          ///< kg/s
  std::optional<double> inflow_velocity, outflow_velocity;  ///< velocity through the surface, m/s
  std::optional<Turbofan> turbofan;
  std::vector<EngineRegion> intakes, nozzles;
  friend bool operator==(const JetEngine&, const JetEngine&) = default;
};

/// Settings that sumo stores for its own mesher.
struct SumoSettings {
  std::int64_t version = 0;  ///< major << 16 | minor << 8 | patch
  double max_stretch = 5.0;
  double max_angle = 0.5235987755982988;  ///< radians
  std::int64_t iterations = 3;
  std::optional<double> farfield_radius, radius_edge;
  friend bool operator==(const SumoSettings&, const SumoSettings&) = default;
};

struct Aircraft {
  std::string name;
  std::vector<Body> bodies;
  std::vector<Wing> wings;
  std::vector<CowlNacelle> nacelles;
  std::vector<ControlSurface> control_surfaces;
  std::vector<Deflection> deflections;  ///< deflections of the control surfaces below and of others; a control surface without a deflection gives its name to
                                        ///< its patch
  std::vector<Control> controls;
  std::vector<JetEngine> engines;
  std::optional<SumoSettings> sumo;
  std::optional<double> reference_area, reference_length;  ///< values stated in the file
  std::optional<Point> reference_point;
  friend bool operator==(const Aircraft&, const Aircraft&) = default;
};

/// An aircraft and messages about file contents that it does not represent. Each message gives the line, the element, and how the contents were handled.
struct AircraftReading {
  Aircraft aircraft;
  std::vector<std::string> messages;
  std::vector<std::string> notes = {};  ///< messages about contents that are omitted by design; they are not warnings
};

}  // namespace sterna
