// Reader of .smx. Steps: read the components of the root, then the systems that refer to them, then resolve references.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <pugixml.hpp>

#include "geom/base/error.h"
#include "geom/math/constants.h"
#include "geom/model/airfoil.h"
#include "geom/model/smx.h"
#include "geom/model/xml_file.h"

namespace sterna {
namespace {

/// A polyline that turns by more than this angle reverses its direction. sumo rejects it, too.
constexpr double k_max_turn = 175.0 * k_degree;
/// Normalised frame points with a smaller deviation are accurate within the 6 digits of files, and are not moved. Otherwise the shape would change at every
/// save.
constexpr double k_normal_slack = 2e-6;
/// Points closer than this, relative to a unit section, are one repeated point.
constexpr double k_same_smx_point = 1e-12;
/// Largest offset from the plane of symmetry of a section's end that is intended to be in that plane.
constexpr double k_on_plane = 1e-9;

class SmxReader {
 public:
  explicit SmxReader(const std::filesystem::path& path) : file_(path) {}
  AircraftReading read();

 private:
  using Node = pugi::xml_node;
  Body body(const Node& node);
  BodyFrame frame(const Node& node);
  bool read_shape(const Node& node, BodyFrame& frame);
  void normalise(const Node& node, BodyFrame& frame);
  Wing wing(const Node& node);
  WingSection section(const Node& node);
  void read_caps(const Node& node, EndCap& south, EndCap& north);
  std::optional<MeshCriterion> criterion(const Node& node);
  void controls(const Node& node, Aircraft& aircraft);
  JetEngine engine(const Node& node);
  SumoSettings settings(const Node& node);
  void drop_repeated(const Node& node, std::vector<Uv>& points);
  void check_turns(const Node& node, const std::vector<Uv>& points) const;
  void resolve(const Aircraft& aircraft);
  Placement placement(const Node& node) const { return {file_.vector(node, "origin", {}), file_.vector(node, "rotation", {})}; }
  double positive(const Node& node, const char* attribute) const;

