-- expect bad_argument wrong_object.lua:2: tetrahedra: entry 1: expected an envelope (from make_envelope or read_stages), not a surface
tetrahedra{ read_surface "box.stl" }
