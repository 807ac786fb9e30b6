-- expect bad_argument not_a_number.lua:2: volume_mesh: first_height: is not a number (NaN, e.g. from 0/0)
volume_mesh{ read_surface "box.stl", first_height = 0/0 }
