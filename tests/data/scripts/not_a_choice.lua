-- expect bad_argument not_a_choice.lua:2: volume_mesh: optimiser: "fast" is not allowed, expected one of none, descent, mma, ccsaq
volume_mesh{ read_surface "box.stl", first_height = 1e-3, optimiser = "fast" }