  XmlFile file_;
  std::vector<Node> control_nodes_, engine_nodes_;
};

double SmxReader::positive(const Node& node, const char* attribute) const {
  const double value = file_.number(node, attribute);
  if (!(value > 0.0)) file_.fail(node, std::string("attribute '") + attribute + "' is " + exact_text(value) + "; it must be positive");
  return value;
}

void SmxReader::drop_repeated(const Node& node, std::vector<Uv>& points) {
  const std::size_t n = points.size();
  points.erase(std::unique(points.begin(), points.end(), [](Uv a, Uv b) { return std::hypot(a.u - b.u, a.v - b.v) <= k_same_smx_point; }), points.end());
  if (points.size() != n) file_.report(node, std::to_string(n - points.size()) + " repeated points were dropped");
}

void SmxReader::check_turns(const Node& node, const std::vector<Uv>& points) const {
  for (std::size_t i = 1; i + 1 < points.size(); ++i) {
    const Uv a = points[i] - points[i - 1], b = points[i + 1] - points[i];
    const double turn = std::atan2(std::abs(a.u * b.v - a.v * b.u), a.u * b.u + a.v * b.v);
    if (turn > k_max_turn)
      file_.fail(node,
                 "the section turns back by " + exact_text(std::round(turn / k_degree)) + " degrees (at most 175) at point " + std::to_string(i + 1) + " (" +
                     exact_text(points[i].u) + ", " + exact_text(points[i].v) + ")",
                 "points may be missing, or in the wrong order");
  }
}

// ---- bodies

bool SmxReader::read_shape(const Node& node, BodyFrame& frame) {
  int n_shapes = 0;
  for (const Node child : node.children()) {
    const std::string_view tag = child.name();
    if (!tag.ends_with("Constraint")) continue;
    if (n_shapes++ > 0) file_.fail(child, "a frame must have one shape; this is the second shape");
    frame.n_points = static_cast<int>(std::clamp<std::int64_t>(file_.integer(child, "npoints", tag.starts_with("Circ") ? 7 : 11), 4, 10000));
    if (tag == "CircularShapeConstraint") {
      file_.warn_unknown(child, "npoints radius", "");
      frame.shape = FrameShape::circle;
      frame.width = frame.height = positive(child, "radius");  // sumo's "radius" is the diameter
    } else if (tag == "EllipticShapeConstraint") {
      file_.warn_unknown(child, "npoints exponent", "");
      frame.shape = FrameShape::ellipse;
      frame.exponent = file_.number(child, "exponent", 2.0);
      if (!(frame.exponent > 0.0)) file_.fail(child, "the exponent is " + exact_text(frame.exponent) + "; it must be positive");
    } else if (tag == "HuegelschaefferConstraint") {
      file_.warn_unknown(child, "npoints distortion", "");
      frame.shape = FrameShape::egg;
      frame.distortion = file_.number(child, "distortion", 0.0);
      if (!(std::abs(frame.distortion) < 1.0)) file_.fail(child, "the distortion is " + exact_text(frame.distortion) + "; it must be within -1 and 1");
    } else if (tag == "DoubleEllipticConstraint") {
      file_.warn_unknown(child, "npoints offset", "");
      frame.shape = FrameShape::double_ellipse;
      frame.offset = file_.number(child, "offset", 0.0);
      if (!(std::abs(frame.offset) < 1.0)) file_.fail(child, "the offset is " + exact_text(frame.offset) + "; it must be within -1 and 1");
    } else if (tag == "IsikverenShapeConstraint") {
      file_.warn_unknown(child, "npoints zp a0 a1 b1", "");
      frame.shape = FrameShape::isikveren;
      frame.zp = file_.number(child, "zp", 0.0);
      frame.a0 = file_.number(child, "a0", 0.0);
      frame.a1 = file_.number(child, "a1", 0.0);
      frame.b1 = file_.number(child, "b1", 0.0);
    } else {
      file_.fail(child, "this frame shape is not known");
    }
  }
  return n_shapes > 0;
}

/// Rescales the points to max y = 1 and z from -1 to 1; center, width and height are adjusted so that the shape is unchanged.
void SmxReader::normalise(const Node& node, BodyFrame& frame) {
  double y_max = 0.0, z_min = frame.points.front().v, z_max = z_min;
  for (const Uv p : frame.points) {
    y_max = std::max(y_max, p.u);
    z_min = std::min(z_min, p.v);
    z_max = std::max(z_max, p.v);
  }
  if (!(y_max > 0.0) || !(z_max > z_min))
    file_.fail(node, "the frame has no width or no height: its points reach from z = " + exact_text(z_min) + " to " + exact_text(z_max) + ", y to " +
                         exact_text(y_max));
  if (std::abs(y_max - 1.0) < k_normal_slack && std::abs(z_min + 1.0) < k_normal_slack && std::abs(z_max - 1.0) < k_normal_slack) return;
  const double middle = 0.5 * (z_min + z_max), half = 0.5 * (z_max - z_min);
  for (Uv& p : frame.points) p = {p.u / y_max, (p.v - middle) / half};
  frame.center.z += 0.5 * frame.height * middle;
  frame.width *= y_max;
  frame.height *= half;
}

BodyFrame SmxReader::frame(const Node& node) {
  file_.warn_unknown(node, "name center height width symmetric",
                     "CircularShapeConstraint EllipticShapeConstraint HuegelschaefferConstraint DoubleEllipticConstraint IsikverenShapeConstraint");
  BodyFrame frame;
  frame.name = file_.text(node, "name");
  frame.center = file_.vector(node, "center");
  frame.height = positive(node, "height");
  frame.width = positive(node, "width");
  frame.is_symmetric = file_.boolean(node, "symmetric", true);
  if (read_shape(node, frame)) return frame;
  frame.shape = FrameShape::points;
  frame.points = file_.pairs(node);
  drop_repeated(node, frame.points);
  if (frame.points.size() < 4) file_.fail(node, "a frame needs a shape or 4 points; it has " + std::to_string(frame.points.size()));
  normalise(node, frame);
  for (Uv* end : {&frame.points.front(), &frame.points.back()})
    if (std::abs(end->u) < k_on_plane) end->u = 0.0;
  check_turns(node, frame.points);
  return frame;
}

Body SmxReader::body(const Node& node) {
  file_.warn_unknown(node, "name origin rotation akimatg", "NacelleInletLip BodyFrame Cap Caps MeshCriterion");
  Body body;
  body.name = file_.required_text(node, "name");
  body.placement = placement(node);
  body.tangents = file_.boolean(node, "akimatg", false) ? BodyTangents::akima : BodyTangents::bessel;
  for (const Node child : node.children("BodyFrame")) body.frames.push_back(frame(child));
  if (body.frames.size() < 2) file_.fail(node, "a body needs 2 frames; it has " + std::to_string(body.frames.size()));
  if (body.frames.size() < 4) file_.report(node, "sumo requires 4 frames; the body has " + std::to_string(body.frames.size()));
  const auto is_before = [](const BodyFrame& a, const BodyFrame& b) { return a.center.x < b.center.x; };
  if (!std::is_sorted(body.frames.begin(), body.frames.end(), is_before)) {
    std::stable_sort(body.frames.begin(), body.frames.end(), is_before);
    file_.report(node, "the frames were sorted by x");
  }
  for (std::size_t i = 1; i < body.frames.size(); ++i)
    if (body.frames[i].center.x == body.frames[i - 1].center.x)
      file_.report(node, "frames '" + body.frames[i - 1].name + "' and '" + body.frames[i].name +
                             "' are in the same plane x = " + exact_text(body.frames[i].center.x) + "; no surface can be made through both");
  if (const Node lip = node.child("NacelleInletLip")) {
    file_.warn_unknown(lip, "axialOffset radialOffset shapeCoef", "");
    body.lip = InletLip{file_.number(lip, "axialOffset", 0.4), file_.number(lip, "radialOffset", 0.2), file_.number(lip, "shapeCoef", 1.0)};
  }
  read_caps(node, body.nose, body.tail);
  if (body.lip && body.nose.height != 0.0) {
    file_.report(node, "the body has an inlet lip, so its front cap is flat");
    body.nose.height = 0.0;
  }
  body.criterion = criterion(node);
  return body;
}

void SmxReader::read_caps(const Node& node, EndCap& south, EndCap& north) {
  if (const Node old = node.child("Caps")) {
    file_.warn_unknown(old, "height_north height_south", "");
    north = {CapShape::strip, file_.number(old, "height_north", 0.0)};
    south = {CapShape::strip, file_.number(old, "height_south", 0.0)};
  }
  for (const Node cap : node.children("Cap")) {
    file_.warn_unknown(cap, "shape height side", "");
    const std::string shape = file_.required_text(cap, "shape"), side = file_.required_text(cap, "side");
    if (shape != "LongCap" && shape != "RingCap") file_.fail(cap, "a cap has the shape LongCap or RingCap, not '" + shape + "'");
    if (side != "south" && side != "north") file_.fail(cap, "the side of a cap is south or north, not '" + side + "'");
    const EndCap read{shape == "LongCap" ? CapShape::strip : CapShape::dome, file_.number(cap, "height", 0.0)};
    if (read.height < 0.0) file_.fail(cap, "the height is " + exact_text(read.height) + "; it must not be negative");
    (side == "south" ? south : north) = read;
  }
}

// ---- wings

WingSection SmxReader::section(const Node& node) {
  file_.warn_unknown(node, "name center chord twist dihedral yaw airfoil napprox vbreak reversed naca extend_xle extend_yle extend_xte extend_yte", "");
  WingSection s;
  s.name = file_.text(node, "name");
  s.leading_edge = file_.vector(node, "center");
  s.chord = positive(node, "chord");
  s.twist = file_.number(node, "twist", 0.0);
  s.dihedral = file_.number(node, "dihedral", 0.0);
  s.yaw = file_.number(node, "yaw", 0.0);
  s.airfoil = file_.text(node, "airfoil");
  s.n_approximation = static_cast<int>(std::clamp<std::int64_t>(file_.integer(node, "napprox", -1), -1, 100000));
  s.is_break = file_.boolean(node, "vbreak", false);
  s.is_reversed = file_.boolean(node, "reversed", false);
  s.naca = file_.text(node, "naca");
  s.extend_leading_x = file_.optional_number(node, "extend_xle");
  s.extend_leading_y = file_.optional_number(node, "extend_yle");
  s.extend_trailing_x = file_.optional_number(node, "extend_xte");
  s.extend_trailing_y = file_.optional_number(node, "extend_yte");
  s.points = file_.pairs(node);
  drop_repeated(node, s.points);
  if (s.points.empty() && s.naca.empty()) file_.fail(node, "the section has neither airfoil points nor a 'naca' designation");
  if (s.points.empty() && !s.naca.empty()) {
    try {
      naca_airfoil(s.naca);  // the sections are generated from the designation
    } catch (const Error& e) {
      file_.fail(node, "attribute 'naca': " + e.info().problem);
    }
  }
  if (!s.points.empty() && s.points.size() < 5) file_.fail(node, "an airfoil needs 5 points; it has " + std::to_string(s.points.size()));
  check_turns(node, s.points);
  if (s.n_approximation > 0)
    file_.report(node,
                 "the airfoil goes through its points; sumo approximates it by least squares with " + std::to_string(s.n_approximation) + " points (napprox)");
  if (s.extend_leading_x || s.extend_leading_y || s.extend_trailing_x || s.extend_trailing_y)
    file_.report(node, "the airfoil is not extended at its ends (extend_xle ...): sumo's rule is not documented");
  return s;
}

Wing SmxReader::wing(const Node& node) {
  Wing wing;
  file_.warn_unknown(node, "name flags origin rotation akimatg", "WingSection Cap Caps WingCriterion MeshCriterion");
  wing.name = file_.required_text(node, "name");
  wing.placement = placement(node);
  wing.trailing_edge = 0.0;  // sumo closes every airfoil, by rotating its sides about the leading edge
  const std::string flags = file_.text(node, "flags");
  for (std::size_t at = 0; at < flags.size();) {
    const std::size_t end = std::min(flags.find(',', at), flags.size());
    std::string flag = flags.substr(at, end - at);
    std::erase(flag, ' ');
    if (flag == "autosym") wing.is_symmetric = true;
    else if (flag == "detectwinglet") wing.has_winglet = true;
    else if (flag == "cubic") wing.is_cubic = true;
    else if (!flag.empty()) file_.report(node, "flag '" + flag + "' is not known and was left out");
    at = end + 1;
  }
  for (const Node child : node.children("WingSection")) wing.sections.push_back(section(child));
  if (wing.sections.size() < 2) file_.fail(node, "a wing needs 2 sections; it has " + std::to_string(wing.sections.size()));
  if (wing.is_symmetric) {
    WingSection& center = wing.sections.back();
    if (center.leading_edge.y != 0.0 || center.dihedral != 0.0) file_.report(node, "the last section of a symmetric wing was put into the plane of symmetry");
    center.leading_edge.y = 0.0;
    center.dihedral = 0.0;
  } else {
    wing.left_tip.height = 0.0;
  }
  read_caps(node, wing.right_tip, wing.left_tip);
  wing.criterion = criterion(node);
  return wing;
}

// ---- criteria

std::optional<MeshCriterion> SmxReader::criterion(const Node& parent) {
  Node node = parent.child("WingCriterion");
  if (!node) node = parent.child("MeshCriterion");
  if (!node) return std::nullopt;
  file_.warn_unknown(node, "maxlen minlen maxphi maxstretch nvmax lerfactor terfactor defaults xcoarse postrefine smoothing",
                     "RefinementRegion Scale Breaks Kinks KinkTangents");
  MeshCriterion c;
  c.is_automatic = file_.boolean(node, "defaults", false);
  c.is_wing = static_cast<bool>(node.attribute("lerfactor"));
  c.is_stretched = file_.boolean(node, "xcoarse", false);
  c.max_edge = file_.optional_number(node, "maxlen");
  c.min_edge = file_.optional_number(node, "minlen");
  if (const std::optional<double> degrees = file_.optional_number(node, "maxphi")) c.max_normal_angle = *degrees * k_degree;
  c.max_stretch = file_.optional_number(node, "maxstretch");
  if (node.attribute("nvmax")) c.max_vertices = file_.integer(node, "nvmax", 0);
  c.leading_edge_factor = file_.number(node, "lerfactor", 1.0);
  c.trailing_edge_factor = file_.number(node, "terfactor", 1.0);
  for (const Node child : node.children("RefinementRegion")) {
    file_.warn_unknown(child, "factor lower upper center ru rv", "");
    RefinementRegion region;
    const auto pair = [&](const char* attribute) {
      const std::vector<double> n = file_.numbers(child, file_.required_text(child, attribute));
      if (n.size() != 2) file_.fail(child, std::string("attribute '") + attribute + "' needs 2 numbers");
      return Uv{n[0], n[1]};
    };
    region.is_ellipse = static_cast<bool>(child.attribute("center"));
    region.factor = positive(child, "factor");
    if (region.is_ellipse) {
      region.center = pair("center");
      region.radius_u = positive(child, "ru");
      region.radius_v = positive(child, "rv");
    } else {
      region.lower = pair("lower");
      region.upper = pair("upper");
    }
    c.regions.push_back(region);
  }
  const auto list = [&](const char* tag) {
    const Node child = node.child(tag);
    return child ? file_.numbers(child, XmlFile::content(child)) : std::vector<double>{};
  };
  c.scale = list("Scale");
  c.breaks = list("Breaks");
  c.kinks = list("Kinks");
  const std::vector<double> tangents = list("KinkTangents");
  if (c.scale.size() != c.breaks.size() || tangents.size() != 3 * c.kinks.size()) {
    file_.report(node, "lists of scales, breaks and kinks whose lengths differ were left out; they follow from the sections");
    c.scale.clear();
    c.breaks.clear();
    c.kinks.clear();
  } else {
    for (std::size_t i = 0; i < c.kinks.size(); ++i) c.kink_tangents.push_back({tangents[3 * i], tangents[3 * i + 1], tangents[3 * i + 2]});
  }
  return c;
}

// ---- systems

void SmxReader::controls(const Node& node, Aircraft& aircraft) {
  file_.warn_unknown(node, "", "ControlSrf Control");
  for (const Node child : node.children("ControlSrf")) {
    file_.warn_unknown(child, "name wing type", "Hingepoint");
    ControlSurface surface;
    surface.name = file_.required_text(child, "name");
    surface.wing = file_.required_text(child, "wing");
    const std::string type = file_.required_text(child, "type");
    if (type == "TEF") surface.kind = ControlKind::trailing_edge;
    else if (type == "LEF") surface.kind = ControlKind::leading_edge;
    else if (type == "AM") surface.kind = ControlKind::all_moving;
    else file_.fail(child, "the type of a control surface is TEF, LEF or AM, not '" + type + "'");
    for (const Node point : child.children("Hingepoint")) {
      file_.warn_unknown(point, "spanpos chordpos", "");
      surface.hinge.push_back({file_.number(point, "spanpos"), file_.number(point, "chordpos")});
    }
    if (surface.hinge.size() < 2) file_.fail(child, "a control surface needs 2 hinge points; it has " + std::to_string(surface.hinge.size()));
    aircraft.control_surfaces.push_back(std::move(surface));
    control_nodes_.push_back(child);
  }
  for (const Node child : node.children("Control")) {
    file_.warn_unknown(child, "name", "Participation");
    Control control{file_.required_text(child, "name"), {}};
    for (const Node p : child.children("Participation")) {
      file_.warn_unknown(p, "id factor", "");
      control.participations.push_back({file_.required_text(p, "id"), file_.number(p, "factor", 1.0)});
    }
    aircraft.controls.push_back(std::move(control));
  }
}

JetEngine SmxReader::engine(const Node& node) {
  file_.warn_unknown(node, "name massflow vt_in vt_out", "Turbofan IntakeRegions NozzleRegions");
  JetEngine engine;
  engine.name = file_.required_text(node, "name");
  engine.mass_flow = file_.optional_number(node, "massflow");
  engine.inflow_velocity = file_.optional_number(node, "vt_in");
  engine.outflow_velocity = file_.optional_number(node, "vt_out");
  if (const Node fan = node.child("Turbofan")) {
    file_.warn_unknown(fan, "name bypass_ratio fan_pr total_pr turbine_temp eta_inlet eta_nozzle eta_spool eta_comb eta_inf dp_comb", "");
    engine.turbofan = Turbofan{.name = file_.text(fan, "name"),
                               .bypass_ratio = file_.number(fan, "bypass_ratio"),
                               .fan_pressure_ratio = file_.number(fan, "fan_pr"),
                               .total_pressure_ratio = file_.number(fan, "total_pr"),
                               .turbine_temperature = file_.number(fan, "turbine_temp"),
                               .inlet_efficiency = file_.optional_number(fan, "eta_inlet"),
                               .nozzle_efficiency = file_.optional_number(fan, "eta_nozzle"),
                               .spool_efficiency = file_.optional_number(fan, "eta_spool"),
                               .combustor_efficiency = file_.optional_number(fan, "eta_comb"),
                               .polytropic_efficiency = file_.optional_number(fan, "eta_inf"),
                               .combustor_pressure_loss = file_.optional_number(fan, "dp_comb")};
  }
  const auto regions = [&](const char* tag) {
    std::vector<EngineRegion> found;
    for (const Node region : node.child(tag).children()) {
      if (region.type() != pugi::node_element) continue;
      if (std::string_view(region.name()) != "JeRegion") {
        file_.report(region, "this element is not known and was left out");
        continue;
      }
      file_.warn_unknown(region, "surface type", "");
      const std::string type = file_.required_text(region, "type");
      if (type != "nose" && type != "tail") file_.fail(region, "the region of an engine is nose or tail, not '" + type + "'");
      found.push_back({file_.required_text(region, "surface"), type == "nose"});
    }
    if (found.empty()) file_.fail(node, std::string("the engine has no ") + tag);
    return found;
  };
  engine.intakes = regions("IntakeRegions");
  engine.nozzles = regions("NozzleRegions");
  return engine;
}

SumoSettings SmxReader::settings(const Node& node) {
  SumoSettings s;
  s.version = file_.integer(node, "sumo_version", 0);
  s.max_stretch = file_.number(node, "ppMaxStretch", s.max_stretch);
  s.max_angle = file_.number(node, "ppMaxPhi", 30.0) * k_degree;
  s.iterations = file_.integer(node, "ppNiter", s.iterations);
  s.farfield_radius = file_.optional_number(node, "tgRadius");
  s.radius_edge = file_.optional_number(node, "tgQuality");
  return s;
}

void SmxReader::resolve(const Aircraft& aircraft) {
  std::set<std::string> bodies, wings, segments;
  for (const Body& body : aircraft.bodies)
    if (!bodies.insert(body.name).second) file_.report(file_.root(), "two bodies are named '" + body.name + "'");
  for (const Wing& wing : aircraft.wings)
    if (!wings.insert(wing.name).second) file_.report(file_.root(), "two wings are named '" + wing.name + "'");
  for (std::size_t i = 0; i < aircraft.control_surfaces.size(); ++i) {
    const ControlSurface& surface = aircraft.control_surfaces[i];
    if (!wings.contains(surface.wing)) file_.report(control_nodes_[i], "there is no wing '" + surface.wing + "'");
    if (surface.hinge.size() == 2) segments.insert(surface.name);
    for (std::size_t k = 0; k + 1 < surface.hinge.size(); ++k) segments.insert(surface.name + "Segment" + std::to_string(k));
  }
  for (const Control& control : aircraft.controls)
    for (const ControlParticipation& p : control.participations)
      if (!segments.contains(p.segment))
        file_.report(file_.root(), "control '" + control.name + "' moves '" + p.segment + "', which is not a segment of a control surface");
  for (std::size_t i = 0; i < aircraft.engines.size(); ++i)
    for (const auto* regions : {&aircraft.engines[i].intakes, &aircraft.engines[i].nozzles})
      for (const EngineRegion& region : *regions)
        if (!bodies.contains(region.body)) file_.report(engine_nodes_[i], "there is no body '" + region.body + "'");
}

AircraftReading SmxReader::read() {
  AircraftReading reading;
  Aircraft& aircraft = reading.aircraft;
  const Node root = file_.root();
  const std::string_view tag = root.name();
  if (tag == "BodySkeleton") {
    aircraft.bodies.push_back(body(root));
  } else if (tag == "WingSkeleton") {
    aircraft.wings.push_back(wing(root));
  } else if (tag == "Assembly") {
    file_.warn_unknown(root, "name sumo_version ppMaxStretch ppMaxPhi ppNiter tgRadius tgQuality", "BodySkeleton WingSkeleton ControlSystem JetEngineSpec");
    aircraft.name = file_.text(root, "name");
    aircraft.sumo = settings(root);
    for (const Node child : root.children()) {
      const std::string_view kind = child.name();
      if (kind == "BodySkeleton") aircraft.bodies.push_back(body(child));
      else if (kind == "WingSkeleton") aircraft.wings.push_back(wing(child));
      else if (kind == "ControlSystem") controls(child, aircraft);
      else if (kind == "JetEngineSpec") {
        aircraft.engines.push_back(engine(child));
        engine_nodes_.push_back(child);
      }
    }
  } else {
    file_.fail(root, "the root element of a .smx file must be Assembly, BodySkeleton or WingSkeleton");
  }
  if (aircraft.bodies.empty() && aircraft.wings.empty()) file_.fail(root, "the file has no body and no wing");
  resolve(aircraft);
  reading.messages = std::move(file_.messages());
  return reading;
}

}  // namespace

AircraftReading read_smx(const std::filesystem::path& path, const RunContext& context) {
  context.check_stop();
  AircraftReading reading = SmxReader(path).read();
  for (const std::string& message : reading.messages) context.warn(path.filename().string() + ": " + message);
  return reading;
}

}  // namespace sterna
