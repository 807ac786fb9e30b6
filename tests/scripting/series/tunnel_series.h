// A wind-tunnel series of 14 cases with a wing from tests/data/shared, two of which fail on purpose: one outside the tunnel, one with a wrong option.
#pragma once

#include <string>

#include "tests/support/data.h"

namespace sterna::scripting {

inline constexpr int k_tunnel_cases = 14, k_tunnel_failures = 2;

/// \param options options of series{}: "cache = false, run = jobs{ 1 }, "
inline std::string tunnel_series(const std::string& options = {}, bool is_reversed = false) {
  return "local model = read_cad \"" + (test::shared_data() / "cad" / "tigl_simplewing_simplewing.brep").string() + "\"\n" + R"lua(
local tunnel = test_section{ length = 8, width = 5, height = 4, upstream = 3, max_edge = 2, walls = "slip", inflow = "inlet", outflow = "outlet" }
local cases = {}
for _, alpha in ipairs(range(-4, 6, 2)) do
  for _, beta in ipairs{ 0, 5 } do cases[#cases + 1] = { alpha = alpha, beta = beta, rise = 0, layers = 4 } end
end
cases[#cases + 1] = { alpha = 4, beta = 0, rise = 3, layers = 4 }      -- outside
cases[#cases + 1] = { alpha = 4, beta = 0, rise = 0, layers = -4 }     -- no such number of layers
)lua" + (is_reversed ? "for i = 1, #cases // 2 do cases[i], cases[#cases + 1 - i] = cases[#cases + 1 - i], cases[i] end\n" : "") +
         "local polar = series{ \"polar\", " + options + R"lua( over = cases, case = function(p)
  local m = model:move{ 0, -1, p.rise }:rotate{ about = { 0.5, 0, 0 }, pitch = p.alpha*deg, yaw = p.beta*deg }
  local wall = surface_mesh{ m, tunnel, max_edge = 0.6, min_edge = 0.05, curvature_angle = 45*deg, growth = 1.8 }
  local mesh = volume_mesh{ wall, layers = p.layers, first_height = 1e-3, max_growth = 1.6 }
  mesh:write(p.name .. ".su2", "mesh.vtu")
  return { prisms = mesh.prisms }
end }
print(polar.done, polar.failed, polar.killed)
)lua";
}

}  // namespace sterna::scripting
