// The fluid in a container with bodies, from exact geometry: a wind tunnel's test section with the model, its sting and struts.
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
               .help = "points, edges and faces of container and bodies that are closer than this are treated as coincident",
               .automatic = "0, then 1e-7, 1e-6, 1e-5, 1e-4 of the longest side until the fluid is valid"},
      Field<T>{.name = "time_limit",
               .member = &T::time_limit,
               .unit = Unit::second,
               .min = 1.0,
               .max = 1e6,
               .help = "time limit of each attempt; a longer attempt ends the cut with an error"},
  };
};

struct FluidReport {
  std::vector<UniteTry> tries;        ///< attempts of the cut; the last one was accepted; empty if no body reaches the container's faces
  double volume = 0.0;                ///< volume of the fluid, m^3
  double container_volume = 0.0;      ///< m^3
  std::vector<std::string> cut;       ///< bodies that reach the container's faces
  std::vector<std::string> inside;    ///< bodies inside the container that do not reach its faces
  std::vector<ErrorLocation> doubts;  ///< contacts that are difficult to mesh: descriptions of bodies nearly tangent to the container
};

struct FluidDomain {
  Model model;
  FluidReport report;
};

namespace cad {

/// Returns true if the faces may extend out of the container, where they are cut off.
using MayPass = std::function<bool(const Overhang&)>;

/// Returns the container minus the bodies. Solids of the bodies that touch are united first. Bodies inside stay unchanged. Bodies that pass through the
/// container's faces, or stand on them, are cut off there, which leaves openings in these faces. An overhang (find_overhangs) that is not permitted is an
/// error; without `may_pass` all are permitted. Faces keep names, components, roles, kinds, colours and surfaces. Normals point into the fluid: those of the
/// container inwards, those of bodies outwards. The container may be given with either orientation. The solids of the result are the container with the cut
/// bodies, followed by each body inside. Like a union, the result is verified to be valid and closed, with the expected volume and remaining area of each part.
/// The bytes do not depend on the number of threads.
/// \throws Error(open_surface) for open parts; Error(bad_argument) naming a body, with its location, that lies outside the container, fills it, or divides the
/// fluid in two, or parts that would be cut off, with the length of their overhang; Error(geometry_failed) after the last tolerance or past the time limit;
/// Error(cancelled)
FluidDomain fluid_domain(const Model& container, std::span<const Model> bodies, const FluidOptions& options, const RunContext& context,
                         const MayPass& may_pass = {});

}  // namespace cad
}  // namespace sterna
