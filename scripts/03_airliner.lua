-- An airliner from a table of numbers: fuselage, kinked wing with deflected ailerons, tails, engines on pylons. All parts are united to one closed surface.
--   ./run scripts/03_airliner.lua
--   sterna view scripts/03_airliner.lua         opens the model in a browser, with sliders for the arguments; edits of this file are followed (docs/view.md)
-- The axes: x aft, y to starboard, z up. Lengths are in metres and angles in radians; 5*deg is an angle. Positive angles: nose up, trailing edge down.

local choice = args{
  span = number{ 34, min = 26, max = 42, unit = m }, sweep = number{ 25, min = 0, max = 35, unit = deg },
  dihedral = number{ 5, min = -2, max = 10, unit = deg }, aileron = number{ 8, min = -20, max = 20, unit = deg } }

local design = {
  length = 37.5, diameter = 4.0,                      -- fuselage
  wing_x = 12.6, span = choice.span, root_chord = 6.6, kink = 0.36, kink_chord = 3.9, tip_chord = 1.5, sweep = choice.sweep, dihedral = choice.dihedral,
  aileron = choice.aileron,
  engine = { 12.2, 5.75, -2.25 },
}

-- The frames are circles that grow behind the nose and rise towards the tail. Three equal frames keep the cabin straight.
local function frames_of(p)
  local d, l = p.diameter, p.length
  return {
    { x = 0.6,     diameter = 0.42*d, z = -0.09*d },
    { x = 1.6,     diameter = 0.67*d, z = -0.06*d },
    { x = 3.2,     diameter = 0.90*d, z = -0.02*d },
    { x = 5.2,     diameter = d },
    { x = 6.2,     diameter = d },
    { x = 0.40*l,  diameter = d },
    { x = 0.62*l,  diameter = d },
    { x = 0.66*l,  diameter = d },
    { x = 0.76*l,  diameter = 0.90*d, z = 0.05*d },
    { x = 0.87*l,  diameter = 0.60*d, z = 0.17*d },
    { x = 0.98*l,  diameter = 0.22*d, z = 0.28*d } }
end

local function airliner(p)
  local body = fuselage{ name = "body", frames = frames_of(p), along = "akima", nose_height = 0.9, tail_height = 1.2 }

  local main_wing = wing{ name = "wing", symmetric = true, position = { p.wing_x, 0, -1.15 }, trailing_edge = 0.01, sections = {
    { y = 0,                 chord = p.root_chord, airfoil = "naca23014", twist = 3*deg },
    { y = p.kink*p.span/2,   chord = p.kink_chord, airfoil = "data/rae2822.dat", twist = 1*deg, x = p.kink*p.span/2*math.tan(p.sweep + 3*deg), dihedral = p.dihedral },
    { y = p.span/2,          chord = p.tip_chord,  sweep = p.sweep, dihedral = p.dihedral, twist = -2*deg } } }
  main_wing:deflect{ "aileron", from = { 0.72, 0.75 }, to = { 0.93, 0.73 }, angle = p.aileron, other_side = "opposite" }
  main_wing:control{ "flap", from = { 0.40, 0.76 }, to = { 0.68, 0.75 } }       -- not deflected; names a patch

  local engine = nacelle{ name = "engine", symmetric = true, position = p.engine, length = 4.0, diameter = 2.1, intake = "fan_face", exhaust = "nozzle" }
  local fin = wing{ name = "fin", position = { 30.2, 0, 1.2 }, sections = {
    { chord = 5.6, airfoil = "naca0011" },
    { z = 6.4, chord = 2.0, sweep = 36*deg } } }
  local tailplane = wing{ name = "tailplane", symmetric = true, position = { 32.0, 0, 0.75 }, sections = {
    { y = 0, chord = 3.9, airfoil = "naca0010" },
    { y = 6.2, chord = 1.3, sweep = 29*deg, dihedral = 6*deg } } }
  print(body, main_wing, engine)
  return aircraft{ body, main_wing, engine, pylon{ main_wing, engine, name = "pylon" }, fin, tailplane }
end

local model = airliner(design)
print(model)
assert(model.is_closed and #model.solids == 1)

local m = model:measures()
local wing_data = m.wings.wing
print(string.format("volume %.1f m^3, wetted area %.1f m^2", m.volume, m.area))
print(string.format("wing: span %.2f m, area %.1f m^2, mean aerodynamic chord %.3f m, aspect ratio %.2f", wing_data.span, wing_data.area, wing_data.mean_aerodynamic_chord, wing_data.aspect_ratio))
for name, part in pairs(m.components) do print(string.format("  %-12s %7.2f m^2 wetted", name, part.area)) end
model:write("airliner.step")
