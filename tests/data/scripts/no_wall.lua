-- expect bad_argument no_wall.lua:2: volume_mesh: entry 1: expected a surface (from surface_mesh or read_surface), not a string
volume_mesh{ "box.stl", first_height = 1e-3 }
