#include "volmesh/forecast.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "geom/base/error.h"
#include "geom/base/machine_memory.h"
#include "geom/base/number_text.h"

namespace sterna::volmesh {
namespace {

// Peak memory of complete runs (docs/measurements/performance.md). The runs are the wing and body of an airliner, the CRM, the Cessna, and the DLR-F6 with 184
// k and 613 k triangles.
constexpr double k_bytes_alone = 60e6, k_bytes_of_prism = 45.0, k_bytes_of_tetrahedron = 215.0;
/// Smallest observed ratio of tetrahedra to triangles, on walls of well-shaped triangles with default size growth.
constexpr double k_least_tetrahedra_of_triangle = 5.0;
// Seconds of the same runs on two threads, which are 1.8 times as fast as one thread.
constexpr double k_seconds_of_triangle = 6e-5, k_seconds_of_tetrahedron = 0.8e-6, k_threads_power = 0.85;
constexpr double k_long = 600.0;
/// Ratio of volume to cubed edge. For a regular tetrahedron it is 6^-1 2^-1/2; tetrahedra in growing size fields are somewhat smaller.
constexpr double k_volume_over_cube = 0.118 * 0.9;
/// The integral includes leaves inside bodies, where there are no tetrahedra. This is the fraction in the fluid.
constexpr double k_share_in_fluid = 0.75;

std::string millions(double n) { return n < 1e6 ? number_text(std::round(1e-3 * n), 3) + " k" : number_text(1e-6 * n, 3) + " M"; }
std::string gigabytes(double n) { return number_text(1e-9 * n, 2) + " GB"; }

std::string figures(const Forecast& forecast) {
  return "about " + millions(forecast.n_prisms) + " prisms and " + millions(forecast.n_tetrahedra) + " tetrahedra, " + gigabytes(forecast.bytes());
}

}  // namespace

double Forecast::bytes() const { return k_bytes_alone + k_bytes_of_prism * n_prisms + k_bytes_of_tetrahedron * n_tetrahedra; }

double Forecast::seconds(int threads) const {
  return (k_seconds_of_triangle * n_triangles + k_seconds_of_tetrahedron * n_tetrahedra) * std::pow(2.0 / threads, k_threads_power);
}

Forecast forecast_of(const LayerDomain& layer_domain) {
  const TriMesh& wall = layer_domain.base.wall;
  const auto& layers = layer_domain.base.demand.layers;
  Forecast forecast{.n_triangles = static_cast<double>(wall.n_triangles())};
  if (layers.empty()) forecast.n_prisms = forecast.n_triangles * layer_domain.options.envelope.layers;
  else
    for (const TriangleVertices& t : wall.triangles) forecast.n_prisms += layers[t[0]];
  forecast.n_tetrahedra = k_least_tetrahedra_of_triangle * forecast.n_triangles;
  return forecast;
}

double expected_tetrahedra(const SizeField& sizes) { return k_share_in_fluid * sizes.volume_over_cubes() / k_volume_over_cube; }

void require_room(const Forecast& forecast, const LimitOptions& limits, const RunContext& context) {
  const bool is_given = !is_automatic(limits.max_memory);
  // The forecast is for the whole process. It therefore includes the memory that the process already uses.
  const double allowed = is_given ? limits.max_memory : available_memory() + resident_memory();
  const double seconds = forecast.seconds(context.threads());
  if (forecast.bytes() > allowed) {
    const std::string problem = figures(forecast) + " are expected; " + (is_given ? "limits.max_memory is " : "the machine has ") + gigabytes(allowed) +
                                (is_given ? "" : " of free memory");
    const std::string hint =
        "use fewer or larger triangles, fewer layers, larger size sources or a larger size_growth; or more memory. force = true (--force) continues anyway";
    if (!limits.force) throw Error({.code = ErrorCode::overflow, .attempted = "volume_mesh", .problem = problem, .hint = hint});
    context.warn(problem);
  } else if (seconds > k_long) {
    context.warn(figures(forecast) + " are expected, in about " + number_text(std::round(seconds / 60.0), 2) + " min");
  } else {
    context.debug(figures(forecast) + " are expected");
  }
}

}  // namespace sterna::volmesh
