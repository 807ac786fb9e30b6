// Boolean union of closed parts into one wetted surface; every face keeps a reference to its original face.
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
               .help = "points, edges and faces of different parts that are closer than this are treated as coincident",
               .automatic = "0, then 1e-7, 1e-6, 1e-5, 1e-4 of the longest side until the union is valid"},
      Field<T>{.name = "time_limit",
               .member = &T::time_limit,
               .unit = Unit::second,
               .min = 1.0,
               .max = 1e6,
               .help = "time limit of each attempt; a longer attempt ends the union with an error"},
  };
};

/// Attempt with one tolerance.
struct UniteTry {
  double tolerance = 0.0;  ///< metres
  std::string problem;     ///< empty: it was accepted
  std::vector<ErrorLocation> locations;
};

struct UniteReport {
  std::vector<UniteTry> tries;        ///< the last one was accepted
  double volume = 0.0;                ///< volume of the union, m^3
  double sum_of_volumes = 0.0;        ///< sum over the parts: the difference from `volume` is the overlap
  double largest_volume = 0.0;        ///< volume of the largest part
  std::size_t n_bodies = 0;           ///< closed solids that do not touch; 1 if everything is connected
  std::vector<PartContact> contacts;  ///< contacts of the parts, found before anything is united
  std::vector<ErrorLocation> doubts;  ///< descriptions of contacts that are difficult to unite or mesh: gaps, nearly tangent joins, parts inside others
};

struct UniteResult {
  Model model;
  UniteReport report;
};

namespace cad {

/// Returns the union of closed models. Each result face keeps component, role, name, colour, layer and, by handle, the surface of the face that it is a part
/// of; inner faces are removed; coincident faces belong to the first part. Doubtful contacts are logged as warnings before anything is united. The result is
/// verified: it is valid (OpenCASCADE's check) and closed, its volume lies between that of the largest part and the sum of all, and the remaining area of every
/// part matches the fraction of its samples outside the others. The same bytes for any number of threads.
/// \pre every part is closed
/// \throws Error(open_surface) naming a part that is not; Error(geometry_failed) after the last tolerance or past the time limit of an attempt, naming the pair
/// of components that fails to unite on its own, if there is one, with the location; Error(cancelled)
UniteResult unite(std::span<const Model> parts, const UniteOptions& options, const RunContext& context);

}  // namespace cad
}  // namespace sterna
