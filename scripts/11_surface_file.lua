-- A surface of somebody else's to a mesh: triangles in, new triangles by curvature, layers and tetrahedra.
--   ./run scripts/11_surface_file.lua

-- The wall. File names are looked for in the current folder, then beside this script. This file's lengths are feet; inside, everything is metres.
-- Edges that bend by more than 60 degrees part the surface into patches, which become the solver's boundary markers.
local given = read_surface{ "data/cessna.msh.gz", unit = ft, split_angle = 60*deg }
print(given)

-- It has needles (corners below 5 degrees), which no layer survives well; docs/remesh.md. inspect{ given } would say so in seconds.
local wall = remesh{ given }

local mesh = volume_mesh{ wall,
  first_height = 1e-5 * wall.length,
  farfield = sphere{ radius = 30 * wall.length },
  sources = { wake{ wall, length = 2 } } }
mesh:check()
mesh:write("cessna.su2", "cessna.vtu")
