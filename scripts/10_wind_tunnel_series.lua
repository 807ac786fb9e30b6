-- A polar of a wind-tunnel model: attitude and bending are the parameters of a series. Each case runs in a separate process and folder.
-- After an interruption run the script again: complete cases are kept.
--   ./run scripts/10_wind_tunnel_series.lua        (or on a cluster: run = slurm{ partition = "cfd", tasks = 64 })

-- Model and sting stand for files of a CAD system. Here the script writes them.
local half_span = 0.8
local body = fuselage{ name = "body", along = "akima", tail = "flat", frames = {
  { x = 0.05, diameter = 0.07 }, { x = 0.15, diameter = 0.125 }, { x = 0.30, diameter = 0.16 }, { x = 0.36, diameter = 0.16 }, { x = 0.9, diameter = 0.16 },
  { x = 1.2, diameter = 0.16 }, { x = 1.26, diameter = 0.16 }, { x = 1.45, diameter = 0.13 }, { x = 1.6, diameter = 0.11 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 0.62, 0, -0.03 }, trailing_edge = 1*mm, sections = {
  { y = 0,         chord = 0.32, airfoil = "naca23012" },
  { y = 0.3,       chord = 0.21, sweep = 27*deg, dihedral = 4*deg },
  { y = half_span, chord = 0.12, sweep = 27*deg, dihedral = 4*deg } } }
aircraft{ body, main_wing }:write("series_model.step")
sting{ name = "sting", from = { 1.45, 0, 0 }, to = { 2.6, 0, 0 }, diameter = 0.07, cone_start = 0.5, end_diameter = 0.13 }:model():write("series_sting.step")

local tunnel = test_section{ length = 6, width = 2.4, height = 1.8, upstream = 2, through = "sting", inflow = "inlet", outflow = "outlet",
                             max_edge = 0.4, walls = "slip" }            -- or with layers: walls = { first_height = 20e-6 }
local model  = read_cad "series_model.step"
local sting  = read_cad "series_sting.step"

local polar = series{ "polar",
  over = { alpha = range(-4, 12, 16), beta = {0, 5}, bend = {0, 0.02} },          -- all combinations: 8 cases
  run  = jobs{ 2 },
  case = function(p)
    local bent = model:deform{ function(x, y, z) return 0, 0, p.bend*(y/half_span)^2 end, tolerance = 1e-5 }       -- elastic deformation
    local m = assembly{ bent, sting }:rotate{ about = {0.8, 0, 0}, pitch = p.alpha*deg, yaw = p.beta*deg }
    local wall = surface_mesh{ m, tunnel, curvature_angle = 20*deg, growth = 1.3,
      patches = { ["body*"] = { max_edge = 0.04 }, ["wing*"] = { max_edge = 0.03, min_edge = 0.0015 }, ["sting*"] = { max_edge = 0.05 } } }
    return volume_mesh{ wall, first_height = 30e-6 }:write(p.name .. ".cgns")
  end }

-- The script can read the table of results as well. The files NAME/series.csv and series.json hold the same table.
for _, case in ipairs(polar.cases) do print(case.name, case.verdict, case.cells, case.worst) end
assert(polar.failed == 0)
