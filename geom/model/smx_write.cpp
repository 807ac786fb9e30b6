// Writer of .smx: elements and attributes in sumo's own order.
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include <pugixml.hpp>

#include "geom/base/error.h"
#include "geom/math/constants.h"
#include "geom/model/smx.h"
#include "geom/model/xml_file.h"

namespace sterna {
namespace {

using Node = pugi::xml_node;
constexpr std::int64_t k_sumo_version = (2 << 16) | (7 << 8) | 10;  ///< the version whose schema is written

void set(Node& node, const char* name, const std::string& value) { node.append_attribute(name) = value.c_str(); }
void set(Node& node, const char* name, double value) { set(node, name, exact_text(value)); }
void set(Node& node, const char* name, std::int64_t value) { set(node, name, std::to_string(value)); }
void set(Node& node, const char* name, bool value) { set(node, name, std::string(value ? "true" : "false")); }
void set(Node& node, const char* name, const std::optional<double>& value) {
  if (value) set(node, name, *value);
}
void set(Node& node, const char* name, const Vec3& v) { set(node, name, " " + exact_text(v.x) + " " + exact_text(v.y) + " " + exact_text(v.z) + " "); }
void set(Node& node, const char* name, Uv p) { set(node, name, exact_text(p.u) + " " + exact_text(p.v)); }

/// Returns degrees that read back as the same radians: the plain number if rounding allows it, else a neighbour in the last bit.
double degrees_of(double radians) {
  const double near = radians / k_degree;
  for (const double candidate : {std::round(near * 1e9) / 1e9, near, std::nextafter(near, 0.0), std::nextafter(near, HUGE_VAL)})
    if (candidate * k_degree == radians) return candidate;
  return near;
}

[[noreturn]] void refuse_smx(const std::string& what, const std::string& hint) {
  throw Error({.code = ErrorCode::unsupported_format, .attempted = "writing a .smx file", .problem = what, .hint = hint});
}

void add_pairs(Node& node, const std::vector<Uv>& points) {
  std::string text = "\n";
  for (const Uv p : points) text += " " + exact_text(p.u) + " " + exact_text(p.v) + " \n";
  node.append_child(pugi::node_pcdata).set_value(text.c_str());
}

void add_numbers(Node& parent, const char* tag, const std::vector<double>& values, std::size_t count) {
  Node node = parent.append_child(tag);
  set(node, "count", static_cast<std::int64_t>(count));
  std::string text = "\n";
  for (const double v : values) text += exact_text(v) + "\n";
  node.append_child(pugi::node_pcdata).set_value(text.c_str());
}

void add_cap(Node& parent, const EndCap& cap, const char* side) {
  Node node = parent.append_child("Cap");
  set(node, "height", cap.height);
  set(node, "shape", std::string(cap.shape == CapShape::strip ? "LongCap" : "RingCap"));
  set(node, "side", std::string(side));
}

void add_criterion(Node& parent, const std::optional<MeshCriterion>& criterion) {
  if (!criterion) return;
  const MeshCriterion& c = *criterion;
  Node node = parent.append_child("MeshCriterion");
  set(node, "defaults", c.is_automatic);
  if (c.is_wing) set(node, "lerfactor", c.leading_edge_factor);
  set(node, "maxlen", c.max_edge);
  if (c.max_normal_angle) set(node, "maxphi", degrees_of(*c.max_normal_angle));
  set(node, "maxstretch", c.max_stretch);
  set(node, "minlen", c.min_edge);
  if (c.max_vertices) set(node, "nvmax", *c.max_vertices);
  if (c.is_wing || c.trailing_edge_factor != 1.0) set(node, "terfactor", c.trailing_edge_factor);
  set(node, "xcoarse", c.is_stretched);
  for (const RefinementRegion& region : c.regions) {
    Node child = node.append_child("RefinementRegion");
    set(child, "factor", region.factor);
    if (region.is_ellipse) {
      set(child, "center", region.center);
      set(child, "ru", region.radius_u);
      set(child, "rv", region.radius_v);
    } else {
      set(child, "lower", region.lower);
      set(child, "upper", region.upper);
    }
  }
  if (!c.scale.empty()) {
    add_numbers(node, "Scale", c.scale, c.scale.size());
    add_numbers(node, "Breaks", c.breaks, c.breaks.size());
  }
  if (!c.kinks.empty()) {
    std::vector<double> tangents;
    for (const Vec3& t : c.kink_tangents) tangents.insert(tangents.end(), {t.x, t.y, t.z});
    add_numbers(node, "Kinks", c.kinks, c.kinks.size());
    add_numbers(node, "KinkTangents", tangents, c.kinks.size());
  }
}

void add_shape(Node& node, const BodyFrame& frame) {
  const auto shape = [&](const char* tag) {
    Node child = node.append_child(tag);
    set(child, "npoints", static_cast<std::int64_t>(frame.n_points));
    return child;
  };
  const auto shape_with = [&](const char* tag, const char* attribute, double value) {
    Node child = shape(tag);
    set(child, attribute, value);
  };
  switch (frame.shape) {
    case FrameShape::points: return add_pairs(node, frame.points);
    case FrameShape::loop:
      refuse_smx("frame '" + frame.name + "' is a free loop; .smx has only half sections in planes x = const", "write the model as STEP instead");
    case FrameShape::circle: return shape_with("CircularShapeConstraint", "radius", frame.width);
    case FrameShape::ellipse: return shape_with("EllipticShapeConstraint", "exponent", frame.exponent);
    case FrameShape::egg: return shape_with("HuegelschaefferConstraint", "distortion", frame.distortion);
    case FrameShape::double_ellipse: return shape_with("DoubleEllipticConstraint", "offset", frame.offset);
    case FrameShape::isikveren: {
      Node child = shape("IsikverenShapeConstraint");
      set(child, "zp", frame.zp);
      set(child, "a0", frame.a0);
      set(child, "a1", frame.a1);
      return set(child, "b1", frame.b1);
    }
  }
}

void add_body(Node& root, const Body& body) {
  if (body.tangents == BodyTangents::linear)
    refuse_smx("body '" + body.name + "' is straight between its frames; .smx has only smooth bodies", "write the model as STEP instead");
  if (body.tangents == BodyTangents::monotone && body.frames.size() > 2)
    refuse_smx("body '" + body.name + "' does not overshoot between its frames; bodies of .smx do",
               "make the body with fuselage{ along = \"smooth\" } or \"akima\", which .smx supports, or write the model as STEP");
  if (body.has_mirror_image)
    refuse_smx("body '" + body.name + "' has a mirror image; .smx requires a separate body for the image", "add the mirror image as a separate body");
  Node node = root.append_child("BodySkeleton");
  set(node, "akimatg", body.tangents == BodyTangents::akima);
  set(node, "name", body.name);
  set(node, "origin", body.placement.origin);
  set(node, "rotation", body.placement.rotation);
  if (body.lip) {
    Node lip = node.append_child("NacelleInletLip");
    set(lip, "axialOffset", body.lip->axial_offset);
    set(lip, "radialOffset", body.lip->radial_offset);
    set(lip, "shapeCoef", body.lip->shape);
  }
  for (const BodyFrame& frame : body.frames) {
    Node child = node.append_child("BodyFrame");
    set(child, "center", frame.center);
    set(child, "height", frame.height);
    set(child, "name", frame.name);
    set(child, "width", frame.width);
    if (!frame.is_symmetric) set(child, "symmetric", false);
    add_shape(child, frame);
  }
  add_cap(node, body.nose, "south");
  add_cap(node, body.tail, "north");
  add_criterion(node, body.criterion);
}

/// .smx closes all airfoils. A section is not changed by this if the distance of its ends, relative to the chord, is below this value: rounding of coordinates
/// in files.
constexpr double k_closed_airfoil = 1e-6;

void add_wing(Node& root, const Wing& wing) {
  for (const WingSection& s : wing.sections)
    if (!wing.trailing_edge && s.points.size() > 2 &&
        std::hypot(s.points.front().u - s.points.back().u, s.points.front().v - s.points.back().v) > k_closed_airfoil)
      refuse_smx("the airfoil of section '" + s.name + "' of wing '" + wing.name + "' is open at its trailing edge; .smx has only sharp trailing edges",
                 "give the wing trailing_edge = 0, or write the model as STEP");
  if (wing.trailing_edge.value_or(0.0) != 0.0)
    refuse_smx("wing '" + wing.name + "' has a blunt trailing edge; .smx has only sharp trailing edges", "write the model as STEP instead");
  if (wing.has_mirror_image)
    refuse_smx("wing '" + wing.name + "' has a mirror image; .smx requires a separate wing for the image", "add the mirror image as a separate wing");
  Node node = root.append_child("WingSkeleton");
  set(node, "flags", std::string(wing.is_symmetric ? "autosym," : "") + (wing.has_winglet ? "detectwinglet," : "") + (wing.is_cubic ? "cubic," : ""));
  set(node, "name", wing.name);
  set(node, "origin", wing.placement.origin);
  set(node, "rotation", wing.placement.rotation);
  for (const WingSection& s : wing.sections) {
    if (!s.loop.empty())
      refuse_smx("section '" + s.name + "' of wing '" + wing.name + "' is a free loop; .smx has only airfoils with chord and angles",
                 "write the model as STEP instead");
    Node child = node.append_child("WingSection");
    set(child, "airfoil", s.airfoil);
    set(child, "center", s.leading_edge);
    set(child, "chord", s.chord);
    set(child, "dihedral", s.dihedral);
    if (!s.naca.empty()) set(child, "naca", s.naca);
    set(child, "name", s.name);
    set(child, "napprox", static_cast<std::int64_t>(s.n_approximation));
    set(child, "reversed", s.is_reversed);
    set(child, "twist", s.twist);
    set(child, "vbreak", s.is_break);
    set(child, "yaw", s.yaw);
    set(child, "extend_xle", s.extend_leading_x);
    set(child, "extend_yle", s.extend_leading_y);
    set(child, "extend_xte", s.extend_trailing_x);
    set(child, "extend_yte", s.extend_trailing_y);
    add_pairs(child, s.points);
  }
  add_cap(node, wing.right_tip, "south");
  add_cap(node, wing.left_tip, "north");
  add_criterion(node, wing.criterion);
}

void add_controls(Node& root, const Aircraft& aircraft) {
  if (aircraft.control_surfaces.empty() && aircraft.controls.empty()) return;
  Node system = root.append_child("ControlSystem");
  for (const ControlSurface& surface : aircraft.control_surfaces) {
    Node node = system.append_child("ControlSrf");
    set(node, "name", surface.name);
    set(node, "type", std::string(surface.kind == ControlKind::trailing_edge ? "TEF" : surface.kind == ControlKind::leading_edge ? "LEF" : "AM"));
    set(node, "wing", surface.wing);
    for (const HingePoint& point : surface.hinge) {
      Node child = node.append_child("Hingepoint");
      set(child, "chordpos", point.chord);
      set(child, "spanpos", point.span);
    }
  }
  for (const Control& control : aircraft.controls) {
    Node node = system.append_child("Control");
    set(node, "name", control.name);
    for (const ControlParticipation& p : control.participations) {
      Node child = node.append_child("Participation");
      set(child, "factor", p.factor);
      set(child, "id", p.segment);
    }
  }
}

void add_engine(Node& root, const JetEngine& engine) {
  Node node = root.append_child("JetEngineSpec");
  set(node, "massflow", engine.mass_flow);
  set(node, "name", engine.name);
  set(node, "vt_in", engine.inflow_velocity);
  set(node, "vt_out", engine.outflow_velocity);
  if (engine.turbofan) {
    const Turbofan& f = *engine.turbofan;
    Node fan = node.append_child("Turbofan");
    set(fan, "bypass_ratio", f.bypass_ratio);
    set(fan, "dp_comb", f.combustor_pressure_loss);
    set(fan, "eta_comb", f.combustor_efficiency);
    set(fan, "eta_inf", f.polytropic_efficiency);
    set(fan, "eta_inlet", f.inlet_efficiency);
    set(fan, "eta_nozzle", f.nozzle_efficiency);
    set(fan, "eta_spool", f.spool_efficiency);
    set(fan, "fan_pr", f.fan_pressure_ratio);
    set(fan, "name", f.name);
    set(fan, "total_pr", f.total_pressure_ratio);
    set(fan, "turbine_temp", f.turbine_temperature);
  }
  const auto regions = [&](const char* tag, const std::vector<EngineRegion>& list) {
    Node parent = node.append_child(tag);
    for (const EngineRegion& region : list) {
      Node child = parent.append_child("JeRegion");
      set(child, "surface", region.body);
      set(child, "type", std::string(region.is_nose ? "nose" : "tail"));
    }
  };
  regions("IntakeRegions", engine.intakes);
  regions("NozzleRegions", engine.nozzles);
}

}  // namespace

void write_smx(const Aircraft& aircraft, const std::filesystem::path& path) {
  if (!aircraft.nacelles.empty())
    refuse_smx("nacelle '" + aircraft.nacelles.front().name + "' is made of cowls; .smx has only bodies with an inlet lip", "write the model as STEP instead");
  for (const Deflection& deflection : aircraft.deflections)
    if (deflection.angle != 0.0 || deflection.gap != ControlGap::sealed)
      refuse_smx("control surface '" + deflection.surface.name + "' is deflected or has a gap; .smx has only wings without deflected surfaces or gaps",
                 "write the model as STEP instead, or set no deflection");
  pugi::xml_document document;
  Node declaration = document.append_child(pugi::node_declaration);
  set(declaration, "version", std::string("1.0"));
  set(declaration, "encoding", std::string("UTF-8"));
  const bool is_part = !aircraft.sumo && aircraft.bodies.size() + aircraft.wings.size() == 1 && aircraft.control_surfaces.empty() &&
                       aircraft.controls.empty() && aircraft.engines.empty();
  if (is_part) {
    for (const Body& body : aircraft.bodies) add_body(document, body);
    for (const Wing& wing : aircraft.wings) add_wing(document, wing);
  } else {
    Node root = document.append_child("Assembly");
    const SumoSettings s = aircraft.sumo.value_or(SumoSettings{.version = k_sumo_version});
    if (!aircraft.name.empty()) set(root, "name", aircraft.name);
    set(root, "ppMaxPhi", degrees_of(s.max_angle));
    set(root, "ppMaxStretch", s.max_stretch);
    set(root, "ppNiter", s.iterations);
    set(root, "sumo_version", s.version);
    set(root, "tgQuality", s.radius_edge);
    set(root, "tgRadius", s.farfield_radius);
    for (const Body& body : aircraft.bodies) add_body(root, body);
    for (const Wing& wing : aircraft.wings) add_wing(root, wing);
    add_controls(root, aircraft);
    for (const JetEngine& engine : aircraft.engines) add_engine(root, engine);
  }
  std::ofstream out(path, std::ios::binary);
  document.save(out, "  ", pugi::format_default, pugi::encoding_utf8);
  out.close();
  if (!out) throw Error({.code = ErrorCode::write_failed, .attempted = "writing " + path.string(), .problem = "the file cannot be written"});
}

}  // namespace sterna
