-- expect bad_argument missing_value.lua:2: volume_mesh: needs first_height (height of the first cell at the wall; in scripts also a function of x, y, z)
volume_mesh{ read_surface "box.stl", layers = 3 }
