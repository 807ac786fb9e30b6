-- expect bad_argument unknown_patch.lua:2: 
volume_mesh{ read_surface "box.stl", layers = 2, first_height = 1e-3, patches = { ["tail*"] = { layers = 3, first_height = 1e-3 } } }
-- expect tail*
