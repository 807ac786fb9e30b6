-- A model on its sting in the test section of a wind tunnel, at several attitudes. The sting passes through the outflow plane, and the walls have their own layers.
--   ./run scripts/08_wind_tunnel.lua

-- Model and sting stand for files of a CAD system. Here the script writes them.
local body = fuselage{ name = "body", along = "akima", tail = "flat", frames = {
  { x = 0.05, diameter = 0.07 }, { x = 0.15, diameter = 0.125 }, { x = 0.30, diameter = 0.16 }, { x = 0.36, diameter = 0.16 }, { x = 0.9, diameter = 0.16 },
  { x = 1.2, diameter = 0.16 }, { x = 1.26, diameter = 0.16 }, { x = 1.45, diameter = 0.13 }, { x = 1.6, diameter = 0.11 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 0.62, 0, -0.03 }, trailing_edge = 1*mm, sections = {
  { y = 0,   chord = 0.32, airfoil = "naca23012" },
  { y = 0.3, chord = 0.21, sweep = 27*deg, dihedral = 4*deg },
  { y = 0.8, chord = 0.12, sweep = 27*deg, dihedral = 4*deg } } }
aircraft{ body, main_wing }:write("tunnel_model.step")
sting{ name = "sting", from = { 1.45, 0, 0 }, to = { 4, 0, 0 }, diameter = 0.07, cone_start = 0.5, end_diameter = 0.13 }:model():write("tunnel_sting.step")

local model = read_cad "tunnel_model.step"
local support = read_cad "tunnel_sting.step"
local tunnel = test_section{ length = 5, width = 2.4, height = 1.8, upstream = 2, inflow = "inlet", outflow = "outlet",
  max_edge = 0.25,                                                  -- longest edge on all patches of the tunnel
  through = "sting",                                                -- component that may pass through walls; any other part that reaches out of the tunnel is an error
  walls = { first_height = 20e-6 } }                   -- or walls = "slip"; floor, ceiling, left, right = ... set a single wall

local mounted = assembly{ model, support }                          -- model and sting touch, so the result is one closed surface
assert(#mounted.solids == 1 and mounted.is_closed)

for _, alpha in ipairs{ -4, 12 } do
  for _, beta in ipairs{ 0, 5 } do
    local turned = mounted:rotate{ about = { 0.8, 0, 0 }, pitch = alpha*deg, yaw = beta*deg }
    -- The fluid fills the test section around the model. Edges are short where the sting leaves the tunnel, and grow with the distance from there.
    local wall = surface_mesh{ turned, tunnel, curvature_angle = 20*deg, growth = 1.3,
      patches = { ["body*"] = { max_edge = 0.04 }, ["wing*"] = { max_edge = 0.03, min_edge = 0.0015 }, ["sting*"] = { max_edge = 0.05 } } }
    assert(wall.is_closed and wall.crossings == 0)
    print(string.format("pitch %3d, yaw %d: %s triangles", alpha, beta, wall.triangles))
    local mesh = volume_mesh{ wall, first_height = 3e-6 }   -- first height of the model; that of the walls was given with the test section
    mesh:check()
    mesh:write(string.format("tunnel_a%d_b%d.cgns", alpha, beta))
  end
end
