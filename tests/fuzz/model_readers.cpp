#include "tests/fuzz/model_readers.h"

#include <array>
#include <cmath>
#include <initializer_list>

#include "geom/model/airfoil.h"
#include "geom/model/cpacs.h"
#include "geom/model/radial_map.h"
#include "geom/model/smx.h"

namespace sterna::fuzz {
namespace {

bool is_sound(Uv p) { return std::isfinite(p.u) && std::isfinite(p.v); }
bool is_sound(const Vec3& p) { return is_finite(p); }
bool is_sound(double x) { return std::isfinite(x); }
template <class T>
bool is_sound(const std::vector<T>& values) {
  for (const T& value : values)
    if (!is_sound(value)) return false;
  return true;
}
template <class... T>
std::string unless_sound(const std::string& what, const T&... values) {
  return (is_sound(values) && ...) ? "" : what + " has a number that is not finite";
}

std::string flaw_of(const Body& body) {
  if (body.frames.size() < 2) return "body " + body.name + " has " + std::to_string(body.frames.size()) + " frames";
  std::string flaw = unless_sound("body " + body.name, body.placement.origin, body.placement.rotation, body.nose.height, body.tail.height);
  for (const BodyFrame& frame : body.frames)
    flaw +=
        unless_sound("frame " + frame.name, frame.center, frame.height, frame.width, frame.exponent, frame.offset, frame.distortion, frame.points, frame.loop);
  return flaw;
}

std::string flaw_of(const Wing& wing) {
  if (wing.sections.size() < 2) return "wing " + wing.name + " has " + std::to_string(wing.sections.size()) + " sections";
  std::string flaw = unless_sound("wing " + wing.name, wing.placement.origin, wing.placement.rotation, wing.right_tip.height, wing.left_tip.height);
  for (const WingSection& section : wing.sections)
    flaw += unless_sound("section " + section.name, section.leading_edge, section.chord, section.twist, section.dihedral, section.yaw, section.points,
                         section.loop);
  return flaw;
}

std::string flaw_of(const Aircraft& aircraft) {
  std::string flaw;
  for (const Body& body : aircraft.bodies) flaw += flaw_of(body);
  for (const Wing& wing : aircraft.wings) flaw += flaw_of(wing);
  for (const CowlNacelle& nacelle : aircraft.nacelles)
    for (const Cowl& cowl : nacelle.cowls)
      for (const CowlSection& section : cowl.sections) flaw += unless_sound("section of cowl " + cowl.name, section.angle, section.profile);
  for (const ControlSurface& control : aircraft.control_surfaces) {
    if (control.hinge.size() < 2) flaw += "control surface " + control.name + " has " + std::to_string(control.hinge.size()) + " hinge points";
    for (const HingePoint& point : control.hinge) flaw += unless_sound("hinge of " + control.name, point.span, point.chord);
  }
  return flaw;
}

std::string read_smx_file(const std::filesystem::path& path, const RunContext& context) { return flaw_of(read_smx(path, context).aircraft); }
std::string read_cpacs_file(const std::filesystem::path& path, const RunContext& context) { return flaw_of(read_cpacs(path, context).aircraft); }

std::string read_airfoil_file(const std::filesystem::path& path, const RunContext&) {
  const Airfoil airfoil = read_airfoil(path);
  if (airfoil.leading_edge == 0 || airfoil.leading_edge + 1 >= airfoil.points.size())
    return std::to_string(airfoil.points.size()) + " points with the leading edge at number " + std::to_string(airfoil.leading_edge);
  return unless_sound("the airfoil", airfoil.points);
}

std::string read_displacement_file(const std::filesystem::path& path, const RunContext&) {
  const ScatteredDisplacements data = read_displacements(path);
  if (data.at.empty() || data.at.size() != data.shift.size())
    return std::to_string(data.shift.size()) + " displacements of " + std::to_string(data.at.size()) + " points";
  return unless_sound("the table", data.at, data.shift);
}

constexpr std::array k_readers = {
    ModelReader{"sumo", ".smx", read_smx_file,
                "<?xml version=\"1.0\"?>\n<Assembly name=\"a\" sumoVersion=\"2.7\"><BodySkeleton name=\"b\" origin=\"0 0 0\" rotation=\"0 0 0\">"
                "<BodyFrame name=\"f\" center=\"0 0 0\" height=\"1\" width=\"1\" shape=\"circle\"/><BodyFrame name=\"g\" center=\"1 0 0\" height=\"1\" "
                "width=\"1\" shape=\"circle\"/></BodySkeleton>"
                "<WingSkeleton name=\"w\" origin=\"0 0 0\" rotation=\"0 0 0\"><WingSection name=\"s\" center=\"0 1 0\" chord=\"1\">1 0;0 0;1 "
                "0</WingSection></WingSkeleton></Assembly>\n"},
    ModelReader{"CPACS", ".xml", read_cpacs_file,
                "<?xml version=\"1.0\"?>\n<cpacs><header><cpacsVersion>3.0</cpacsVersion></header><vehicles><aircraft><model "
                "uID=\"m\"/></aircraft></vehicles></cpacs>\n"},
    ModelReader{"airfoil", ".dat", read_airfoil_file, "plate\n1 0.01\n0.5 0.02\n0 0\n0.5 -0.02\n1 -0.01\n"},
    ModelReader{"displacements", ".txt", read_displacement_file, "# x y z dx dy dz\n0 0 0 0 0 0.1\n1, 0, 0, 0, 0, 0.2\n"},
};

}  // namespace

std::span<const ModelReader> model_readers() { return k_readers; }

}  // namespace sterna::fuzz
