-- Half models: one side of an aircraft, open at its plane of symmetry. The open boundary lies exactly in the plane. A solver needs half the cells.
--   ./run scripts/09_half_model.lua

local body = fuselage{ name = "body", frames = {
  { x = 0.3, diameter = 0.5, z = -0.08 }, { x = 1.2, diameter = 1.1 }, { x = 2.4, diameter = 1.3 }, { x = 4.6, diameter = 1.25 },
  { x = 6.6, diameter = 0.8, z = 0.12 },  { x = 8.2, diameter = 0.35, z = 0.25 } } }
local main_wing = wing{ name = "wing", symmetric = true, position = { 2.6, 0, -0.35 }, trailing_edge = 0.010, sections = {
  { y = 0, chord = 1.7, airfoil = "naca2412", twist = 2*deg },
  { y = 5, chord = 0.9, sweep = 3*deg, dihedral = 5*deg } } }
local fin = wing{ name = "fin", position = { 6.9, 0, 0.3 }, trailing_edge = 0.008, sections = {
  { chord = 1.3, airfoil = "naca0010" },
  { z = 1.5, chord = 0.7, sweep = 25*deg } } }
local whole = aircraft{ body, main_wing, fin }

local right = half(whole)                                            -- the side y > 0; half{ whole, keep = "-" } keeps the other side
print(right, right.report)
assert(not right.is_closed and right.min[2] > -1e-6)                -- bounding boxes of exact geometry have a small margin; the open boundary is exact

local sizes = { curvature_angle = 20*deg, min_edge = 12*mm, patches = { ["wing*"] = { max_edge = 0.2 }, fin = { max_edge = 0.2, min_edge = 8*mm } } }
local function mesh_of(model)
  sizes[1] = model
  return surface_mesh(sizes)
end
local wall, full = mesh_of(right), mesh_of(whole)
print(string.format("half %d triangles, whole %d: %.1f %%", wall.triangles, full.triangles, 100 * wall.triangles / full.triangles))
assert(wall.crossings == 0)

-- A triangulated surface can be halved, too: the half has the triangles of the whole, except those across the plane.
local cut = half(full)
assert(math.abs(cut.triangles / full.triangles - 0.5) < 0.015)

-- volume_mesh adds half a farfield and the plane "symmetry". The layer ends in the plane.
local mesh = volume_mesh{ wall, first_height = 2e-5, farfield = sphere{ radius = 150 } }
mesh:check()
mesh:write("half_model.su2", "half_model.vtu")
