-- From a surface file to a mesh: triangles are read and re-meshed by curvature, then layers and tetrahedra are made.
--   ./run scripts/11_surface_file.lua

-- The wall. Files are searched in the current folder, then in the folder of this script. The lengths of this file are feet; sterna uses metres.
-- Edges that bend by more than 60 degrees divide the surface into patches, which become the boundary markers of the solver.
local given = read_surface{ "data/cessna.msh.gz", unit = ft, split_angle = 60*deg }
print(given)

-- The surface has sliver triangles (angles below 5 degrees), which cause bad layers (docs/remesh.md). inspect{ given } reports them within seconds.
local wall = remesh{ given }

local mesh = volume_mesh{ wall,
  first_height = 1e-5 * wall.length,
  farfield = sphere{ radius = 30 * wall.length },
  sources = { wake{ wall, length = 2 } } }
mesh:check()
mesh:write("cessna.su2", "cessna.vtu")
