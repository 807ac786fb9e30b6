-- expect bad_argument nil_value.lua:3: volume_mesh: entry 1: expected a surface (from surface_mesh or read_surface), not nothing
local wall
volume_mesh{ wall, first_height = 1e-3 }
