-- A wind-tunnel model on its sting in a test section: the wing is bent elastically, then the model is turned to its attitude.
--   ./run scripts/06_wind_tunnel_model.lua

local half_span = 0.8
local body = fuselage{ name = "body", along = "akima", tail = "flat", frames = {
  { x = 0.05, diameter = 0.07 }, { x = 0.15, diameter = 0.125 }, { x = 0.30, diameter = 0.16 }, { x = 0.36, diameter = 0.16 }, { x = 0.9, diameter = 0.16 },
  { x = 1.2, diameter = 0.16 }, { x = 1.26, diameter = 0.16 }, { x = 1.45, diameter = 0.13 }, { x = 1.6, diameter = 0.11 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 0.62, 0, -0.03 }, trailing_edge = 0.5*mm, sections = {
  { y = 0,         chord = 0.32, airfoil = "naca23012" },
  { y = 0.3,       chord = 0.21, sweep = 27*deg, dihedral = 4*deg },
  { y = half_span, chord = 0.09, sweep = 27*deg, dihedral = 4*deg, twist = -2*deg } } }
local support = sting{ name = "sting", from = { 1.45, 0, 0 }, to = { 2.6, 0, 0 }, diameter = 0.07, cone_start = 0.5, end_diameter = 0.13 }

local clean = aircraft{ name = "model", body, main_wing }

-- The wing bends like a cantilever, with the measured rise of the tip. The body does not move.
local tip_rise = 0.03
local bent = clean:deform{ function(x, y, z)
  local s = math.max(math.abs(y) - 0.09, 0) / (half_span - 0.09)
  return 0, 0, tip_rise * s*s*s * (4 - s) / 3
end, tolerance = 1e-6 }
print(bent)

-- Model and sting are turned about the balance: 4 degrees of incidence, 2 degrees of sideslip.
local mounted = union{ bent, support }:rotate{ about = { 0.8, 0, 0 }, pitch = 4*deg, yaw = 2*deg }
assert(mounted.is_closed and #mounted.solids == 1)
local tunnel = test_section{ length = 5, width = 2.4, height = 1.8, upstream = 2, contraction_length = 1.5, contraction_ratio = 5 }
local all = assembly{ mounted, tunnel }
print(all)

local m = mounted:measures()
print(string.format("volume %.6f m^3, wetted area %.5f m^2; tip at z = %.4f m", m.volume, m.area, m.components.wing.box[2][3]))
print(string.format("tunnel: %.3f m^3 of air", -tunnel:measures().volume - m.volume))
mounted:write("wind_tunnel_model.step")
all:write("wind_tunnel.step")
