-- expect bad_argument fraction_of_layers.lua:2: volume_mesh: layers: 3.5 is not allowed, expected a whole number
volume_mesh{ read_surface "box.stl", first_height = 1e-3, layers = 3.5 }
