-- expect unknown_option unknown_key.lua:3: volume_mesh: unknown key "layer", did you mean "layers"?
local wall = read_surface "box.stl"
volume_mesh{ wall, layer = 30, first_height = 1e-3 }
