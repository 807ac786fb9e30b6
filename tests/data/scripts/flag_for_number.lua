-- expect bad_argument flag_for_number.lua:2: volume_mesh: first_height: true is not allowed, expected a number
volume_mesh{ read_surface "box.stl", first_height = true }
