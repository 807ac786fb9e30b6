// Boolean union of closed parts: one wetted surface of all of them, every face of which knows where it came from.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "geom/base/error.h"
#include "geom/base/run_context.h"
#include "geom/base/schema.h"
#include "geom/cad/find_contacts.h"
#include "geom/model/model.h"

namespace sterna {

struct UniteOptions {
  double tolerance = k_automatic;  ///< metres
  double time_limit = 600.0;       ///< seconds
};
template <>
struct Schema<UniteOptions> {
  static constexpr std::string_view stage = "unite";
  using T = UniteOptions;
  static constexpr std::array fields = {
      Field<T>{.name = "tolerance",
               .member = &T::tolerance,
               .unit = Unit::metre,
               .min = 0.0,
               .max = 1.0,
               .help = "points, edges and faces of different parts that are nearer than this coincide",
               .automatic = "0, then 1e-7, 1e-6, 1e-5, 1e-4 of the longest side until the union is valid"},
      Field<T>{.name = "time_limit", .member = &T::time_limit, .unit = Unit::second, .min = 1.0, .max = 1e6, .help = "a try that takes longer ends the union"},
  };
};

/// One tolerance that was tried.
struct UniteTry {
  double tolerance = 0.0;  ///< metres
  std::string problem;     ///< empty: it was taken
  std::vector<ErrorPlace> places;
};

struct UniteReport {
  std::vector<UniteTry> tries;        ///< the last one was taken
  double volume = 0.0;                ///< of the union, m^3
  double sum_of_volumes = 0.0;        ///< of the parts: the difference is what overlaps
  double largest_volume = 0.0;        ///< of a part
  std::size_t n_bodies = 0;           ///< closed solids that do not touch; 1 where everything is connected
  std::vector<PartContact> contacts;  ///< how the parts meet, found before anything is united
  std::vector<ErrorPlace> doubts;     ///< what of that is hard to unite or to mesh, in words: gaps, nearly tangent joins, parts inside others
};

struct UniteResult {
  Model model;
  UniteReport report;
};

namespace cad {

/// The union of closed models. Each result face keeps component, role, name, colour, layer and, by handle, the surface of the face it is a part of; inner faces
/// are gone; faces that coincide belong to the first part. Doubts about the contacts are logged as warnings before anything is united. The result is proven:
/// valid (OpenCASCADE's check), closed, its volume between that of the largest part and the sum of all, and of every part as much area is left as samples of it
/// lie outside of the others. The same bytes for any number of threads.
/// \pre every part is closed
/// \throws Error(open_surface) naming a part that is not; Error(geometry_failed) after the last tolerance, naming the pair of components that alone does not
/// unite, where there is one, with the place, or past the time limit of a try; Error(cancelled)
UniteResult unite(std::span<const Model> parts, const UniteOptions& options, const RunContext& context);

}  // namespace cad
}  // namespace sterna
