-- A fighter: cranked delta wing, twin fins, a fuselage of superellipses, and stores on pylons under the wing.
--   ./run scripts/04_fighter_with_stores.lua

local body = fuselage{ name = "body", along = "akima", nose_height = 1.6, tail = "flat", frames = {
  { x = 0.7,  diameter = 0.50, z = -0.05 },
  { x = 2.0,  width = 0.90, height = 0.95 },
  { x = 4.0,  width = 1.20, height = 1.45, z = 0.10, shape = "superellipse", exponent = 2.3 },
  { x = 6.0,  width = 1.90, height = 1.50, z = 0.05, shape = "superellipse", exponent = 2.8 },
  { x = 8.0,  width = 2.30, height = 1.40, shape = "superellipse", exponent = 3.2 },
  { x = 10.5, width = 2.30, height = 1.35, shape = "superellipse", exponent = 3.2 },
  { x = 13.0, width = 2.00, height = 1.20, shape = "superellipse", exponent = 2.8 },
  { x = 15.0, width = 1.50, height = 1.05, shape = "superellipse", exponent = 2.4 } } }
local canopy = fairing{ name = "canopy", position = { 2.6, 0, 0.45 }, length = 3.6, width = 0.85, height = 1.05 }

local delta = wing{ name = "wing", symmetric = true, position = { 5.2, 0, 0.0 }, sweep_at = 0, tip = "flat", sections = {
  { y = 0,   chord = 9.0, airfoil = "naca64a004" },
  { y = 2.0, chord = 5.6, sweep = 60*deg },             -- the crank
  { y = 4.9, chord = 1.5, sweep = 48*deg } } }
delta:deflect{ "elevon", from = { 0.45, 0.80 }, to = { 0.90, 0.70 }, angle = -6*deg }

local fin = wing{ name = "fin", symmetric = true, position = { 11.2, 0.75, 0.35 }, tip = "flat", sections = {
  { y = 0, chord = 3.4, airfoil = "naca0005" },
  { span = 2.9, chord = 1.2, sweep = 42*deg, dihedral = 72*deg } } }    -- canted outwards

-- A store is a body of revolution: nose ogive, tube, boat tail. Each side has one store inboard and one outboard, each on a pylon.
local function store(name, y, x, z)
  return body_of_revolution{ name = name, symmetric = true, position = { x, y, z }, profile = {
    { 0, 0 }, { 0.10, 0.065 }, { 0.30, 0.11 }, { 0.60, 0.145 }, { 0.95, 0.16 }, { 1.30, 0.16 }, { 2.20, 0.16 }, { 2.60, 0.145 }, { 3.00, 0.10 } } }
end
local inner, outer = store("bomb", 2.3, 8.3, -0.62), store("tank", 3.5, 9.5, -0.55)
local function hang(name, body) return pylon{ delta, body, name = name, thickness = 0.06, nacelle_from = 0.22, nacelle_to = 0.75, wing_from = 0.25, wing_to = 0.70 } end

local model = aircraft{ name = "fighter", body, canopy, delta, fin, inner, outer, hang("bomb_pylon", inner), hang("tank_pylon", outer) }
print(model)
assert(model.is_closed and #model.solids == 1)

local m = model:measures()
print(string.format("volume %.3f m^3, wetted area %.2f m^2, wing area %.2f m^2", m.volume, m.area, m.wings.wing.area))
model:write("fighter.step")
