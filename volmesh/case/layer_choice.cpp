#include "volmesh/case/layer_choice.h"

#include <algorithm>
#include <cmath>

#include "geom/base/error.h"
#include "geom/base/print_text.h"
#include "volmesh/case/farfield_options.h"
#include "volmesh/case/growth_law.h"

namespace sterna::volmesh {
namespace {

constexpr int k_most_layers = 1000;       ///< upper limit, equal to that of the option layers
constexpr double k_largest_growth = 3.0;  ///< upper limit, equal to that of the option max_growth
constexpr double k_rounding = 1e-9;       ///< relative: heights that differ by less are equal

Error bad(std::string_view where, std::string problem, std::string hint) {
  return Error(
      {.code = ErrorCode::bad_argument, .attempted = "choosing the layers of " + std::string(where), .problem = std::move(problem), .hint = std::move(hint)});
}

/// Returns the smallest number of layers that reaches the height; more than k_most_layers if none does.
int fewest_layers(const EnvelopeOptions& c) {
  int n = 1;
  while (n <= k_most_layers && layer_height(c.first_height, c.max_growth, n) < c.total_height * (1.0 - k_rounding)) ++n;
  return n;
}

void refine(double f, double& length) {
  if (!is_automatic(length)) length /= f;
}
double refined_growth(double f, double growth) { return std::pow(growth, 1.0 / f); }
int refined_layers(double f, int layers) {
  return layers == 0 || is_automatic(layers) ? layers : std::clamp(static_cast<int>(std::lround(f * layers)), 1, k_most_layers);
}

void refine(double f, Rule& rule) {
  for (auto& [option, value] : rule.options) {
    if (option == "first_height") refine(f, std::get<double>(value));
    if (option == "max_growth") value = refined_growth(f, std::get<double>(value));
    if (option == "layers") value = std::int64_t{refined_layers(f, static_cast<int>(std::get<std::int64_t>(value)))};
  }
}

void refine(double f, FarfieldOptions& farfield) {
  if (is_automatic(farfield.farfield_edge)) farfield.farfield_edge = -1.0 / f;
  else farfield.farfield_edge /= f;
  for (SideRule& side : farfield.farfield_sides) refine(f, side.edge);
}

}  // namespace

EnvelopeOptions solve_layers(EnvelopeOptions c, std::string_view solve_for, std::string_view where) {
  if (is_automatic(c.total_height) || is_automatic(c.first_height) || c.layers == 0) return c;
  const std::string heights = print_text("a total height of %.6g m with a first height of %.6g m", c.total_height, c.first_height);
  if (c.total_height < c.first_height * (1.0 - k_rounding)) throw bad(where, heights + " leaves no room for one layer", "raise total_height");
  if (solve_for == "layers") {
    const int n = fewest_layers(c);
    if (n > k_most_layers)
      throw bad(where, heights + print_text(" is not reached by %d layers that grow by %g", k_most_layers, c.max_growth), "raise max_growth or first_height");
    c.layers = n;
    return c;
  }
  const double growth = growth_for_height(c.first_height, c.total_height, c.layers);
  if (c.layers * c.first_height > c.total_height * (1.0 + k_rounding))
    throw bad(where, heights + print_text(" is below %d layers of the first height", c.layers),
              print_text("give at most %d layers", static_cast<int>(c.total_height / c.first_height)));
  if (solve_for == "max_growth") {
    if (growth > k_largest_growth)
      throw bad(where, heights + print_text(" in %d layers needs a growth of %.4g, at most %g", c.layers, growth, k_largest_growth), "give more layers");
    c.max_growth = growth;
    return c;
  }
  if (growth > c.max_growth * (1.0 + k_rounding))
    throw bad(where, heights + print_text(" in %d layers needs a growth of %.4g, but max_growth is %g", c.layers, growth, c.max_growth),
              print_text("leave out layers or max_growth; %d layers are enough", fewest_layers(c)));
  return c;
}

std::string solved_for(bool has_layers, bool has_growth, bool has_height, std::string_view attempted) {
  if (!has_height) return "none";
  if (has_layers != has_growth) return has_layers ? "max_growth" : "layers";
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = std::string(attempted),
               .problem = has_layers ? "layers, max_growth and total_height cannot all be given: each follows from the other two"
                                     : "total_height needs layers or max_growth: the other option follows",
               .hint = has_layers ? "leave one of the three out" : "for example total_height = 0.02, max_growth = 1.2"});
}

MeshCase refined(MeshCase options) {
  const double f = options.family.refinement;
  if (f == 1.0) return options;
  options.family.refinement = 1.0;
  refine(f, options.envelope.first_height);
  options.envelope.max_growth = refined_growth(f, options.envelope.max_growth);
  options.envelope.layers = refined_layers(f, options.envelope.layers);
  for (Rule& rule : options.patches) refine(f, rule);
  refine(f, options.farfield);
  options.ends.size_growth = 1.0 + (options.ends.size_growth - 1.0) / f;
  options.size.size_growth = 1.0 + (options.size.size_growth - 1.0) / f;
  refine(f, options.size.size_max);
  for (SizeSource& source : options.sources) {
    source.size /= f;
    source.size_end /= f;
    for (double& size : source.sizes) size /= f;
  }
  for (ActuatorDisc& disc : options.discs) disc.edge = is_automatic(disc.edge) ? disc.radius * k_disc_edge / f : disc.edge / f;
  return options;
}

MeshCase effective_options(const MeshCase& user_options, const RunContext& context) {
  MeshCase options = refined(user_options);
  if (options.first_heights && user_options.family.refinement != 1.0)
    options.first_heights = options.first_heights->refined(user_options.family.refinement, context);
  EnvelopeOptions& e = options.envelope;
  if (const double f = user_options.family.refinement; f != 1.0)
    context.info(
        print_text("refinement %.4g in a mesh family: %sgrowth %.4g instead of %.4g", f,
                   is_automatic(e.layers) ? "" : print_text("%d layers instead of %d, ", e.layers, user_options.envelope.layers).c_str(), e.max_growth,
                   user_options.envelope.max_growth) +
        (is_automatic(e.first_height) ? "" : print_text(", first height %.4g m instead of %.4g m", e.first_height, user_options.envelope.first_height)));
  if (is_automatic(e.total_height)) return options;
  if (!is_automatic(e.max_thickness) && e.max_thickness < e.total_height)
    throw bad("all walls", print_text("total_height %g m is above max_thickness %g m", e.total_height, e.max_thickness), "leave max_thickness out");
  if (is_automatic(e.first_height)) return options;  // patches have their own first heights, and layers are solved for each patch
  if (is_automatic(e.layers)) {
    if (e.solve_for == "max_growth")
      throw bad("all walls", "max_growth is to follow from total_height, but the number of layers is not given", "give layers, or solve_for = \"layers\"");
    e.solve_for = "layers";
  }
  e = solve_layers(e, e.solve_for, "all walls");
  if (e.solve_for == "layers")
    context.info(print_text("%d layers reach the total height of %.6g m with a growth of %.4g, first height %.6g m", e.layers, e.total_height,
                            growth_for_height(e.first_height, e.total_height, e.layers), e.first_height));
  if (e.solve_for == "max_growth")
    context.info(
        print_text("%d layers grow by %.4g to the total height of %.6g m, first height %.6g m", e.layers, e.max_growth, e.total_height, e.first_height));
  return options;
}

}  // namespace sterna::volmesh
