-- The first mesh: an aircraft surface in, a mesh for a RANS solver out.
--   ./run scripts/01_first_mesh.lua

-- The wall. File names are looked for in the current folder, then beside this script. This file's lengths are feet; inside, everything is metres.
-- Edges that bend by more than 60 degrees part the surface into patches, which become the solver's boundary markers.
local wall = read_surface{ "data/cessna.msh.gz", unit = ft, split_angle = 60*deg }
print(wall)

-- The mesh. Height of the first cell and number of layers are all it needs; the rest has defaults, which help(volume_mesh) lists.
local mesh = volume_mesh{ wall,
  layers = 30,
  first_height = 1e-6 * wall.length,           -- a millionth of the body length: y+ about 1 at flight Reynolds numbers
  farfield = sphere{ radius = 50 * wall.length } }
print(mesh)

-- The verdict: every face matched, every cell valid, nothing intersects. An invalid mesh is an error that names the places.
mesh:check()

-- Outputs go to the current folder, each with a manifest <file>.json that says how it was made.
mesh:write("first_mesh.su2", "first_mesh.vtu")
print("wrote first_mesh.su2 (for SU2) and first_mesh.vtu (for ParaView) into the current folder")
