// The fluid in a container with bodies: a wind tunnel's test section with the model, its sting and struts, of exact geometry.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/find_contacts.h"
#include "geom/cad/unite.h"
#include "geom/model/model.h"

namespace sterna {

struct FluidOptions {
  double tolerance = k_automatic;  ///< metres
  double time_limit = 600.0;       ///< seconds
};
template <>
struct Schema<FluidOptions> {
  static constexpr std::string_view stage = "fluid";
  using T = FluidOptions;
  static constexpr std::array fields = {
      Field<T>{.name = "tolerance",
               .member = &T::tolerance,
               .unit = Unit::metre,
               .min = 0.0,
               .max = 1.0,
               .help = "points, edges and faces of container and bodies that are nearer than this coincide",
               .automatic = "0, then 1e-7, 1e-6, 1e-5, 1e-4 of the longest side until the fluid is valid"},
      Field<T>{.name = "time_limit", .member = &T::time_limit, .unit = Unit::second, .min = 1.0, .max = 1e6, .help = "a try that takes longer ends the cut"},
  };
};

struct FluidReport {
  std::vector<UniteTry> tries;      ///< of the cut; the last one was taken; none where no body reaches the container's faces
  double volume = 0.0;              ///< of the fluid, m^3
  double container_volume = 0.0;    ///< m^3
  std::vector<std::string> cut;     ///< bodies that reach the container's faces
  std::vector<std::string> inside;  ///< bodies that do not
  std::vector<ErrorPlace> doubts;   ///< what is hard to mesh: bodies nearly tangent to the container, in words
};

struct FluidDomain {
  Model model;
  FluidReport report;
};

namespace cad {

/// Whether faces may reach out of the container, where they are cut off.
using MayPass = std::function<bool(const Overhang&)>;

/// Container minus bodies. Solids of the bodies that touch are united first. Bodies inside stay as they are; those that pass through the container's faces, or
/// stand on them, are cut off there, and their openings in these faces; what reaches out without leave (find_overhangs) is an error. Without `may_pass` all
/// may. Faces keep names, components, roles, kinds, colours and surfaces; normals point into the fluid: those of the container inwards, those of bodies
/// outwards. The container may be given with normals either way. Solids of the result: the container with what was cut, then each body inside. Proven like a
/// union: valid, closed, volume and what is left of each part's area as they must be. The same bytes for any number of threads.
/// \throws Error(open_surface) for open parts; Error(bad_argument) naming a body, with its place, that lies outside of the container, fills it, or cuts the
/// fluid in two, or parts that would be cut off, with how far they reach out; Error(geometry_failed) after the last tolerance or past the time limit;
/// Error(cancelled)
FluidDomain fluid_domain(const Model& container, std::span<const Model> bodies, const FluidOptions& options, const RunContext& context,
                         const MayPass& may_pass = {});

}  // namespace cad
}  // namespace sterna
