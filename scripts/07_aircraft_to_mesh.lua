-- From numbers to a mesh for a solver: components, one closed surface, triangles, layers and tetrahedra, verdict, files. read_cad or read_smx can replace the components.
--   ./run scripts/07_aircraft_to_mesh.lua

local body = fuselage{ name = "body", frames = {
  { x = 0.3, diameter = 0.5, z = -0.08 }, { x = 1.2, diameter = 1.1 }, { x = 2.4, diameter = 1.3 }, { x = 4.6, diameter = 1.25 },
  { x = 6.6, diameter = 0.8, z = 0.12 },  { x = 8.2, diameter = 0.35, z = 0.25 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 2.6, 0, -0.35 }, trailing_edge = 0.010, sections = {
  { y = 0, chord = 1.7, airfoil = "naca2412", twist = 2*deg },
  { y = 5, chord = 0.9, sweep = 3*deg, dihedral = 5*deg } } }
local tailplane = wing{ name = "tailplane", symmetric = true, position = { 7.3, 0, 0.25 }, trailing_edge = 0.008, sections = {
  { y = 0, chord = 0.9, airfoil = "naca0010" },
  { y = 1.7, chord = 0.6, sweep = 8*deg } } }
local fin = wing{ name = "fin", position = { 6.9, 0, 0.3 }, trailing_edge = 0.008, sections = {
  { chord = 1.3, airfoil = "naca0010" },
  { z = 1.5, chord = 0.7, sweep = 25*deg } } }
local model = aircraft{ body, main_wing, tailplane, fin }
print(model)

-- Without numbers, edges are 8 % of the circumference of bodies and 15 % of the chord of wings, and shorter where the surface is curved. Each component is a patch.
-- A min_edge above the radius of a leading edge turns the leading edge into a sharp edge, also for the layers. The tips of the tails have leading edge radii of 7 mm.
local wall = surface_mesh{ model,
  curvature_angle = 18*deg,
  min_edge = 15*mm,
  patches = { ["wing*"] = { max_edge = 0.15 }, fin = { max_edge = 0.12, min_edge = 8*mm }, tailplane = { min_edge = 6*mm } } }
print(wall, table.concat(wall.patches, " "))
assert(wall.is_closed and wall.crossings == 0)

local mesh = volume_mesh{ wall, first_height = 1e-5, farfield = sphere{ radius = 200 } }
mesh:check()
mesh:write("aircraft.su2", "aircraft.vtu")
print("wrote aircraft.su2 (for SU2) and aircraft.vtu (for ParaView) into the current folder")
