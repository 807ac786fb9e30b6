#include "volmesh/flow/boundary_layer.h"

#include <array>
#include <cmath>
#include <string_view>

#include "geom/base/error.h"
#include "geom/base/print_text.h"

namespace sterna::volmesh {
namespace {

struct FrictionLaw {
  std::string_view name;
  double (*friction)(double reynolds);
  double from, to;  ///< range of Reynolds numbers for which the authors fitted the formula
};
constexpr std::array<FrictionLaw, 6> k_laws = {{
    {"schlichting", [](double re) { return std::pow(2.0 * std::log10(re) - 0.65, -2.3); }, 5e5, 1e9},
    {"seventh_root", [](double re) { return 0.026 * std::pow(re, -1.0 / 7.0); }, 5e5, 1e9},
    {"kays_crawford", [](double re) { return 0.0574 * std::pow(re, -0.2); }, 5e5, 1e7},
    {"prandtl", [](double re) { return 0.0592 * std::pow(re, -0.2); }, 5e5, 1e7},
    {"prandtl_schlichting", [](double re) { return 0.455 * std::pow(std::log10(re), -2.58); }, 5e5, 1e9},
    {"ittc57", [](double re) { return 0.075 * std::pow(std::log10(re) - 2.0, -2.0); }, 1e6, 1e10},
}};

const FrictionLaw& law_of(const std::string& name) {
  for (const FrictionLaw& law : k_laws)
    if (law.name == name) return law;
  std::string names;
  for (const FrictionLaw& law : k_laws) names += (names.empty() ? "use one of " : ", ") + std::string(law.name);
  throw Error({.code = ErrorCode::bad_argument, .attempted = "computing the skin friction", .problem = "unknown friction law \"" + name + "\"", .hint = names});
}

void require_turbulent(double reynolds) {
  if (reynolds >= k_least_reynolds && reynolds <= k_largest_reynolds) return;
  throw Error({.code = ErrorCode::bad_argument,
               .attempted = "estimating the boundary layer",
               .problem = print_text("Reynolds number %g is outside %g .. %g, the range of the laws for the turbulent flat plate", reynolds, k_least_reynolds,
                                     k_largest_reynolds),
               .hint = "check the length and its unit, or give the first height in metres"});
}

}  // namespace

double skin_friction(const std::string& law, double reynolds) {
  require_turbulent(reynolds);
  return law_of(law).friction(reynolds);
}

FirstHeight first_height(const FirstHeightOptions& options, const FlowState& flow) {
  FirstHeight result{.y_plus = options.y_plus, .skin_friction = skin_friction(options.law, flow.reynolds), .options = options, .flow = flow};
  const double ratio = std::sqrt(0.5 * result.skin_friction);  // ratio u_tau / U
  result.wall_distance = options.y_plus * flow.length / (flow.reynolds * ratio);
  result.height = options.at == "cell_centre" ? 2.0 * result.wall_distance : result.wall_distance;
  if (!is_automatic(flow.speed)) result.friction_velocity = ratio * flow.speed;
  return result;
}

double layer_thickness(const ThicknessOptions& options, const FlowState& flow) {
  require_turbulent(flow.reynolds);
  const double share = options.thickness_law == "seventh_root" ? 0.16 * std::pow(flow.reynolds, -1.0 / 7.0) : 0.37 * std::pow(flow.reynolds, -0.2);
  return options.factor * share * flow.length;
}

std::string describe(const FirstHeight& first) {
  const FrictionLaw& law = law_of(first.options.law);
  const bool is_outside = first.flow.reynolds < law.from || first.flow.reynolds > law.to;
  std::string text = print_text("y+ %g %s: first height %.4g m (cf %.4g by ", first.y_plus,
                                first.options.at == "node" ? "at the first node" : "in the middle of the first cell", first.height, first.skin_friction);
  text += law.name;
  if (is_outside) text += print_text(", which was fitted to Re %g .. %g", law.from, law.to);
  if (!is_automatic(first.friction_velocity)) text += print_text(", u_tau %.4g m/s", first.friction_velocity);
  return text + "; " + describe(first.flow) + ")";
}

std::string describe_thickness(const ThicknessOptions& options, const FlowState& flow) {
  return print_text("turbulent boundary layer: %.4g m (", layer_thickness(options, flow)) +
         (options.factor == 1.0 ? "" : print_text("%g times the thickness by ", options.factor)) + options.thickness_law + "; " + describe(flow) + ")";
}

}  // namespace sterna::volmesh
