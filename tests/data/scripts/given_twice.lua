-- expect bad_argument given_twice.lua:2: volume_mesh: layers: given twice
volume_mesh{ read_surface "box.stl", first_height = 1e-3, layers = 3, envelope = { layers = 4 } }
