-- The first mesh: an aircraft from numbers, a mesh for a RANS solver out.
--   ./run scripts/01_first_mesh.lua

-- The shape. Axes: x aft, y to starboard, z up; metres and radians (3*deg is an angle).
local body = fuselage{ name = "body", frames = {
  { x = 0.3, diameter = 0.5, z = -0.08 }, { x = 1.2, diameter = 1.1 }, { x = 2.4, diameter = 1.3 }, { x = 4.6, diameter = 1.25 },
  { x = 6.6, diameter = 0.8, z = 0.12 },  { x = 8.2, diameter = 0.35, z = 0.25 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 2.6, 0, -0.15 }, trailing_edge = 0.015, sections = {
  { y = 0, chord = 1.7, airfoil = "naca2412", twist = 2*deg },
  { y = 5, chord = 0.9, sweep = 3*deg, dihedral = 5*deg } } }
local model = aircraft{ body, main_wing }

-- The wall: triangles no longer than max_edge, and finer where the model is curved.
local wall = surface_mesh{ model, max_edge = 0.2, curvature_angle = 15*deg, min_edge = 10*mm }

-- The mesh. The height of the first cell is all it needs: layers grow by 1.25 until they meet the tetrahedra. help(volume_mesh) lists the other options.
local mesh = volume_mesh{ wall, first_height = 2e-5, farfield = sphere{ radius = 100 }, sources = { wake{ wall, length = 2 } } }

-- The verdict: every face matched, every cell valid, nothing intersects. An invalid mesh is an error that names the places.
mesh:check()

-- Outputs go to the current folder: the mesh for SU2 and for ParaView, each with a manifest <file>.json that says how it was made, a picture, and a page to
-- look at it in a browser.
mesh:write("first_mesh.su2", "first_mesh.vtu")
draw{ mesh, "first_mesh.png", cut = "y=-2.5", focus = "3.3,-2.2,0 radius=2.2", view = "215 25" }
local has_page, why = pcall(report, { mesh, "first_mesh.html" })
if not has_page then print("no page: " .. tostring(why)) end             -- a build that could not reach npm has none
