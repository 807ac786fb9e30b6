-- Small meshes for accept_mesh_test.py: half a body, a model on its sting between viscous walls, half a wing on a side wall, a blade between periodic sides.
local body = fuselage{ name = "body", frames = {
  { x = 0.3, diameter = 0.5 }, { x = 1.2, diameter = 1.1 }, { x = 2.4, diameter = 1.3 }, { x = 4.6, diameter = 1.25 }, { x = 6.6, diameter = 0.8, z = 0.12 }, { x = 8.2, diameter = 0.35, z = 0.25 } } }
local function mesh_of(wall, name, periodic)
  local mesh = volume_mesh{ wall, layers = 8, first_height = 1e-3, farfield = not wall.is_closed and sphere{ radius = 100 } or nil, periodic = periodic }
  mesh:check()
  mesh:write(name)
end
mesh_of(surface_mesh{ half(body), curvature_angle = 25*deg, max_edge = 0.4 }, "half.sterna")

local rod = sting{ name = "sting", from = { 0.3, 0, 0 }, to = { 4, 0, 0 }, diameter = 0.2, cone_start = 0.5, end_diameter = 0.25 }:model():rotate{ pitch = 5*deg, yaw = 3*deg }
local tunnel = test_section{ length = 4, width = 2, height = 2, walls = { layers = 6, first_height = 1e-3, max_edge = 0.4 } }
mesh_of(surface_mesh{ rod, tunnel, max_edge = 0.15, growth = 1.3 }, "tunnel.sterna")

local half_span = wing{ name = "wing", trailing_edge = 0.02, sections = { { y = -0.3, chord = 0.8, airfoil = "naca2412" }, { y = 1.0, chord = 0.5 } } }
local side = test_section{ length = 5, width = 3, height = 2, position = { 2, 1.5, 0 }, through = "wing", walls = "slip", max_edge = 0.4, left = { kind = "wall", first_height = 2e-3 } }
mesh_of(surface_mesh{ half_span, side, curvature_angle = 25*deg, growth = 1.3, max_edge = 0.12, min_edge = 0.015 }, "half_span.sterna")

local blade = wing{ name = "blade", trailing_edge = 0.02, sections = { { y = -0.3, chord = 0.8, airfoil = "naca2412" }, { y = 1.3, chord = 0.8 } } }
local row = test_section{ length = 5, width = 1, height = 2, position = { 2, 0.5, 0 }, through = "blade", walls = "slip", max_edge = 0.4 }
mesh_of(surface_mesh{ blade, row, curvature_angle = 25*deg, growth = 1.3, max_edge = 0.12, min_edge = 0.015 }, "blade.sterna", { "tunnel_left", "tunnel_right" })
