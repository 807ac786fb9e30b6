-- A glider: a wing with cubic interpolation along the span and winglets, an airfoil file, pod and boom, T-tail.
--   ./run scripts/05_glider.lua

local laminar = airfoil{ "data/nlf416.dat", trailing_edge = 0.002 }     -- thickness, relative to the chord
print(laminar)

local pod = fuselage{ name = "pod", nose_height = 1.3, tail_height = 1.0, frames = {
  { x = 0.25, width = 0.34, height = 0.40, z = -0.10 },
  { x = 0.8,  width = 0.54, height = 0.70, z = -0.04 },
  { x = 1.6,  width = 0.64, height = 0.88 },
  { x = 2.3,  width = 0.62, height = 0.84, z = 0.02 },
  { x = 3.1,  width = 0.40, height = 0.50, z = 0.08 },
  { x = 3.9,  width = 0.24, height = 0.28, z = 0.12 } } }
local tail_boom = boom{ name = "boom", from = { 3.2, 0, 0.12 }, to = { 7.1, 0, 0.22 }, diameter = 0.19 }

-- The wing is one smooth surface from the root to the winglet. The sweep of 0 at the quarter chord defines the leading edge.
local main_wing = wing{ name = "wing", symmetric = true, position = { 1.85, 0, 0.30 }, spanwise = "cubic", sections = {
  { y = 0,   chord = 0.95, airfoil = laminar, twist = 2*deg },
  { y = 3.0, chord = 0.88, dihedral = 2*deg, twist = 1.5*deg },
  { y = 5.5, chord = 0.70, dihedral = 3*deg, twist = 0.5*deg },
  { y = 7.2, chord = 0.42, dihedral = 4*deg, twist = 0 } },
  winglet = { height = 0.55, cant = 75*deg, taper = 0.45, sweep = 25*deg, bend = 0.4 } }
print(main_wing)

local fin = wing{ name = "fin", position = { 6.2, 0, 0.18 }, sections = {
  { chord = 0.95, airfoil = "naca0012" },
  { z = 1.25, chord = 0.70, sweep = 12*deg } } }
local tailplane = wing{ name = "tailplane", symmetric = true, position = { 6.55, 0, 1.36 }, sections = {
  { y = 0, chord = 0.55, airfoil = "naca0010" },
  { y = 1.45, chord = 0.32, sweep = 4*deg } } }

local model = aircraft{ name = "glider", pod, tail_boom, main_wing, fin, tailplane }
print(model)
assert(model.is_closed and #model.solids == 1)

local m = model:measures()
print(string.format("volume %.4f m^3, wetted area %.3f m^2, span %.2f m, aspect ratio %.1f", m.volume, m.area, m.wings.wing.span, m.wings.wing.aspect_ratio))
model:write("glider.step")
