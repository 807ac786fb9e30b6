-- expect bad_argument table_for_number.lua:2: volume_mesh: layers: a table is not allowed here, expected a whole number (number of prism layers
volume_mesh{ read_surface "box.stl", first_height = 1e-3, layers = { 3 } }
