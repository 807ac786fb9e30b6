-- The first mesh: an aircraft is defined by numbers, and the result is a volume mesh for a RANS solver.
--   ./run scripts/01_first_mesh.lua

-- The shape. The axes: x aft, y to starboard, z up. Lengths are in metres and angles in radians; 3*deg is an angle of 3 degrees.
local body = fuselage{ name = "body", frames = {
  { x = 0.3, diameter = 0.5, z = -0.08 }, { x = 1.2, diameter = 1.1 }, { x = 2.4, diameter = 1.3 }, { x = 4.6, diameter = 1.25 },
  { x = 6.6, diameter = 0.8, z = 0.12 },  { x = 8.2, diameter = 0.35, z = 0.25 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 2.6, 0, -0.15 }, trailing_edge = 0.015, sections = {
  { y = 0, chord = 1.7, airfoil = "naca2412", twist = 2*deg },
  { y = 5, chord = 0.9, sweep = 3*deg, dihedral = 5*deg } } }
local model = aircraft{ body, main_wing }

-- The wall: no edge of its triangles is longer than max_edge, and edges are shorter where the model is curved.
local wall = surface_mesh{ model, max_edge = 0.2, curvature_angle = 15*deg, min_edge = 10*mm }

-- The volume mesh. It requires only the height of the first cell. Layers grow by 1.25 until their last cells fit the tetrahedra. help(volume_mesh) lists the other options.
local mesh = volume_mesh{ wall, first_height = 2e-5, farfield = sphere{ radius = 100 }, sources = { wake{ wall, length = 2 } } }

-- The verdict: all faces match, all cells are valid, and nothing intersects. An invalid mesh is an error that lists the locations.
mesh:check()

-- The output files are in the current folder: the mesh for SU2 and for ParaView, a picture, and a page for the browser.
-- The manifest <file>.json beside each mesh records how the mesh was made.
mesh:write("first_mesh.su2", "first_mesh.vtu")
draw{ mesh, "first_mesh.png", cut = "y=-2.5", focus = "3.3,-2.2,0 radius=2.2", view = "215 25" }
local has_page, why = pcall(report, { mesh, "first_mesh.html" })
if not has_page then print("the report page was not written: " .. tostring(why)) end             -- a build without access to npm has no report page
